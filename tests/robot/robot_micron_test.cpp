// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/robot/robot_micron.h"

#include <gtest/gtest.h>
#include <visp3/robot/vpRobotException.h>

#include <cmath>
#include <limits>
#include <random>

#include "eyeslam/retina/turn_between.h"
#include "eyeslam/robot/tool_jacobian.h"
#include "eyeslam/robot/visp_conversion.h"
#include "support/simulated_micron.h"

using namespace eyeslam;
using eyeslam::retina::Reason;
using eyeslam::robot::RobotMicron;

namespace {

constexpr double kMicro = 1e-6;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

vpColVector numbers(double x, double y, double z) { return robot::toVisp(Eigen::VectorXd(Eigen::Vector3d(x, y, z))); }
vpColVector numbers(const Eigen::Vector3d& v) { return robot::toVisp(Eigen::VectorXd(v)); }

struct Bench {
  explicit Bench(const robot::RobotMicronOptions& options = {}) : robot(micron.link, micron.clock, options)
  {
    micron.step(3);
    robot.init();
  }
  // The program calls at 30 Hz.
  void keepCalling(int frames)
  {
    for (int i = 0; i < frames; ++i) {
      robot.keepAlive();
      micron.step(33);
    }
  }
  Eigen::Vector3d tip() const { return micron.controller.tip(); }

  support::SimulatedMicron micron;
  RobotMicron robot;
};

int codeOf(const std::function<void()>& call, std::string* message = nullptr)
{
  try {
    call();
  } catch (const vpRobotException& error) {
    if (message) *message = const_cast<vpRobotException&>(error).getStringMessage();
    return const_cast<vpRobotException&>(error).getCode();
  }
  return -1;
}

TEST(RobotMicron, AVelocityMovesTheTipByItsTimeAndNoFurther)
{
  Bench bench;
  bench.robot.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
  const Eigen::Vector3d start = bench.tip();
  const Eigen::Vector3d velocity(1e-3, -0.5e-3, 0.2e-3);
  for (int i = 0; i < 20; ++i) {
    bench.robot.setVelocity(vpRobot::REFERENCE_FRAME, numbers(velocity));
    bench.micron.step(33);
  }
  bench.robot.setVelocity(vpRobot::REFERENCE_FRAME, numbers(0, 0, 0));
  bench.micron.step(33);
  bench.keepCalling(5);
  EXPECT_LT((bench.tip() - start - 20 * 0.033 * velocity).norm(), 1.0 * kMicro);
}

TEST(RobotMicron, VelocitiesOfTheEndEffectorAreAlongTheTool)
{
  Bench bench;
  bench.robot.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
  const Eigen::Vector3d start = bench.tip(), shaft = -bench.micron.controller.shaft();
  for (int i = 0; i < 10; ++i) {
    bench.robot.setVelocity(vpRobot::END_EFFECTOR_FRAME, numbers(0, 0, 1e-3));
    bench.micron.step(33);
  }
  const Eigen::Vector3d moved = bench.tip() - start;
  EXPECT_GT(moved.dot(shaft), 250 * kMicro);
  EXPECT_LT(moved.cross(shaft).norm(), 5 * kMicro);
}

TEST(RobotMicron, NeverMovesFasterThanItsLimit)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (const double limit : {0.02, 0.004}) {
    Bench bench;
    bench.robot.setMaxTranslationVelocity(limit);
    bench.robot.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
    Eigen::Vector3d last = bench.tip();
    Eigen::Vector3d last_goal = bench.micron.controller.state().goal;
    double fastest = 0.0, commanded = 0.0;
    for (int i = 0; i < 60; ++i) {
      bench.robot.setVelocity(vpRobot::REFERENCE_FRAME, numbers(any(random), any(random), any(random)));
      for (int k = 0; k < 33; ++k) {
        bench.micron.step();
        fastest = std::max(fastest, (bench.tip() - last).norm() / 1e-3);
        last = bench.tip();
      }
      const Eigen::Vector3d& goal = bench.micron.controller.state().goal;
      commanded = std::max(commanded, (goal - last_goal).norm() / 33e-3);
      last_goal = goal;
    }
    // What is commanded never; the actuator (damping 0.7) overshoots a step of its speed by 4.6 %, a reversal is two.
    EXPECT_LT(commanded, limit * 34.0 / 33.0);  // the controller may round to one period of its own
    EXPECT_LT(fastest, 1.1 * limit);
    EXPECT_GT(fastest, 0.5 * limit);
  }
}

