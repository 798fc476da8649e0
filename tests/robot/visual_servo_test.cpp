// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/robot/visual_servo.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "eyeslam/retina/turn_between.h"
#include "eyeslam/robot/robot_micron.h"
#include "eyeslam/robot/tool_jacobian.h"
#include "eyeslam/robot/visp_conversion.h"
#include "support/simulated_micron.h"

using namespace eyeslam;
using eyeslam::retina::Reason;
using eyeslam::robot::VisualServo;
using eyeslam::robot::VisualServoOptions;

namespace {

constexpr double kMicro = 1e-6;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kPeriod_s = 1.0 / 30.0;

vpImagePoint imagePoint(const Eigen::Vector2d& px) { return vpImagePoint(px.y(), px.x()); }  // row first

/// A retina, a camera over it and a tool through a port, each lying anyhow; the tool goes where it is told.
class Scene {
 public:
  explicit Scene(unsigned seed) : random_(seed)
  {
    plane.normal = (Eigen::Vector3d::UnitZ() + 0.2 * direction()).normalized();
    plane.distance = 1e-3 * any();
    // Looks down, turned anyhow about its line of sight, mirrored as images are, and at an angle.
    const Eigen::Matrix3d look =
        (Eigen::AngleAxisd(0.2 * any(), direction()) * Eigen::AngleAxisd(M_PI * any(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    registration.image_T_base << look.topRows<2>() * 1e6 / 5.0, Eigen::Vector2d(400.0, 304.0);
    registration.reason = Reason::none;
    port = plane.normal * 18e-3 + Eigen::Vector3d(8e-3, -3e-3, 0.0);
    tip = onPlane(1.5e-3) + plane.normal * 1e-3 * (1.0 + 0.5 * any());
    target = onPlane(1.5e-3);
  }

  Eigen::Vector3d onPlane(double reach)
  {
    const Eigen::Vector3d place = reach * Eigen::Vector3d(any(), any(), 0.0);
    return place - plane.normal * plane.height(place);
  }
  Eigen::Isometry3d tool() const
  {
    Eigen::Isometry3d fMe(retina::turnBetween(Eigen::Vector3d::UnitZ(), tip - port));
    fMe.translation() = tip;
    return fMe;
  }
  vpHomogeneousMatrix fMe() const { return robot::toVisp(tip, Eigen::Quaterniond(tool().linear())); }
  vpMatrix fJe() const { return robot::toVisp(Eigen::MatrixXd(robot::toolJacobian(tip, port))); }
  Eigen::Vector3d servoed(const VisualServoOptions& options) const
  {
    return options.servoed == "tip" ? tip : *VisualServo::spotOf(tool(), plane);
  }
  Eigen::Vector3d look(VisualServo& servo, const VisualServoOptions& options) const
  {
    servo.setTarget(imagePoint(registration.toImage(target)));
    servo.setSeen(imagePoint(registration.toImage(servoed(options))));
    return robot::toEigen(servo.computeVelocity(fMe(), fJe()));
  }
  // In the image, and of the height: what is asked for, as a distance.
  double error(const VisualServoOptions& options) const
  {
    const double lateral =
        (registration.toImage(servoed(options)) - registration.toImage(target)).norm() * 5.0 * kMicro;
    return std::hypot(lateral, plane.height(tip) - options.standoff_um * kMicro);
  }
  double any() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  Eigen::Vector3d direction() { return Eigen::Vector3d(any(), any(), any()).normalized(); }

  servo::RetinaPlane plane;
  servo::Registration registration;
  Eigen::Vector3d port, tip, target;

 private:
  std::mt19937 random_;
};

std::vector<VisualServoOptions> kinds()
{
  std::vector<VisualServoOptions> all;
  for (const char* features : {"image", "position"}) {
    for (const char* servoed : {"tip", "spot"}) {
      all.emplace_back();
      all.back().features = features;
      all.back().servoed = servoed;
    }
  }
  return all;
}

TEST(VisualServo, ConvergesFromAnywhereInTheWorkspaceWithEitherKindOfFeatures)
{
  for (const VisualServoOptions& options : kinds()) {
    for (unsigned seed = 0; seed < 50; ++seed) {
      Scene scene(seed);
      VisualServo servo(options);
      servo.setRegistration(scene.registration, scene.plane);
      double last = scene.error(options);
      for (int i = 0; i < 150; ++i) {
        scene.tip += kPeriod_s * scene.look(servo, options);
        ASSERT_EQ(servo.getReason(), Reason::none);
      }
      ASSERT_LT(scene.error(options), 1.0 * kMicro) << options.features << ' ' << options.servoed << " seed " << seed;
      ASSERT_GT(last, scene.error(options));
    }
  }
}

TEST(VisualServo, TheErrorFallsExponentiallyByItsGain)
{
  for (VisualServoOptions options : kinds()) {
    options.gain_at_zero_hz = options.gain_at_infinity_hz = 3.0;
    options.speed_mm_s = 100.0;
    for (unsigned seed = 0; seed < 10; ++seed) {
      Scene scene(seed);
      VisualServo servo(options);
      servo.setRegistration(scene.registration, scene.plane);
      scene.look(servo, options);
      const vpColVector first = servo.getError();
      for (int i = 0; i < 500; ++i) scene.tip += 1e-3 * scene.look(servo, options);
      scene.look(servo, options);
      // Each feature by itself; 1 % for steps of a millisecond and what a spot does besides.
      for (unsigned k = 0; k < 3; ++k)
        ASSERT_NEAR(servo.getError()[k], std::exp(-1.5) * first[k], 0.01 * std::sqrt(first.sumSquare()))
            << options.features << ' ' << options.servoed << " seed " << seed;
    }
  }
}

TEST(VisualServo, AShortenedVelocityNeverExceedsItsLimitAndNothingOvershootsAfterwards)
{
  for (VisualServoOptions options : kinds()) {
    options.speed_mm_s = 0.5;
    for (unsigned seed = 0; seed < 10; ++seed) {
      Scene scene(seed);
      VisualServo servo(options);
      servo.setRegistration(scene.registration, scene.plane);
      double last = std::numeric_limits<double>::infinity();
      int shortened = 0;
      for (int i = 0; i < 400; ++i) {
        const Eigen::Vector3d velocity = scene.look(servo, options);
        ASSERT_LE(velocity.norm(), 0.5e-3 * (1.0 + 1e-9));
        const double error = std::sqrt(servo.getError().sumSquare());
        ASSERT_LE(error, last + 1e-9) << i;
        last = error;
        shortened += servo.isSaturated();
        scene.tip += kPeriod_s * velocity;
      }
      EXPECT_GT(shortened, 0);
      EXPECT_LT(scene.error(options), 1.0 * kMicro);
    }
  }
}

TEST(VisualServo, NumbersThatAreNoneMoveNothingAndLeaveNoTrace)
{
  for (const VisualServoOptions& options : kinds()) {
    Scene scene(3);
    VisualServo servo(options);
    servo.setRegistration(scene.registration, scene.plane);
    const Eigen::Vector3d good = scene.look(servo, options);
    ASSERT_GT(good.norm(), 0.0);
    const auto refuses = [&](const vpImagePoint& target, const vpImagePoint& seen, const vpHomogeneousMatrix& fMe,
                             const vpMatrix& fJe) {
      servo.setTarget(target);
      servo.setSeen(seen);
      return servo.computeVelocity(fMe, fJe).sumSquare() == 0.0 && servo.getReason() != Reason::none;
    };
    const vpImagePoint middle(300.0, 400.0), nowhere(kNaN, 400.0);
    vpHomogeneousMatrix broken = scene.fMe();
    broken[1][3] = kNaN;
    vpMatrix unknown = scene.fJe();
    unknown[4][1] = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(refuses(nowhere, middle, scene.fMe(), scene.fJe()));
    EXPECT_TRUE(options.features == "position" || refuses(middle, nowhere, scene.fMe(), scene.fJe()));
    EXPECT_TRUE(refuses(middle, middle, broken, scene.fJe()));
    EXPECT_TRUE(refuses(middle, middle, scene.fMe(), unknown));
    EXPECT_TRUE(refuses(middle, middle, scene.fMe(), vpMatrix(6, 3)));
    EXPECT_TRUE(refuses(middle, middle, scene.fMe(), vpMatrix(6, 6)));
    EXPECT_LT((scene.look(servo, options) - good).norm(), 1e-12);
  }
}

TEST(VisualServo, ABadRegistrationIsRefusedWithItsReason)
{
  Scene scene(4);
  VisualServo servo;
  scene.look(servo, {});
  EXPECT_EQ(servo.getReason(), Reason::not_registered);
  scene.registration.reason = Reason::registration_drift;
  servo.setRegistration(scene.registration, scene.plane);
  EXPECT_EQ(scene.look(servo, {}).norm(), 0.0);
  EXPECT_EQ(servo.getReason(), Reason::registration_drift);
  scene.registration.reason = Reason::none;
  servo.setRegistration(scene.registration, {Eigen::Vector3d::Constant(kNaN), 0.0, 0.0});
  EXPECT_EQ(scene.look(servo, {}).norm(), 0.0);
  EXPECT_EQ(servo.getReason(), Reason::surface_unknown);
}

TEST(VisualServo, ACameraThatLooksAlongTheRetinaIsRefused)
{
  Scene scene(5);
  // Both rows see the height, and one direction along the plane.
  const Eigen::Vector3d along = scene.plane.normal.unitOrthogonal();
  scene.registration.image_T_base.row(0).head<3>() = 2e5 * along.transpose();
  scene.registration.image_T_base.row(1).head<3>() =
      2e5 * (scene.plane.normal + 1e-3 * scene.plane.normal.cross(along)).transpose();
  VisualServo servo;
  servo.setRegistration(scene.registration, scene.plane);
  EXPECT_EQ(scene.look(servo, {}).norm(), 0.0);
  EXPECT_EQ(servo.getReason(), Reason::servo_singular);
}

TEST(VisualServo, WhatWasSeenOnceIsNotUsedTwice)
{
  Scene scene(6);
  VisualServo servo;
  servo.setRegistration(scene.registration, scene.plane);
  EXPECT_GT(scene.look(servo, {}).norm(), 0.0);
  EXPECT_EQ(servo.computeVelocity(scene.fMe(), scene.fJe()).sumSquare(), 0.0);
  EXPECT_EQ(servo.getReason(), Reason::no_tip);
}

/// The simulated manipulator, seen by a camera at 30 Hz, through RobotMicron.
class ClosedLoop {
 public:
  explicit ClosedLoop(const VisualServoOptions& options) : options_(options), servo(options)
  {
    registration.image_T_base << 2e5, 0.0, 1e4, 400.0, 0.0, -2e5, 2e4, 304.0;
    registration.reason = Reason::none;
    plane.normal = Eigen::Vector3d::UnitZ();
    servo.setRegistration(registration, plane);
    micron.step(3);
    robot.setPivot(micron.kPort);
    robot.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
  }
  void frame(const Eigen::Vector3d& target)
  {
    const Eigen::Vector3d tip = micron.controller.tip();
    Eigen::Isometry3d tool = Eigen::Isometry3d::Identity();
    tool.linear().col(2) = -micron.controller.shaft();
    tool.translation() = tip;
    servo.setTarget(imagePoint(registration.toImage(target)));
    servo.setSeen(
        imagePoint(registration.toImage(options_.servoed == "tip" ? tip : *VisualServo::spotOf(tool, plane))));
    vpMatrix fJe;
    robot.get_fJe(fJe);
    robot.setVelocity(vpRobot::REFERENCE_FRAME, servo.computeVelocity(robot.get_fMe(), fJe));
    micron.step(33);
    error_px =
        (registration.toImage(options_.servoed == "tip" ? micron.controller.tip() : *VisualServo::spotOf(tool, plane)) -
         registration.toImage(target))
            .norm();
  }

  VisualServoOptions options_;
  servo::Registration registration;
  servo::RetinaPlane plane;
  support::SimulatedMicron micron;
  robot::RobotMicron robot{micron.link, micron.clock};
  VisualServo servo;
  double error_px = 0.0;
};

TEST(VisualServo, BringsTheSimulatedMicronOntoItsTarget)
{
  for (const VisualServoOptions& options : kinds()) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> across(-1e-3, 1e-3);
    for (int run = 0; run < 4; ++run) {
      ClosedLoop loop(options);
      // About where tip or beam are at the start.
      const Eigen::Vector3d away =
          options.servoed == "tip" ? Eigen::Vector3d::Zero() : Eigen::Vector3d(-0.28e-3, -0.09e-3, 0.0);
      const Eigen::Vector3d target = away + Eigen::Vector3d(across(random), across(random), 0.0);
      for (int i = 0; i < 150; ++i) loop.frame(target);
      EXPECT_LT(loop.error_px * 5.0, 1.0) << options.features << ' ' << options.servoed;
      EXPECT_LT(std::abs(loop.micron.controller.tip().z() - 0.5e-3), 1.0 * kMicro);
    }
  }
}

TEST(VisualServo, ATargetOutOfReachIsLeftAtOnceWhenItMovesBack)
{
  ClosedLoop loop({});
  for (int i = 0; i < 90; ++i) {
    loop.frame({4e-3, 0.0, 0.0});
    const Eigen::Vector3d way = loop.micron.controller.tip() - loop.micron.held.null;
    ASSERT_LT(way.cross(loop.micron.held.shaft).norm(), 2.01e-3);
    ASSERT_LT(std::abs(way.dot(loop.micron.held.shaft)), 2.01e-3);
  }
  EXPECT_TRUE(loop.robot.isSaturated());
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 120; ++i) {
    loop.frame({1e-3, 0.0, 0.0});
    // The velocity of a frame acts in the next one.
    if (i > 1) {
      ASSERT_LT(loop.error_px, last + 0.05) << i;
    }
    last = loop.error_px;
  }
  EXPECT_LT(loop.error_px * 5.0, 1.0);
}

}  // namespace
