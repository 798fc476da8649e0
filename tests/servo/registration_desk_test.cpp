// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/registration_desk.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "support/allocation_counter.h"
#include "support/calibration_scene.h"

using namespace eyeslam;
using namespace eyeslam::servo;
using retina::Reason;
using support::CalibrationScene;

namespace {

constexpr std::int64_t kStart = 1'700'000'000'000'000;
constexpr std::int64_t kFrame_us = 33'333;

/// A desk that hears states at 1 kHz and a frame every 33 ms.
class Desk {
 public:
  explicit Desk(CalibrationScene& scene, const RegistrationDeskOptions& options = {})
      : desk(std::make_unique<RegistrationDesk>(options)), scene_(scene)
  {}

  /// A frame with the tip moving through `tip` during its exposure. @return what the desk said
  Reason frame(const Eigen::Vector3d& tip, const Eigen::Vector2d& shift_px = Eigen::Vector2d::Zero(),
               const Eigen::Vector3d& during_exposure = Eigen::Vector3d::Zero())
  {
    const CalibrationSample sample = scene_.sampleAt(tip);
    utime_ += kFrame_us;
    for (std::int64_t t = -5000; t <= 5000; t += 1000) {
      const Eigen::Vector3d moved = sample.tip.tip + during_exposure * (static_cast<double>(t) / 5000.0);
      desk->observe(utime_ + t, moved, sample.shaft);
    }
    messaging::InstrumentSight sight;
    sight.frame = {utime_, 0, 0.008};
    sight.tip.present = sight.spot.present = true;
    sight.tip.position_px = sample.tip.image_px + shift_px;
    sight.spot.position_px = sample.spot_px + shift_px;
    return desk->see(sight);
  }

  /// The whole calibration as the loop does it.
  void calibrate(int frames = 240)
  {
    CalibrationPattern pattern;
    pattern.start(scene_.shaft());
    desk->beginCalibration();
    for (int i = 0; i < frames; ++i) {
      frame(scene_.nullTip() + pattern.at(pattern.duration_s() * (i + 0.5) / frames, scene_.shaft()));
    }
    desk->endCalibration();
    desk->adopt(evaluate(desk->samples()), utime_);
  }

  /// A tip within the reach.
  Eigen::Vector3d somewhere()
  {
    std::uniform_real_distribution<double> way(-1e-3, 1e-3);
    return scene_.nullTip() + Eigen::Vector3d(way(random_), way(random_), way(random_));
  }

  std::unique_ptr<RegistrationDesk> desk;

 private:
  CalibrationScene& scene_;
  std::mt19937 random_{9};
  std::int64_t utime_ = kStart;
};

}  // namespace

TEST(RegistrationDesk, RefusesToServeBeforeACalibration)
{
  CalibrationScene scene(1);
  Desk world(scene);
  for (int i = 0; i < 100; ++i) world.frame(world.somewhere());
  EXPECT_FALSE(world.desk->good());
  EXPECT_EQ(world.desk->reason(), Reason::not_registered);
  EXPECT_FALSE(world.desk->placement({5.0, {}}));
  EXPECT_FALSE(world.desk->published().valid);
  EXPECT_EQ(world.desk->published().reason, Reason::not_registered);
}

TEST(RegistrationDesk, ServesAfterASweepAndPlacesTheViewOnTheRetina)
{
  CalibrationScene scene(2);
  Desk world(scene);
  world.calibrate();
  ASSERT_TRUE(world.desk->good());
  const double um_per_px = world.desk->umPerPx();
  EXPECT_NEAR(um_per_px / scene.umPerPx(), 1.0, 0.01);
  const auto placed = world.desk->placement({um_per_px, {400.0, 300.0}});
  ASSERT_TRUE(placed);
  // Where the camera sees the spot, there it lies: within the plane's error.
  const Eigen::Vector3d spot = scene.spotOf(scene.nullTip());
  Eigen::Vector3d view = Eigen::Vector3d::Zero();
  view.head<2>() = 1e-6 * um_per_px * scene.imageOf(spot);
  EXPECT_LT((placed->manipulator_T_view * view - spot).norm(), 15e-6);
  const messaging::PublishedRegistration published = world.desk->published();
  EXPECT_TRUE(published.valid);
  EXPECT_TRUE(published.plane.known);
  EXPECT_EQ(published.um_per_px, um_per_px);
  registration_t message{};
  EXPECT_EQ(messaging::write(published, message), Reason::none);
}

TEST(RegistrationDesk, PairsATipWithTheMeanOfItsExposure)
{
  CalibrationScene scene(3);
  Desk world(scene);
  world.desk->beginCalibration();
  // 8 of the 10 ms that the states cover lie within the exposure; a mean over more would be off.
  world.frame(scene.nullTip(), Eigen::Vector2d::Zero(), 500e-6 * Eigen::Vector3d::UnitX());
  ASSERT_EQ(world.desk->samples().size(), 1U);
  EXPECT_LT((world.desk->samples()[0].tip.tip - scene.nullTip()).norm(), 20e-6);  // 4 um an axis
}