TEST(RobotMicron, StaysInItsCylinderAndLeavesTheEdgeAtOnce)
{
  robot::RobotMicronOptions options;
  options.reach_lateral_mm = 0.8;
  options.reach_axial_mm = 0.5;
  Bench bench(options);
  bench.robot.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
  std::mt19937 random(6);
  std::normal_distribution<double> any;
  const Eigen::Vector3d null = bench.micron.held.null, shaft = bench.micron.held.shaft;
  for (int run = 0; run < 6; ++run) {
    const Eigen::Vector3d way = 5e-3 * Eigen::Vector3d(any(random), any(random), any(random)).normalized();
    for (int i = 0; i < 40; ++i) {
      bench.robot.setVelocity(vpRobot::REFERENCE_FRAME, numbers(way));
      bench.micron.step(33);
      const Eigen::Vector3d reached = bench.tip() - null;
      ASSERT_LT(reached.cross(shaft).norm(), 0.81e-3);
      ASSERT_LT(std::abs(reached.dot(shaft)), 0.51e-3);
    }
    ASSERT_TRUE(bench.robot.isSaturated());
    // Back: what was asked beyond the edge is not made up for.
    const Eigen::Vector3d edge = bench.tip();
    for (int i = 0; i < 4; ++i) {
      bench.robot.setVelocity(vpRobot::REFERENCE_FRAME, numbers(-way));
      bench.micron.step(33);
    }
    EXPECT_GT((bench.tip() - edge).dot(-way.normalized()), 300 * kMicro);
  }
}

TEST(RobotMicron, APositionIsHeldInTheManipulatorsFrameWhileTheHandDrifts)
{
  Bench bench;
  const Eigen::Vector3d target = bench.tip() + Eigen::Vector3d(500 * kMicro, -300 * kMicro, 100 * kMicro);
  bench.micron.hand = [](double t) { return Eigen::Vector3d(300 * kMicro * std::sin(M_PI * t), 0.0, 0.0); };
  bench.robot.setRobotState(vpRobot::STATE_POSITION_CONTROL);
  vpColVector position = bench.robot.getPosition(vpRobot::REFERENCE_FRAME);
  for (unsigned i = 0; i < 3; ++i) position[i] = target[i];
  bench.robot.setPosition(vpRobot::REFERENCE_FRAME, position);
  bench.keepCalling(10);
  for (int i = 0; i < 40; ++i) {
    bench.keepCalling(1);
    // The plant follows 5 ms late, the hand's fastest is 0.94 mm/s.
    ASSERT_LT((bench.tip() - target).norm(), 8 * kMicro);
  }
}

TEST(RobotMicron, APositionOfTheJointsGoesWithTheHand)
{
  Bench bench;
  bench.micron.hand = [](double t) { return Eigen::Vector3d(300 * kMicro * std::sin(M_PI * t), 0.0, 0.0); };
  bench.robot.setRobotState(vpRobot::STATE_POSITION_CONTROL);
  const Eigen::Vector3d deflection(400 * kMicro, 200 * kMicro, 0.0);
  bench.robot.setPosition(vpRobot::JOINT_STATE, numbers(deflection));
  bench.keepCalling(20);
  EXPECT_LT((bench.tip() - bench.micron.held.null - deflection).norm(), 1 * kMicro);
  EXPECT_LT((robot::toEigen(bench.robot.getPosition(vpRobot::JOINT_STATE)) - deflection).norm(), 1 * kMicro);
}

