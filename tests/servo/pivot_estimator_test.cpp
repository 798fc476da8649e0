// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/pivot_estimator.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "eyeslam/retina/turn_between.h"
#include "eyeslam/simulation/hand.h"
#include "eyeslam/simulation/retina_motion.h"
#include "support/allocation_counter.h"

using namespace eyeslam;
using eyeslam::retina::Reason;
using eyeslam::servo::PivotEstimator;

namespace {

constexpr double kMicro = 1e-6;

messaging::ToolPose shaftThrough(const Eigen::Vector3d& port, const Eigen::Vector3d& tip)
{
  return {tip, retina::turnBetween(Eigen::Vector3d::UnitZ(), tip - port)};
}

/// A simulated hand that holds a retina point in situ: the eye is turned by it, so its port moves by some 0.1 mm; the
/// shaft goes through the port with a play, and is measured with noise.
class HeldInstrument {
 public:
  explicit HeldInstrument(std::uint64_t seed)
      : random_(static_cast<unsigned>(seed)),
        hand_({}, kStart, seed),
        eye_(simulation::retinaMotionOptions("in_situ"), seed)
  {}

  void step()
  {
    const simulation::HandState& hand =
        hand_.step({kStart, Eigen::Vector3d::Zero(), tip, tip}, simulation::HandTremor::Support::fixture);
    displacement << eye_.step(hand).port, 0.0;
    port = kPort + displacement;
    tip = hand.null;
    null = shaftThrough(port + play(), tip);
    measured.position = tip + noise(3.0 * kMicro);
    const Eigen::Vector3d turn = noise(0.15e-3);
    measured.orientation =
        null.orientation * Eigen::Quaterniond(1.0, turn.x() / 2, turn.y() / 2, turn.z() / 2).normalized();
    measured_displacement = displacement + noise(3.0 * kMicro);
  }
  Eigen::Vector3d noise(double sigma)
  {
    return sigma * Eigen::Vector3d(normal_(random_), normal_(random_), normal_(random_));
  }

  static const Eigen::Vector3d kStart, kPort;  // the port 20 mm up a shaft at 32 degrees
  Eigen::Vector3d displacement, port, tip = kStart, measured_displacement;
  messaging::ToolPose null, measured;

 private:
  // 15 um in a second or so, of a trocar.
  Eigen::Vector3d play()
  {
    t_ += 1e-3;
    return 15.0 * kMicro * Eigen::Vector3d(std::sin(5.0 * t_), std::cos(7.0 * t_), std::sin(3.0 * t_));
  }

  std::mt19937 random_;
  std::normal_distribution<double> normal_{0.0, 1.0};
  simulation::Hand hand_;
  simulation::RetinaMotion eye_;
  double t_ = 0.0;
};

const Eigen::Vector3d HeldInstrument::kStart(0.0, 0.0, -0.5e-3);
const Eigen::Vector3d HeldInstrument::kPort(-20e-3 * std::sin(0.56), 0.0, -0.5e-3 - 20e-3 * std::cos(0.56));

double distanceFromShaft(const Eigen::Vector3d& port, const Eigen::Vector3d& pivot, const Eigen::Vector3d& tip)
{
  return (port - tip).cross((tip - pivot).normalized()).norm();
}

/// Tips all over the reach of the manipulator.
Eigen::Vector3d deflected(HeldInstrument& held)
{
  const Eigen::Vector3d way = held.noise(1.0).normalized();
  return held.tip + 2e-3 * way;
}

TEST(PivotEstimator, FindsThePointWhereShaftsWithoutErrorsMeet)
{
  PivotEstimator estimator;
  const Eigen::Vector3d port(3e-3, -2e-3, -21e-3);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> across(-1.5e-3, 1.5e-3);
  for (int i = 0; i < 100; ++i)
    ASSERT_EQ(estimator.observe(shaftThrough(port, {across(random), across(random), across(random)})), Reason::none);
  ASSERT_TRUE(estimator.pivot());
  EXPECT_LT((*estimator.pivot() - port).norm(), 1e-9);
}

TEST(PivotEstimator, KeepsTheRemoteCentreWithin100MicrometresOverTheWholeReach)
{
  double worst = 0.0, latest = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    HeldInstrument held(seed);
    PivotEstimator estimator;
    double known_from_s = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 15000; ++i) {
      held.step();
      estimator.observe(held.measured, held.measured_displacement);
      const auto pivot = estimator.pivot();
      if (!pivot) continue;
      known_from_s = std::min(known_from_s, 1e-3 * i);
      worst = std::max(worst, distanceFromShaft(held.port, *pivot, deflected(held)));
    }
    latest = std::max(latest, known_from_s);
  }
  RecordProperty("worst_um", std::to_string(worst * 1e6));
  RecordProperty("known_after_s", std::to_string(latest));
  EXPECT_LT(worst, 100.0 * kMicro);
  EXPECT_LT(latest, 10.0);
}