TEST(RegistrationDesk, AFrameOutsideTheStatesKeptBringsNothing)
{
  CalibrationScene scene(4);
  Desk world(scene);
  world.frame(scene.nullTip());
  messaging::InstrumentSight sight;
  sight.tip.present = true;
  sight.frame = {kStart + 10 * kFrame_us, 0, 0.008};  // from the future
  EXPECT_EQ(world.desk->see(sight), Reason::tip_late);
  sight.frame.utime = kStart;  // before all states
  EXPECT_EQ(world.desk->see(sight), Reason::tip_late);
  sight.tip.present = false;
  EXPECT_EQ(world.desk->see(sight), Reason::no_tip);
}

TEST(RegistrationDesk, AScaleThatIsNotTheDeclaredOneIsRefused)
{
  CalibrationScene scene(5);
  for (const auto& [share, expected] :
       {std::pair{1.0, Reason::none}, {1.06, Reason::registration_scale}, {0.94, Reason::registration_scale}}) {
    RegistrationDeskOptions options;
    options.declared_um_per_px = share * scene.umPerPx();
    Desk world(scene, options);
    world.calibrate();
    EXPECT_EQ(world.desk->reason(), expected);
    EXPECT_EQ(world.desk->placement({5.0, {}}).has_value(), expected == Reason::none);
  }
}

TEST(RegistrationDesk, ALensThatMovedIsNoticedWithinASecond)
{
  CalibrationScene scene(6);
  Desk world(scene);
  world.calibrate();
  for (int i = 0; i < 60; ++i) world.frame(world.somewhere());
  ASSERT_TRUE(world.desk->good());
  bool noticed = false;
  for (int i = 0; i < 30 && !noticed; ++i) {
    world.frame(world.somewhere(), {25.0, 10.0});
    noticed = world.desk->reason() == Reason::registration_drift;
  }
  EXPECT_TRUE(noticed);
}

// Without the lower bound on the spread of what is remembered, a hand at rest forgets the camera (facts E2).
TEST(RegistrationDesk, AHandAtOnePlaceForgetsNothing)
{
  CalibrationScene scene(7);
  Desk world(scene);
  world.calibrate();
  std::mt19937 random(3);
  std::normal_distribution<double> tremor(0.0, 75e-6);
  for (int i = 0; i < 5000; ++i) {
    world.frame(scene.nullTip() + Eigen::Vector3d(tremor(random), tremor(random), tremor(random)));
  }
  ASSERT_TRUE(world.desk->good());
  EXPECT_NEAR(world.desk->umPerPx() / scene.umPerPx(), 1.0, 0.02);
  EXPECT_LT(scene.registrationErrorUm(world.desk->registration()), 10.0);
}

TEST(RegistrationDesk, ARegistrationSurvivesItsMessage)
{
  CalibrationScene scene(8);
  Desk world(scene);
  world.calibrate();
  const messaging::PublishedRegistration published = world.desk->published();
  const auto other = std::make_unique<RegistrationDesk>();
  other->adopt(resumed(published), planeOf(published), kStart);
  ASSERT_EQ(other->reason(), Reason::none);
  EXPECT_LT((other->registration().image_T_base - world.desk->registration().image_T_base).norm(),
            1e-6 * world.desk->registration().image_T_base.norm());
  const Eigen::Vector3d tip = world.somewhere();
  EXPECT_NEAR(other->registration().sigmaOf(tip) / world.desk->registration().sigmaOf(tip), 1.0, 0.05);
  EXPECT_NEAR(other->umPerPx(), world.desk->umPerPx(), 1e-6);
  EXPECT_LT(scene.registrationErrorUm(other->registration()), 5.0);
}

TEST(RegistrationDesk, AnImpossibleRegistrationDoesNotServe)
{
  messaging::PublishedRegistration nothing;
  EXPECT_FALSE(resumed(nothing).result().good());
  CalibrationScene scene(9);
  Desk world(scene);
  world.calibrate();
  messaging::PublishedRegistration broken = world.desk->published();
  broken.image_T_manipulator(1, 2) = std::nan("");
  EXPECT_FALSE(resumed(broken).result().good());
}

TEST(RegistrationDesk, NeverAllocatesInTheLoop)
{
  CalibrationScene scene(10);
  Desk world(scene);
  world.calibrate();
  const CalibrationResult result = evaluate(world.desk->samples());
  const std::int64_t before = support::allocations();
  world.desk->beginCalibration();
  for (int i = 0; i < 50; ++i) world.frame(world.somewhere());
  world.desk->adopt(result, kStart);
  const auto placed = world.desk->placement({5.0, {400.0, 300.0}});
  const messaging::PublishedRegistration published = world.desk->published();
  EXPECT_EQ(support::allocations(), before);
  EXPECT_TRUE(placed && published.valid);
}