TEST(RobotMicron, HandsTheTipBackGentlyWhenTheProgramStalls)
{
  Bench bench;
  bench.robot.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
  for (int i = 0; i < 10; ++i) {
    bench.robot.setVelocity(vpRobot::REFERENCE_FRAME, numbers(5e-3, 0, 0));
    bench.micron.step(33);
  }
  Eigen::Vector3d last = bench.tip();
  double fastest = 0.0;
  for (int i = 0; i < 500; ++i) {
    bench.micron.step();
    fastest = std::max(fastest, (bench.tip() - last).norm() / 1e-3);
    last = bench.tip();
  }
  EXPECT_LT(fastest, 0.0215);
  EXPECT_EQ(bench.micron.controller.state().reason, Reason::expired);
  EXPECT_TRUE(bench.micron.controller.state().cancels_tremor);
  // Back in time, it goes on from where the tip is, at rest.
  bench.keepCalling(4);
  EXPECT_LT((bench.tip() - last).norm(), 2 * kMicro);
  EXPECT_EQ(bench.robot.getReason(), Reason::none);
}

TEST(RobotMicron, AVelocityThatIsNotRenewedEndsThoughTheProgramLives)
{
  Bench bench;
  bench.robot.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
  const Eigen::Vector3d start = bench.tip();
  bench.robot.setVelocity(vpRobot::REFERENCE_FRAME, numbers(1e-3, 0, 0));
  for (int i = 0; i < 30; ++i) {
    bench.micron.step(20);
    bench.robot.keepAlive();
  }
  EXPECT_NEAR((bench.tip() - start).norm(), 200 * kMicro, 1 * kMicro);
}

TEST(RobotMicron, WhatIsNoNumberIsRefusedAndTheTipRests)
{
  Bench bench;
  bench.robot.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
  bench.robot.setVelocity(vpRobot::REFERENCE_FRAME, numbers(5e-3, 0, 0));
  bench.micron.step(33);
  const auto nothing = [&] { bench.robot.setVelocity(vpRobot::REFERENCE_FRAME, numbers(0, kNaN, 0)); };
  EXPECT_EQ(codeOf(nothing), vpException::badValue);
  bench.keepCalling(5);
  const Eigen::Vector3d rest = bench.tip();
  bench.keepCalling(5);
  EXPECT_LT((bench.tip() - rest).norm(), 1 * kMicro);
  EXPECT_EQ(codeOf([&] { bench.robot.setVelocity(vpRobot::REFERENCE_FRAME, vpColVector(4)); }),
            vpException::dimensionError);
  vpColVector turning(6);
  turning[3] = 0.1;
  EXPECT_EQ(codeOf([&] { bench.robot.setVelocity(vpRobot::REFERENCE_FRAME, turning); }), vpException::badValue);
  bench.robot.setMaxTranslationVelocity(kNaN);
  EXPECT_EQ(codeOf([&] { bench.robot.setVelocity(vpRobot::REFERENCE_FRAME, numbers(1e-3, 0, 0)); }),
            vpException::badValue);
  bench.robot.setMaxTranslationVelocity(0.01);
  bench.robot.setRobotState(vpRobot::STATE_POSITION_CONTROL);
  EXPECT_EQ(codeOf([&] { bench.robot.setPosition(vpRobot::JOINT_STATE, numbers(kNaN, 0, 0)); }), vpException::badValue);
}

TEST(RobotMicron, FramesThatMeanNothingAreRefusedWithThoseThatDo)
{
  Bench bench;
  std::string message;
  vpColVector q;
  EXPECT_EQ(codeOf([&] { bench.robot.getPosition(vpRobot::END_EFFECTOR_FRAME, q); }, &message),
            vpRobotException::notImplementedError);
  EXPECT_NE(message.find("REFERENCE_FRAME or JOINT_STATE"), std::string::npos);
  EXPECT_EQ(codeOf([&] { bench.robot.getDisplacement(vpRobot::MIXT_FRAME, q); }),
            vpRobotException::notImplementedError);
  EXPECT_EQ(codeOf([&] { bench.robot.setPosition(vpRobot::JOINT_STATE, numbers(0, 0, 0)); }),
            vpRobotException::wrongStateError);
  EXPECT_EQ(codeOf([&] { bench.robot.setRobotState(vpRobot::STATE_FORCE_TORQUE_CONTROL); }),
            vpRobotException::stateModificationError);
  bench.robot.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
  EXPECT_EQ(codeOf([&] { bench.robot.setVelocity(vpRobot::MIXT_FRAME, numbers(0, 0, 0)); }),
            vpRobotException::notImplementedError);
}

