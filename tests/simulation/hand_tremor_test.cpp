// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/hand_tremor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

namespace eyeslam::simulation {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kPeriod_s = 1e-3;
constexpr double kMicro = 1e-6;

// Amplitude that a filter leaves of a sine, after it has settled.
double gainAt(FilterSection section, double hz)
{
  double largest = 0.0;
  for (int i = 0; i < 40000; ++i) {
    const double output = section.step(std::sin(2.0 * kPi * hz * i * kPeriod_s));
    if (i >= 20000) largest = std::max(largest, std::abs(output));
  }
  return largest;
}

double rms(const std::vector<double>& values)
{
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

// Share of the power between two frequencies, by the definition of the Fourier transform, a line each 1 / length.
double shareBetween(const std::vector<double>& values, double low_hz, double high_hz)
{
  const double length_s = static_cast<double>(values.size()) * kPeriod_s;
  double within = 0.0;
  for (int line = static_cast<int>(low_hz * length_s); line < static_cast<int>(high_hz * length_s); ++line) {
    std::complex<double> sum = 0.0;
    const std::complex<double> turn = std::polar(1.0, -2.0 * kPi * line / static_cast<double>(values.size()));
    std::complex<double> phase = 1.0;
    for (const double value : values) {
      sum += value * phase;
      phase *= turn;
    }
    within += 2.0 * std::norm(sum) / static_cast<double>(values.size());
  }
  return within / (rms(values) * rms(values) * static_cast<double>(values.size()));
}

// One axis of one part over some time.
template <class Part>
std::vector<double> recorded(HandTremor& hand, double seconds, HandTremor::Support support, Part part)
{
  std::vector<double> values;
  for (double t = 0.0; t < seconds; t += kPeriod_s) values.push_back(part(hand.step(support)));
  return values;
}

TEST(FilterSection, BandPassIsFourHertzWideAroundTen)
{
  const FilterSection section = FilterSection::bandPass(10.0, 4.0, kPeriod_s);
  // The edges f1 f2 = 100 Hz^2 and f2 - f1 = 4 Hz lie at -3 dB; the bilinear transform moves them by under 0.1 %.
  EXPECT_NEAR(gainAt(section, 10.0), 1.0, 0.005);
  EXPECT_NEAR(gainAt(section, std::sqrt(104.0) - 2.0), std::sqrt(0.5), 0.01);
  EXPECT_NEAR(gainAt(section, std::sqrt(104.0) + 2.0), std::sqrt(0.5), 0.01);
}

TEST(FilterSection, LowPassAndLagHaveTheirCorners)
{
  const FilterSection low = FilterSection::lowPass(2.0, kPeriod_s);
  EXPECT_NEAR(gainAt(low, 0.2), 1.0, 0.005);
  EXPECT_NEAR(gainAt(low, 2.0), std::sqrt(0.5), 0.01);
  EXPECT_NEAR(gainAt(low, 20.0), 0.01, 0.002);  // second order: a hundredth a decade
  EXPECT_NEAR(gainAt(FilterSection::lag(0.04, kPeriod_s), 1.0 / (2.0 * kPi * 0.04)), std::sqrt(0.5), 0.01);
}

TEST(FilterSection, HoldsAnInputAsIfItHadLastedForEver)
{
  FilterSection section = FilterSection::lowPass(0.5, kPeriod_s);
  section.hold(3.0);
  for (int i = 0; i < 1000; ++i) ASSERT_NEAR(section.step(3.0), 3.0, 1e-9);
}

TEST(ShapedNoise, HasUnitRmsAndItsRateFromTheFirstSampleOn)
{
  // Over many seeds at the first sample: the ensemble is stationary, not only the time average.
  double square = 0.0;
  double rate_square = 0.0;
  const int seeds = 1500;
  double rate = 0.0;
  for (int seed = 0; seed < seeds; ++seed) {
    ShapedNoise noise = ShapedNoise::lowPass(5.0, kPeriod_s, Random(static_cast<std::uint64_t>(seed), 1));
    const double first = noise.step();
    const double change = (noise.step() - first) / kPeriod_s;
    square += first * first / seeds;
    rate_square += change * change / seeds;
    rate = noise.rateRms();
  }
  const double kThreeSigma = 3.0 / std::sqrt(2.0 * seeds);
  EXPECT_NEAR(std::sqrt(square), 1.0, kThreeSigma);
  EXPECT_NEAR(std::sqrt(rate_square) / rate, 1.0, kThreeSigma);
  // Second-order Butterworth: the rate's RMS is the corner's angular frequency.
  EXPECT_NEAR(rate, 2.0 * kPi * 5.0, 0.02 * 2.0 * kPi * 5.0);
}

TEST(HandTremor, TremorHasTheRmsOfItsSeedOnEachAxisAndItsBand)
{
  HandTremor hand({}, 7);
  std::vector<double> axes[3];
  for (int i = 0; i < 60000; ++i) {
    const auto& moved = hand.step(HandTremor::Support::none);
    for (int axis = 0; axis < 3; ++axis) axes[axis].push_back(moved.tremor[axis]);
  }
  for (const auto& axis : axes) {
    // 60 s of a band 2.6 Hz wide: 312 independent values, so 4 % of spread; three of it.
    EXPECT_NEAR(rms(axis) / hand.tremorRms(), 1.0, 0.12);
  }
  // Two resonances in a row, each 4 Hz wide: (1 / 4 + pi / 8) 4 / pi = 81.8 % of the power within 8-12 Hz.
  const std::vector<double> twenty(axes[0].begin(), axes[0].begin() + 20000);
  EXPECT_NEAR(shareBetween(twenty, 8.0, 12.0), 0.818, 0.08);
  EXPECT_GT(shareBetween(twenty, 4.0, 20.0), 0.97);
}

TEST(HandTremor, AxesAreIndependent)
{
  HandTremor hand({}, 8);
  double product = 0.0;
  const int samples = 60000;
  for (int i = 0; i < samples; ++i) {
    const auto& moved = hand.step(HandTremor::Support::none);
    product += moved.tremor.x() * moved.tremor.y() / samples;
  }
  EXPECT_LT(std::abs(product), 0.2 * hand.tremorRms() * hand.tremorRms());
}

TEST(HandTremor, HandsDifferWithinTheirRanges)
{
  double tremor_sum = 0.0;
  double drift_sum = 0.0;
  const int hands = 200;
  for (int seed = 0; seed < hands; ++seed) {
    HandTremorOptions quick;  // the ranges, without the slow parts' settling
    quick.drift_hz = quick.lean_hz = 5.0;
    const HandTremor hand(quick, static_cast<std::uint64_t>(seed));
    EXPECT_GE(hand.tremorRms(), 50.0 * kMicro);
    EXPECT_LE(hand.tremorRms(), 100.0 * kMicro);
    EXPECT_GE(hand.driftRms(), 40.0 * kMicro);
    EXPECT_LE(hand.driftRms(), 90.0 * kMicro);
    tremor_sum += hand.tremorRms() / hands;
    drift_sum += hand.driftRms() / hands;
  }
  EXPECT_NEAR(tremor_sum, 75.0 * kMicro, 3.1 * kMicro);  // three times 50 / sqrt(12) / sqrt(200)
  EXPECT_NEAR(drift_sum, 65.0 * kMicro, 3.1 * kMicro);
}

TEST(HandTremor, DriftAndLeanAreSlowAndHaveTheirRms)
{
  double drift_square = 0.0;
  double lean_square = 0.0;
  double fast_share = 0.0;
  const int hands = 30;
  for (int seed = 0; seed < hands; ++seed) {
    HandTremor hand({}, static_cast<std::uint64_t>(seed));
    recorded(hand, 2.0, HandTremor::Support::fixture, [](const auto& moved) { return moved.lean.x(); });
    const auto drift =
        recorded(hand, 10.0, HandTremor::Support::fixture, [](const auto& moved) { return moved.drift.x(); });
    const auto lean =
        recorded(hand, 10.0, HandTremor::Support::fixture, [](const auto& moved) { return moved.lean.y(); });
    drift_square += std::pow(rms(drift) / hand.driftRms(), 2) / hands;
    lean_square += std::pow(rms(lean), 2) / hands;
    fast_share += shareBetween(drift, 1.5, 4.0) / hands;
  }
  // Second order from 0.5 Hz on: 1.1 % of the power is above three times that; the ends of the record add some.
  EXPECT_LT(fast_share, 0.03);
  EXPECT_NEAR(std::sqrt(drift_square), 1.0, 0.12);                     // about 300 independent values of the drift,
  EXPECT_NEAR(std::sqrt(lean_square), 150.0 * kMicro, 25.0 * kMicro);  // 100 of the lean
}

TEST(HandTremor, LeansOnlyOnAFixtureAndWithoutAStep)
{
  HandTremor hand({}, 3);
  for (int i = 0; i < 500; ++i) EXPECT_EQ(hand.step(HandTremor::Support::none).lean.norm(), 0.0);
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (int i = 0; i < 8000; ++i) {
    const auto support = i < 4000 ? HandTremor::Support::fixture : HandTremor::Support::none;
    const Eigen::Vector3d lean = hand.step(support).lean;
    EXPECT_LT((lean - last).norm(), 1.5 * kMicro) << i;  // 600 um within the 2 s that it takes, and its own pace
    last = lean;
  }
  EXPECT_EQ(last.norm(), 0.0);
}

TEST(HandTremor, EqualSeedsGiveEqualHands)
{
  HandTremor a({}, 11);
  HandTremor b({}, 11);
  HandTremor c({}, 12);
  double apart = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d moved = a.step(HandTremor::Support::fixture).sum();
    EXPECT_EQ(moved, b.step(HandTremor::Support::fixture).sum());
    apart += (moved - c.step(HandTremor::Support::fixture).sum()).norm();
  }
  EXPECT_GT(apart, 0.0);
}

}  // namespace
}  // namespace eyeslam::simulation