TEST(PivotEstimator, HasNoneWhileTheShaftsAreParallel)
{
  PivotEstimator estimator;
  HeldInstrument held(1);
  const Eigen::Quaterniond still = shaftThrough(held.kPort, held.kStart).orientation;
  for (int i = 0; i < 3000; ++i) {
    held.step();
    const Eigen::Vector3d turn = held.noise(0.15e-3);
    estimator.observe({held.tip, still * Eigen::Quaterniond(1.0, turn.x() / 2, turn.y() / 2, 0.0).normalized()});
    ASSERT_FALSE(estimator.pivot()) << i;
  }
}

TEST(PivotEstimator, MovesWithTheMeasuredPort)
{
  PivotEstimator estimator;
  HeldInstrument held(2);
  for (int i = 0; i < 5000; ++i) {
    held.step();
    estimator.observe(held.null, held.displacement);
  }
  ASSERT_TRUE(estimator.pivot());
  const Eigen::Vector3d before = *estimator.pivot();
  const Eigen::Vector3d further(200e-6, -100e-6, 0.0);
  estimator.observe(shaftThrough(held.port + further, held.tip), held.displacement + further);
  EXPECT_LT((*estimator.pivot() - before - further).norm(), 1e-6);
}

TEST(PivotEstimator, StartsAnewWhereTheToolEntersElsewhere)
{
  PivotEstimator estimator;
  HeldInstrument held(4);
  const Eigen::Vector3d elsewhere(8e-3, 5e-3, 0.0);
  for (int i = 0; i < 10000; ++i) {
    held.step();
    estimator.observe(held.measured, held.measured_displacement);
  }
  ASSERT_TRUE(estimator.pivot());
  int gone_after = -1;
  for (int i = 0; i < 16000; ++i) {
    held.step();
    const Eigen::Vector3d port = held.port + elsewhere;
    estimator.observe(shaftThrough(port, held.tip), held.displacement);
    if (gone_after < 0 && !estimator.pivot()) gone_after = i;
    if (i > 100 && estimator.pivot()) {
      ASSERT_LT((*estimator.pivot() - port).norm(), 1e-3) << i;
    }
  }
  EXPECT_LT(gone_after, 25);
  EXPECT_TRUE(estimator.pivot());
}

TEST(PivotEstimator, RefusesWhatIsNoPose)
{
  PivotEstimator estimator;
  messaging::ToolPose pose;
  pose.position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(estimator.observe(pose), Reason::not_finite);
  EXPECT_EQ(estimator.observe({Eigen::Vector3d::Zero(), Eigen::Quaterniond(0.0, 0.0, 0.0, 0.0)}), Reason::not_finite);
  EXPECT_EQ(estimator.observe({}, Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity())),
            Reason::not_finite);
  EXPECT_FALSE(estimator.pivot());
  EXPECT_EQ(estimator.observe({}), Reason::none);
}

TEST(PivotEstimator, NeverAllocates)
{
  PivotEstimator estimator;
  HeldInstrument held(5);
  held.step();
  for (int i = 0; i < 2000; ++i) {
    held.step();
    const std::int64_t before = support::allocations();
    estimator.observe(held.measured, held.measured_displacement);
    ASSERT_EQ(support::allocations(), before);
  }
}

}  // namespace
