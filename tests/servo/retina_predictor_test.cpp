// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/retina_predictor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "eyeslam/servo/loop_time.h"

#include "support/allocation_counter.h"

namespace eyeslam::servo {
namespace {

using retina::Pose2;
using retina::Reason;

constexpr std::int64_t kStart_us = 1'000'000'000;
constexpr double kDegree = 3.14159265358979323846 / 180.0;

std::int64_t utimeOf(double t_s) { return kStart_us + std::llround(1e6 * t_s); }

// A retina that moves, turns and grows steadily.
Pose2 steady(double t) { return {1e-3 * t, -0.5e-3 * t, 2.0 * kDegree * t, std::exp(0.01 * t)}; }

SeenPose seen(double t, const Pose2& pose) { return {utimeOf(t), pose, 0.0, 0.0}; }

double distance(const Pose2& a, const Pose2& b) { return std::hypot(a.x - b.x, a.y - b.y); }

TEST(RetinaPredictor, ConstantVelocityTurnAndZoomArePredictedExactly)
{
  for (const double hz : {30.0, 120.0}) {
    RetinaPredictor retina({});
    double t = 0.0;
    for (int i = 0; i < 20.0 * hz; ++i, t = i / hz) retina.correct(seen(t, steady(t)), utimeOf(t) + 15000);
    const double ahead = seconds(retina.utime() - kStart_us) + 0.04;
    const PredictedPose there = retina.at(utimeOf(ahead));
    EXPECT_LT(distance(there.view_T_retina, steady(ahead)), 1e-8) << hz;
    EXPECT_NEAR(there.view_T_retina.theta, steady(ahead).theta, 1e-6) << hz;
    EXPECT_NEAR(there.view_T_retina.scale, steady(ahead).scale, 1e-6) << hz;
    EXPECT_NEAR(there.age_s, 0.04, 2e-6);
  }
}

TEST(RetinaPredictor, WhatThePortExplainsIsKnownBeforeTheCameraSeesIt)
{
  // The retina follows the port through the predictor's own fast low-pass, the other way: after learning the gain a
  // movement that no frame has shown yet is predicted.
  RetinaPredictor retina({});
  const double gain = -0.4;
  double lagged = 0.0;
  std::mt19937 random(3);
  std::normal_distribution<double> push(0.0, 1.0);
  double port = 0.0, velocity = 0.0, next_frame = 0.0;
  double with = 0.0, without = 0.0;
  Pose2 last;
  for (int i = 0; i < 20000; ++i) {
    const double t = 1e-3 * i;
    velocity += 1e-3 * (-3.0 * velocity - 10.0 * port + 0.3 * push(random));
    port += 1e-3 * velocity;
    lagged += (1.0 - std::exp(-1e-3 / 0.04)) * (port - lagged);
    retina.observePort(utimeOf(t), {port, 0.0});
    const Pose2 now{gain * lagged, 0.0, 0.0, 1.0};
    if (t >= next_frame) {
      retina.correct(seen(t, now), utimeOf(t));
      last = now;
      next_frame += 0.1;
    }
    if (t < 5.0) continue;
    with += std::pow(distance(retina.at(utimeOf(t)).view_T_retina, now), 2);
    without += std::pow(distance(last, now), 2);
  }
  EXPECT_LT(std::sqrt(with), 0.2 * std::sqrt(without));
}

TEST(RetinaPredictor, TakesAJumpWithItsPlaceButNotItsSpeed)
{
  RetinaPredictor retina({});
  double t = 0.0;
  for (int i = 0; i < 30; ++i, t = i / 30.0) retina.correct(seen(t, {}), utimeOf(t));
  const Pose2 there{400e-6, 300e-6, 0.0, 1.0};
  EXPECT_EQ(retina.correct(seen(t, there), utimeOf(t)), Reason::pose_jumped);
  EXPECT_NEAR(retina.surprise(), 500e-6, 1e-6);
  EXPECT_EQ(retina.jumpUtime(), utimeOf(t));
  EXPECT_LT(distance(retina.at(utimeOf(t + 0.03)).view_T_retina, there), 1e-9);
  EXPECT_LT(retina.at(utimeOf(t + 0.03)).velocity.norm(), 1e-9);
}

TEST(RetinaPredictor, AnOutlierIsUndoneByTheNextFrameWithTheSpeedThatWasKnown)
{
  RetinaPredictor retina({});
  double t = 0.0;
  for (int i = 0; i < 300; ++i, t = i / 30.0) retina.correct(seen(t, steady(t)), utimeOf(t));
  Pose2 wrong = steady(t);
  wrong.x += 300e-6;
  EXPECT_EQ(retina.correct(seen(t, wrong), utimeOf(t)), Reason::pose_jumped);
  t += 1.0 / 30.0;
  EXPECT_EQ(retina.correct(seen(t, steady(t)), utimeOf(t)), Reason::none);
  EXPECT_LT(distance(retina.at(utimeOf(t + 0.03)).view_T_retina, steady(t + 0.03)), 1e-6);
}

TEST(RetinaPredictor, FastFramesWaitForASecondLookUnlessAFrameWasMissing)
{
  const Pose2 there{300e-6, 0.0, 0.0, 1.0};
  for (const bool missing : {false, true}) {
    RetinaPredictor retina({});
    double t = 0.0;
    for (int i = 0; i < 240; ++i, t = i / 120.0) retina.correct(seen(t, {}), utimeOf(t));
    if (missing) t += 2.0 / 120.0;
    EXPECT_EQ(retina.correct(seen(t, there), utimeOf(t)), Reason::pose_jumped);
    const double off = distance(retina.at(utimeOf(t)).view_T_retina, there);
    EXPECT_LT(std::abs(off - (missing ? 0.0 : 300e-6)), 1e-6);
    t += 1.0 / 120.0;
    retina.correct(seen(t, there), utimeOf(t));
    EXPECT_LT(distance(retina.at(utimeOf(t)).view_T_retina, there), 5e-6);
  }
}

TEST(RetinaPredictor, VelocityFadesAndUncertaintyGrowsWithTheAge)
{
  RetinaPredictor retina({});
  double t = 0.0;
  for (int i = 0; i < 300; ++i, t = i / 30.0) retina.correct(seen(t, steady(t)), utimeOf(t));
  const double last = seconds(retina.utime() - kStart_us);
  const Pose2 start = retina.at(retina.utime()).view_T_retina;
  // Full speed up to 60 ms, then at most 100 ms of it more (contracts, section 4).
  const double speed = std::hypot(1e-3, 0.5e-3);
  EXPECT_NEAR(distance(retina.at(utimeOf(last + 0.06)).view_T_retina, start), 0.06 * speed, 1e-8);
  EXPECT_NEAR(distance(retina.at(utimeOf(last + 10.0)).view_T_retina, start), 0.16 * speed, 1e-8);
  double sigma = 0.0;
  for (double age = 0.0; age < 0.5; age += 0.02) {
    const PredictedPose there = retina.at(utimeOf(last + age));
    EXPECT_GT(there.sigma, sigma);
    sigma = there.sigma;
  }
}

TEST(RetinaPredictor, ALostPortChangesNothingAtOnce)
{
  RetinaPredictor retina({});
  for (int i = 0; i < 5000; ++i) {
    const double t = 1e-3 * i;
    const double port = 1e-3 * std::sin(2.0 * t);
    retina.observePort(utimeOf(t), {port, 0.0});
    if (i % 33 == 0) retina.correct(seen(t, {-0.4e-3 * std::sin(2.0 * t), 0.0, 0.0, 1.0}), utimeOf(t));
  }
  const std::int64_t then = utimeOf(5.03);
  const Pose2 before = retina.at(then).view_T_retina;
  retina.observePort(then, {5e-3, 0.0});  // back after a silence, at another origin
  EXPECT_LT(distance(retina.at(then).view_T_retina, before), 2e-6);
}

TEST(RetinaPredictor, RefusedPosesChangeNothing)
{
  RetinaPredictor retina({});
  double t = 0.0;
  for (int i = 0; i < 60; ++i, t = i / 30.0) retina.correct(seen(t, steady(t)), utimeOf(t));
  const Pose2 before = retina.at(utimeOf(t)).view_T_retina;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(retina.correct(seen(t, {nan, 0.0, 0.0, 1.0}), utimeOf(t)), Reason::pose_not_finite);
  EXPECT_EQ(retina.correct(seen(t, {0.0, 0.0, INFINITY, 1.0}), utimeOf(t)), Reason::pose_not_finite);
  EXPECT_EQ(retina.correct(seen(t, {0.0, 0.0, 0.0, 0.0}), utimeOf(t)), Reason::pose_not_finite);
  EXPECT_EQ(retina.correct(seen(t - 0.1, {}), utimeOf(t)), Reason::pose_late);
  EXPECT_EQ(retina.correct(seen(t + 0.001, {}), utimeOf(t)), Reason::pose_late);  // from the future
  EXPECT_EQ(retina.correct(seen(t, {}), utimeOf(t + 0.6)), Reason::pose_late);    // older than the port's history
  EXPECT_EQ(retina.observePort(utimeOf(t), {nan, 0.0}), Reason::state_not_finite);
  EXPECT_EQ(distance(retina.at(utimeOf(t)).view_T_retina, before), 0.0);
}

TEST(RetinaPredictor, NeverAllocates)
{
  RetinaPredictor retina({});
  const std::int64_t before = support::allocations();
  for (int i = 0; i < 2000; ++i) {
    const double t = 1e-3 * i;
    retina.observePort(utimeOf(t), {1e-6 * i, 0.0});
    if (i % 33 == 0) retina.correct(seen(t, i % 99 == 0 ? Pose2{1e-3, 0.0, 0.0, 1.0} : Pose2{}), utimeOf(t));
    retina.at(utimeOf(t + 0.005));
  }
  EXPECT_EQ(support::allocations(), before);
}

}  // namespace
}  // namespace eyeslam::servo