TEST(RobotMicron, APositionOutOfReachIsRefused)
{
  Bench bench;
  bench.robot.setRobotState(vpRobot::STATE_POSITION_CONTROL);
  EXPECT_EQ(codeOf([&] { bench.robot.setPosition(vpRobot::JOINT_STATE, numbers(2e-3, 2e-3, 0)); }),
            vpRobotException::positionOutOfRangeError);
}

TEST(RobotMicron, WithoutAStateItSaysSoAndStartsFromWhereTheTipIs)
{
  Bench bench;
  bench.robot.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
  bench.robot.setVelocity(vpRobot::REFERENCE_FRAME, numbers(2e-3, 0, 0));
  bench.micron.speaks = false;
  bench.micron.step(60);
  vpMatrix jacobian;
  EXPECT_EQ(codeOf([&] { bench.robot.get_fJe(jacobian); }), vpRobotException::communicationError);
  EXPECT_EQ(bench.robot.getReason(), Reason::state_stale);
  bench.micron.step(300);
  bench.micron.speaks = true;
  bench.micron.step(5);
  const Eigen::Vector3d tip = bench.tip();
  bench.keepCalling(10);
  EXPECT_LT((bench.tip() - tip).norm(), 1 * kMicro);
  support::SimulatedMicron other;
  other.speaks = false;
  robot::RobotMicronOptions impatient;
  impatient.wait_ms = 5.0;
  RobotMicron deaf(other.link, other.clock, impatient);
  EXPECT_EQ(codeOf([&] { deaf.init(); }), vpRobotException::communicationError);
}

// Both halves against what the simulated tool really does about a commanded remote centre.
TEST(RobotMicron, ItsJacobianIsTheDerivativeOfTheToolsPose)
{
  Bench bench;
  bench.robot.setPivot(bench.micron.kPort);
  bench.robot.setRobotState(vpRobot::STATE_POSITION_CONTROL);
  // Here the simulated tool, which knows the pivot as a tilt, turns as a rigid one does.
  const Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  const auto poseAt = [&](const Eigen::Vector3d& deflection) {
    bench.robot.setPosition(vpRobot::JOINT_STATE, numbers(deflection));
    bench.keepCalling(15);
    return robot::toEigen(bench.robot.get_fMe());
  };
  poseAt(middle);
  vpMatrix fJe, eJe;
  bench.robot.get_fJe(fJe);
  bench.robot.get_eJe(eJe);
  const Eigen::MatrixXd jacobian = robot::toEigen(fJe);
  EXPECT_GT(jacobian.bottomRows(3).norm(), 30.0);
  const double step = 50 * kMicro;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d way = step * Eigen::Vector3d::Unit(axis);
    const Eigen::Isometry3d behind = poseAt(middle - way), ahead = poseAt(middle + way);
    const Eigen::Vector3d moved = (ahead.translation() - behind.translation()) / (2 * step);
    const Eigen::AngleAxisd turn(ahead.linear() * behind.linear().transpose());
    EXPECT_LT((moved - jacobian.col(axis).head<3>()).norm(), 1e-3);
    // About its own shaft the simulated tool rolls a little; the Jacobian has no spin.
    const Eigen::Vector3d rate = turn.angle() * turn.axis() / (2 * step), shaft = ahead.linear().col(2);
    EXPECT_LT((rate - jacobian.col(axis).tail<3>()).cross(shaft).norm(), 0.1);
  }
  const Eigen::Matrix3d own = poseAt(middle).linear().transpose();
  EXPECT_LT((robot::toEigen(eJe).topRows(3) - own * jacobian.topRows(3)).norm(), 1e-4);
  EXPECT_LT((robot::toEigen(eJe).bottomRows(3) - own * jacobian.bottomRows(3)).norm(), 1e-2);
}

