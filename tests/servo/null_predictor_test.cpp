// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/null_predictor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/allocation_counter.h"

namespace eyeslam::servo {
namespace {

using retina::Reason;

constexpr std::int64_t kStart_us = 1'000'000'000;
constexpr std::int64_t kPeriod_us = 1000;
constexpr double kHorizon_s = 5.8e-3;  // lead of the plant + age of a state, loop study, section 2
constexpr double kTwoPi = 2.0 * 3.14159265358979323846;

Eigen::Vector3d line(double t) { return Eigen::Vector3d(1e-3, -2e-3, 0.5e-3) * t + Eigen::Vector3d(3e-4, 0.0, 1e-4); }

Eigen::Vector3d wave(double t, double hz)
{
  return 1e-4 * Eigen::Vector3d(std::sin(kTwoPi * hz * t), std::cos(kTwoPi * hz * t), std::sin(kTwoPi * hz * t + 1.0));
}

template <class Motion>
double worstError(const NullPredictorOptions& options, Motion&& motion, double settling_s)
{
  NullPredictor hand(options);
  double worst = 0.0;
  for (int i = 0; i < static_cast<int>((settling_s + 1.0) * 1000); ++i) {
    const double t = 1e-3 * i;
    hand.correct(kStart_us + i * kPeriod_us, motion(t));
    const Eigen::Vector3d ahead = hand.at(hand.utime() + std::llround(1e6 * kHorizon_s));
    if (t > settling_s) worst = std::max(worst, (ahead - motion(t + kHorizon_s)).norm());
  }
  return worst;
}

TEST(NullPredictor, ConstantVelocityIsPredictedExactly)
{
  // It is in the model, so without noise nothing is left but rounding, and the start, which the drift forgets slowly.
  EXPECT_LT(worstError({}, line, 20.0), 1e-9);
}

TEST(NullPredictor, OscillationsOfItsOwnFrequenciesArePredictedAlmostExactly)
{
  // Nearly undamped, its oscillators go on by themselves: within a hundredth of the amplitude.
  NullPredictorOptions options;
  options.damping_per_s = 0.05;
  for (const double hz : {options.low_hz, options.middle_hz, options.high_hz})
    EXPECT_LT(worstError(
                  options, [hz](double t) { return wave(t, hz); }, 5.0),
              1e-6)
        << hz;
}

TEST(NullPredictor, TremorOfAnyFrequencyLeavesLittleOfWhatTheAgeAloneWouldCost)
{
  for (const double hz : {7.0, 8.0, 9.0, 11.0, 12.0, 13.0}) {
    const double uncorrected = 2.0 * 1.5e-4 * std::sin(0.5 * kTwoPi * hz * kHorizon_s);
    EXPECT_LT(worstError(
                  {}, [hz](double t) { return wave(t, hz); }, 3.0),
              0.2 * uncorrected)
        << hz;
  }
}

TEST(NullPredictor, VelocityIsTheSlopeOfWhatItPredicts)
{
  NullPredictor hand({});
  for (int i = 0; i < 2000; ++i) hand.correct(kStart_us + i * kPeriod_us, line(1e-3 * i) + wave(1e-3 * i, 9.0));
  const std::int64_t then = hand.utime() + 4000;
  const Eigen::Vector3d slope = (hand.at(then + 10) - hand.at(then - 10)) / 20e-6;
  EXPECT_LT((hand.velocityAt(then) - slope).norm(), 1e-6);  // of about 10 mm/s; the differences are rounded to 1e-9
}

TEST(NullPredictor, AMissedStateCostsLittleAndALongSilenceStartsAnew)
{
  NullPredictor hand({});
  for (int i = 0; i < 3000; ++i)
    if (i % 10 < 8) hand.correct(kStart_us + i * kPeriod_us, wave(1e-3 * i, 10.0));
  EXPECT_LT((hand.at(kStart_us + 3000 * kPeriod_us) - wave(3.0, 10.0)).norm(), 5e-6);
  const Eigen::Vector3d elsewhere(1e-2, 2e-2, 3e-2);
  EXPECT_EQ(hand.correct(kStart_us + 4'000'000, elsewhere), Reason::none);
  EXPECT_LT((hand.at(kStart_us + 4'000'000) - elsewhere).norm(), 1e-12);
  EXPECT_LT(hand.velocityAt(kStart_us + 4'000'000).norm(), 1e-12);
}

TEST(NullPredictor, RefusedStatesChangeNothing)
{
  NullPredictor hand({});
  for (int i = 0; i < 100; ++i) hand.correct(kStart_us + i * kPeriod_us, line(1e-3 * i));
  const Eigen::Vector3d before = hand.at(kStart_us + 110'000);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(hand.correct(kStart_us + 100 * kPeriod_us, {0.0, nan, 0.0}), Reason::state_not_finite);
  EXPECT_EQ(hand.correct(kStart_us + 100 * kPeriod_us, {INFINITY, 0.0, 0.0}), Reason::state_not_finite);
  EXPECT_EQ(hand.correct(kStart_us + 99 * kPeriod_us, line(1.0)), Reason::state_late);
  EXPECT_EQ(hand.correct(kStart_us + 5 * kPeriod_us, line(1.0)), Reason::state_late);
  EXPECT_EQ(hand.at(kStart_us + 110'000), before);
}

TEST(NullPredictor, NeverAllocates)
{
  NullPredictor hand({});
  const std::int64_t before = support::allocations();
  for (int i = 0; i < 100; ++i) {
    hand.correct(kStart_us + i * kPeriod_us, line(1e-3 * i));
    hand.at(hand.utime() + 5000);
  }
  EXPECT_EQ(support::allocations(), before);
}

}  // namespace
}  // namespace eyeslam::servo
