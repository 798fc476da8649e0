// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/surgeon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "eyeslam/simulation/hand.h"
#include "eyeslam/simulation/traced_path.h"

namespace eyeslam::simulation {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr double kMicro = 1e-6;
const Eigen::Vector3d kOrigin = Eigen::Vector3d::Zero();

SurgeonView targetAt(double x) { return {{x, 0.0, 0.0}, kOrigin, kOrigin, kOrigin}; }

// Velocities along x while the view stays as it is after a first look at nothing to do.
std::vector<double> answers(const SurgeonView& view, int samples)
{
  Surgeon surgeon({}, kOrigin, kPeriod_s);
  surgeon.step(SurgeonView{});
  std::vector<double> velocities;
  double last = 0.0;
  for (int i = 0; i < samples; ++i) {
    const double x = surgeon.step(view).x();
    velocities.push_back((x - last) / kPeriod_s);
    last = x;
  }
  return velocities;
}

TEST(Surgeon, DoesNothingForAReactionTimeAndThenFollowsThroughHisLag)
{
  const auto velocity = answers(targetAt(525.0 * kMicro), 1500);
  const double wanted = 1.8 * 500.0 * kMicro;  // beyond the dead zone of 25 um
  for (std::size_t i = 0; i < 199; ++i) EXPECT_EQ(velocity[i], 0.0) << i;
  EXPECT_GT(velocity[201], 0.0);
  EXPECT_NEAR(velocity[300] / wanted, 1.0 - std::exp(-1.0), 0.01);  // 100 ms later
  EXPECT_NEAR(velocity[1499] / wanted, 1.0, 1e-4);
}

TEST(Surgeon, LeavesSmallDistancesAlone)
{
  for (const double velocity : answers(targetAt(24.0 * kMicro), 1000)) EXPECT_EQ(velocity, 0.0);
  EXPECT_GT(answers(targetAt(30.0 * kMicro), 1000).back(), 0.0);
}

TEST(Surgeon, KnowsThePathAheadWithoutDelayButNotWithoutHisLag)
{
  SurgeonView view;
  view.path_velocity = {0.4e-3, 0.0, 0.0};
  const auto velocity = answers(view, 1000);
  EXPECT_NEAR(velocity[99] / 0.4e-3, 1.0 - std::exp(-1.0), 0.01);
  EXPECT_NEAR(velocity.back() / 0.4e-3, 1.0, 1e-4);
}

TEST(Surgeon, PullsTheNullBackToATipThatIsFarFromIt)
{
  SurgeonView near;
  near.null = {-599.0 * kMicro, 0.0, 0.0};
  EXPECT_EQ(answers(near, 1000).back(), 0.0);
  SurgeonView far;
  far.null = {-700.0 * kMicro, 0.0, 0.0};
  EXPECT_NEAR(answers(far, 1500).back(), 1.8 * 100.0 * kMicro, 1e-7);
}

TEST(Surgeon, ClosesTheLoopWithoutOvershootBeyondAFewPercent)
{
  // Gain 1.8/s, 200 ms of delay and 100 ms of lag: a phase margin of 59 deg by calculation.
  Surgeon surgeon({}, kOrigin, kPeriod_s);
  Eigen::Vector3d tip = kOrigin;
  double farthest = 0.0;
  for (int i = 0; i < 10000; ++i) {
    tip = surgeon.step({{1e-3, 0.0, 0.0}, kOrigin, tip, tip});
    farthest = std::max(farthest, tip.x());
  }
  EXPECT_NEAR(tip.x(), 1e-3, 26.0 * kMicro);
  EXPECT_LT(farthest, 1.1e-3);
}

TEST(TracedPath, GoesForthAndBackAtItsSpeed)
{
  const TracedPath path({{0, 0, 0}, {3e-3, 0, 0}, {3e-3, 4e-3, 0}}, 1e-3);  // 7 mm: 7 s a way
  EXPECT_NEAR(path.length(), 7e-3, 1e-15);
  EXPECT_TRUE(path.at(1.0).position.isApprox(Eigen::Vector3d(1e-3, 0, 0)));
  EXPECT_TRUE(path.at(5.0).position.isApprox(Eigen::Vector3d(3e-3, 2e-3, 0)));
  EXPECT_TRUE(path.at(5.0).velocity.isApprox(Eigen::Vector3d(0, 1e-3, 0)));
  EXPECT_TRUE(path.at(9.0).position.isApprox(Eigen::Vector3d(3e-3, 2e-3, 0)));
  EXPECT_TRUE(path.at(9.0).velocity.isApprox(Eigen::Vector3d(0, -1e-3, 0)));
  EXPECT_TRUE(path.at(14.0 + 1.0).position.isApprox(path.at(1.0).position));
}

TEST(TracedPath, RefusesAPathWithoutLength)
{
  EXPECT_THROW(TracedPath({}, 1.0), std::invalid_argument);
  EXPECT_THROW(TracedPath({kOrigin}, 1.0), std::invalid_argument);
  EXPECT_THROW(TracedPath({kOrigin, kOrigin}, 1.0), std::invalid_argument);
  EXPECT_THROW(TracedPath({kOrigin, Eigen::Vector3d::UnitX()}, 0.0), std::invalid_argument);
}

TEST(SineVessel, IsTheStudysVessel)
{
  const auto points = sineVessel(0.0, 0.0);
  EXPECT_EQ(points.front(), kOrigin);
  EXPECT_NEAR(points.back().x(), 3e-3, 1e-12);
  EXPECT_NEAR(points[points.size() / 4].y(), 300e-6 - 50e-6 * std::sqrt(0.5), 2e-6);  // x = 0.75 mm
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_LT((points[i] - points[i - 1]).norm(), 10e-6);
}

TEST(Hand, IsTheWillAndWhatItDoesBesides)
{
  Hand hand({}, {1e-3, 2e-3, -1e-3}, 4);
  HandTremor tremor({}, 4);
  Surgeon surgeon({}, {1e-3, 2e-3, -1e-3});
  const SurgeonView view = targetAt(2e-3);
  for (int i = 0; i < 500; ++i) {
    const HandState& held = hand.step(view, HandTremor::Support::fixture);
    const auto& moved = tremor.step(HandTremor::Support::fixture);
    EXPECT_TRUE(held.null.isApprox(surgeon.step(view) + moved.sum()));
    EXPECT_TRUE(held.tremor.isApprox(moved.tremor));
  }
  EXPECT_GT(hand.state().travel.x(), 0.0);
}

}  // namespace
}  // namespace eyeslam::simulation
