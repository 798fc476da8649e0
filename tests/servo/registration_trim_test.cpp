// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/registration_trim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "eyeslam/servo/integral_action.h"
#include "support/allocation_counter.h"

namespace eyeslam::servo {
namespace {

using retina::Reason;

constexpr std::int64_t kStart_us = 1'000'000'000;
constexpr double kExposure_s = 8e-3;

/// A registration that is off by a known affine map, and a tip that wanders over 2 mm.
struct Wrong {
  Eigen::Matrix2d matrix = (Eigen::Matrix2d() << 0.02, -0.0175, 0.0175, 0.02).finished();
  Eigen::Vector2d offset{30e-6, -20e-6};

  Eigen::Vector2d measured(const Eigen::Vector2d& seen) const { return seen + offset + matrix * seen; }
  static Eigen::Vector2d tip(double t) { return 1e-3 * Eigen::Vector2d(std::sin(0.7 * t), std::cos(1.1 * t)); }
};

/// Runs a trim over `seconds`; `error` is added to what is seen.
template <class Error>
void run(RegistrationTrim& trim, const Wrong& wrong, double from_s, double to_s, Error&& error)
{
  for (int i = static_cast<int>(1000 * from_s); i < static_cast<int>(1000 * to_s); ++i) {
    const double t = 1e-3 * i;
    trim.observe(kStart_us + 1000 * i, wrong.measured(Wrong::tip(t)));
    if (i % 33 != 32) continue;
    const double mid = t - 15e-3;
    trim.correct({kStart_us + 1000 * (i - 15), kExposure_s, Wrong::tip(mid) + error(mid), 0.0});
  }
}

const auto kNoError = [](double) { return Eigen::Vector2d(0.0, 0.0); };

TEST(RegistrationTrim, FindsAnAffineErrorAndInvertsIt)
{
  RegistrationTrim trim({}, Eigen::Vector2d::Zero());
  const Wrong wrong;
  run(trim, wrong, 0.0, 20.0, kNoError);
  for (const Eigen::Vector2d& place : {Eigen::Vector2d(8e-4, -6e-4), Eigen::Vector2d(-3e-4, 9e-4)}) {
    // The tip's path bends within an exposure, so its mean is not its middle.
    EXPECT_LT((trim.toMeasured(place) - wrong.measured(place)).norm(), 2e-6);
    EXPECT_LT((trim.toSeen(trim.toMeasured(place)) - place).norm(), 1e-12);
  }
}

TEST(RegistrationTrim, UnderNoiseItsErrorStaysWithinItsSigma)
{
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 5e-6);
  double squares = 0.0;
  const Eigen::Vector2d place(8e-4, -6e-4);
  for (int seed = 0; seed < 30; ++seed) {
    RegistrationTrim trim({}, Eigen::Vector2d::Zero());
    const Wrong wrong;
    run(trim, wrong, 0.0, 5.0, [&](double) { return Eigen::Vector2d(noise(random), noise(random)); });
    squares += std::pow((trim.toMeasured(place) - wrong.measured(place)).norm() / trim.sigmaAt(place), 2);
  }
  EXPECT_LT(squares / 30.0, 4.0);  // two axes make 2; the real offset does not even walk
}

TEST(RegistrationTrim, RefusesAWrongTipButFollowsAChangedRegistration)
{
  RegistrationTrim trim({}, Eigen::Vector2d::Zero());
  const Wrong wrong;
  run(trim, wrong, 0.0, 10.0, kNoError);
  const std::int64_t at = kStart_us + 9'995'000;
  EXPECT_EQ(trim.correct({at, kExposure_s, Wrong::tip(9.995) + Eigen::Vector2d(1e-4, 0.0), 0.0}), Reason::tip_far);
  EXPECT_LT((trim.toMeasured({8e-4, -6e-4}) - wrong.measured({8e-4, -6e-4})).norm(), 2e-6);
  Wrong bumped;
  bumped.offset += Eigen::Vector2d(80e-6, 0.0);
  run(trim, bumped, 10.0, 13.0, kNoError);
  EXPECT_LT((trim.toMeasured({8e-4, -6e-4}) - bumped.measured({8e-4, -6e-4})).norm(), 10e-6);
}

TEST(RegistrationTrim, RefusesWhatItCannotPlaceInTime)
{
  RegistrationTrim trim({}, Eigen::Vector2d::Zero());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(trim.correct({kStart_us, kExposure_s, {0.0, 0.0}, 0.0}), Reason::tip_late);  // nothing measured yet
  run(trim, {}, 0.0, 1.0, kNoError);
  const Eigen::Vector2d before = trim.toMeasured({8e-4, -6e-4});
  EXPECT_EQ(trim.correct({kStart_us + 990'000, kExposure_s, {nan, 0.0}, 0.0}), Reason::tip_not_finite);
  EXPECT_EQ(trim.correct({kStart_us + 999'000, kExposure_s, {0.0, 0.0}, 0.0}), Reason::tip_late);  // still exposing
  EXPECT_EQ(trim.correct({kStart_us + 500'000, kExposure_s, {0.0, 0.0}, 0.0}), Reason::tip_late);  // out of order
  EXPECT_EQ(trim.observe(kStart_us + 999'000, {0.0, 0.0}), Reason::state_late);
  EXPECT_EQ(trim.observe(kStart_us + 1'000'000, {nan, 0.0}), Reason::state_not_finite);
  EXPECT_EQ(trim.toMeasured({8e-4, -6e-4}), before);
}

TEST(RegistrationTrim, NeverAllocates)
{
  RegistrationTrim trim({}, Eigen::Vector2d::Zero());
  const std::int64_t before = support::allocations();
  run(trim, {}, 0.0, 1.0, kNoError);
  EXPECT_EQ(support::allocations(), before);
}

TEST(IntegralAction, TakesASteadyErrorAwayAtItsRate)
{
  IntegralAction integral({});
  const Eigen::Vector3d fault(20e-6, -10e-6, 5e-6);
  for (int i = 0; i < 500; ++i) integral.update(fault - integral.correction(), 1e-3);
  EXPECT_LT((integral.correction() - fault).norm(), 1.1 * fault.norm() * std::exp(-20.0 * 0.5));
}

TEST(IntegralAction, IsFrozenByLargeErrorsAndBoundedByItsLimit)
{
  IntegralAction integral({});
  for (int i = 0; i < 1000; ++i) integral.update({1e-3, 0.0, 0.0}, 1e-3);
  EXPECT_EQ(integral.correction(), Eigen::Vector3d::Zero());
  for (int i = 0; i < 10000; ++i) integral.update({50e-6, 30e-6, 0.0}, 1e-3);
  EXPECT_NEAR(integral.correction().norm(), 150e-6, 1e-12);
}

TEST(IntegralAction, IgnoresWhatIsNoNumber)
{
  IntegralAction integral({});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  integral.update({nan, 0.0, 0.0}, 1e-3);
  integral.update({10e-6, 0.0, 0.0}, nan);
  integral.update({10e-6, 0.0, 0.0}, -1.0);
  integral.update({INFINITY, 0.0, 0.0}, 1e-3);
  EXPECT_EQ(integral.correction(), Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace eyeslam::servo