TEST(ToolJacobian, IsTheDerivativeOfAShaftThroughThePivot)
{
  std::mt19937 random(8);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d pivot(10e-3 * any(random), 10e-3 * any(random), 18e-3);
    const Eigen::Vector3d tip(2e-3 * any(random), 2e-3 * any(random), 2e-3 * any(random));
    const robot::ToolJacobian jacobian = robot::toolJacobian(tip, pivot);
    const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d(any(random), any(random), any(random));
    const auto turn = retina::turnBetween(tip - step - pivot, tip + step - pivot);
    EXPECT_LT((2.0 * turn.vec() - jacobian.bottomRows<3>() * 2.0 * step).norm(), 1e-8 * step.norm() / 1e-6);
    EXPECT_EQ(jacobian.topRows<3>() * step, step);
  }
  EXPECT_TRUE(robot::toolJacobian(Eigen::Vector3d::Zero(), std::nullopt).bottomRows<3>().isZero(0.0));
}

// The line from the tip to the pivot that the hand's motion showed, from the true port: what a controller that keeps
// the pivot exactly would do. Its own error is recorded beside.
TEST(RobotMicron, AsksForAShaftThatPassesThePortWithin100MicrometresWithNoise)
{
  support::SimulatedMicron micron({}, 3);
  micron.hand = [](double t) {
    const double tremor = 80 * kMicro * std::sin(2 * M_PI * 9.0 * t);
    return Eigen::Vector3d(200 * kMicro * std::sin(3.0 * t) + tremor, 200 * kMicro * std::cos(4.0 * t) + tremor, 0.0);
  };
  RobotMicron robot(micron.link, micron.clock);
  robot.setRobotState(vpRobot::STATE_STOP);
  for (int i = 0; i < 600; ++i) {
    micron.step(33);
    robot.keepAlive();
  }
  ASSERT_TRUE(robot.getPivot());
  robot.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
  double worst = 0.0, own = 0.0;
  for (int i = 0; i < 300; ++i) {
    const double turn = 0.05 * i;
    robot.setVelocity(vpRobot::REFERENCE_FRAME, numbers(1e-3 * std::cos(turn), 1e-3 * std::sin(turn), 0.0));
    micron.step(33);
    const Eigen::Vector3d from_tip = micron.kPort - micron.controller.tip();
    if (i > 10) own = std::max(own, micron.controller.pivotError());
    if (i > 10)
      worst = std::max(worst, from_tip.cross((*robot.getPivot() - micron.controller.tip()).normalized()).norm());
  }
  RecordProperty("worst_um", std::to_string(worst * 1e6));
  RecordProperty("controller_um", std::to_string(own * 1e6));
  RecordProperty("pivot_um", std::to_string((*robot.getPivot() - micron.kPort).norm() * 1e6));
  EXPECT_LT(worst, 100 * kMicro);
}

TEST(RobotMicron, DisplacementsAreSinceTheLastCall)
{
  Bench bench;
  vpColVector moved;
  bench.robot.getDisplacement(vpRobot::REFERENCE_FRAME, moved);
  EXPECT_EQ(moved.sumSquare(), 0.0);
  bench.robot.setRobotState(vpRobot::STATE_POSITION_CONTROL);
  bench.robot.setPosition(vpRobot::JOINT_STATE, numbers(300 * kMicro, 0, 0));
  bench.keepCalling(15);
  bench.robot.getDisplacement(vpRobot::JOINT_STATE, moved);
  ASSERT_EQ(moved.size(), 3u);
  EXPECT_NEAR(moved[0], 300 * kMicro, 1 * kMicro);
  bench.robot.getDisplacement(vpRobot::END_EFFECTOR_FRAME, moved);
  ASSERT_EQ(moved.size(), 6u);
  EXPECT_LT(moved.sumSquare(), 1e-12);
}

}  // namespace
