// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/vision/vision_publisher.h"

#include <gtest/gtest.h>

#include "eyeslam/messaging/map_assembler.h"

namespace eyeslam::vision {
namespace {

constexpr std::int64_t kStart = 1'700'000'000'000'000;  // us since 1970
constexpr std::int64_t kSession = 7;

tracking::TrackResult someResult()
{
  tracking::TrackResult result;
  result.tracked = true;
  result.map_T_frame.x = 12.5;
  result.map_T_frame.y = -3.0;
  result.map_T_frame.theta = 0.02;
  result.velocity = {0.5, -0.25, 0.001};
  result.covariance.diagonal() << 0.04, 0.09, 1e-6;
  return result;
}

/// Vision and its listener on one link, as in lock step.
struct LockStep {
  messaging::Link link{"memq://", kSession, {}};
  VisionPublisher publisher{link, 5.0, 30.0};
  messaging::Publisher<registration_t> registrations{link};
  messaging::Subscription<retina_pose_t> poses{link};
  messaging::Subscription<tool_tip_t> tips{link};

  void drain(std::int64_t utime) { link.drain({utime, utime}); }

  void tellRegistration(bool valid, double um_per_px, std::int64_t utime)
  {
    messaging::PublishedRegistration registration;
    registration.valid = valid;
    registration.um_per_px = um_per_px;
    registrations.publish(registration, utime, utime);
    drain(utime);
  }

  double toldUmPerPx(std::int64_t utime)
  {
    publisher.publishPose({utime, 0, 0.0}, someResult(), 1, utime);
    drain(utime);
    return poses.latest()->map.um_per_px;
  }
};

TEST(VisionPublisher, TellsThePoseThatWasTrackedWithItsVelocityPerSecond)
{
  LockStep steps;
  const tracking::TrackResult result = someResult();
  steps.publisher.publishPose({kStart, 41, 0.005}, result, 17, kStart + 8000);
  steps.drain(kStart + 8000);
  ASSERT_NE(steps.poses.latest(), nullptr);
  const messaging::RetinaPose& pose = *steps.poses.latest();
  EXPECT_EQ(pose.frame.utime, kStart);
  EXPECT_EQ(steps.poses.header().utime_sent, kStart + 8000);
  EXPECT_EQ(pose.frame.frame, 41);
  EXPECT_DOUBLE_EQ(pose.frame.exposure, 0.005);
  EXPECT_EQ(pose.map.id, kSession);
  EXPECT_EQ(pose.map.version, 17);
  EXPECT_TRUE(pose.motion.tracked);
  EXPECT_DOUBLE_EQ(pose.motion.map_T_frame.x, 12.5);
  EXPECT_EQ(pose.motion.velocity, (Eigen::Vector3d(15.0, -7.5, 0.03)));
  EXPECT_EQ(pose.motion.covariance, result.covariance);
}

TEST(VisionPublisher, TellsWhyAFrameWasNotTracked)
{
  LockStep steps;
  tracking::TrackResult result = someResult();
  result.tracked = false;
  result.reason = retina::Reason::blackout;
  result.velocity.setZero();
  steps.publisher.publishPose({kStart, 0, 0.0}, result, 0, kStart);
  steps.drain(kStart);
  ASSERT_NE(steps.poses.latest(), nullptr);
  EXPECT_FALSE(steps.poses.latest()->motion.tracked);
  EXPECT_EQ(steps.poses.latest()->motion.reason, retina::Reason::blackout);
}

TEST(VisionPublisher, TellsTipAndSpotApart)
{
  LockStep steps;
  tracking::ToolTip tip{true, 300.0, 200.0, 0.7, 21.0, Eigen::Matrix2d::Identity()};
  tracking::AimingSpot spot{true, 340.0, 235.0, 0.25 * Eigen::Matrix2d::Identity()};
  steps.publisher.publishInstrument({kStart, 0, 0.0}, tip, {}, kStart);
  steps.drain(kStart);
  ASSERT_NE(steps.tips.latest(), nullptr);
  EXPECT_TRUE(steps.tips.latest()->tip.present);
  EXPECT_FALSE(steps.tips.latest()->spot.present);

  tip.present = false;
  steps.publisher.publishInstrument({kStart + 1, 1, 0.0}, tip, spot, kStart + 1);
  steps.drain(kStart + 1);
  EXPECT_FALSE(steps.tips.latest()->tip.present);
  EXPECT_EQ(steps.tips.latest()->spot.position_px, (Eigen::Vector2d(340.0, 235.0)));
  EXPECT_EQ(steps.tips.latest()->spot.covariance, spot.covariance);
}

TEST(VisionPublisher, TakesUmPerPxFromAValidRegistrationOnly)
{
  LockStep steps;
  EXPECT_DOUBLE_EQ(steps.toldUmPerPx(kStart), 5.0) << "given";
  steps.tellRegistration(false, 6.0, kStart + 1);
  EXPECT_DOUBLE_EQ(steps.toldUmPerPx(kStart + 2), 5.0) << "an invalid one was heard";
  steps.tellRegistration(true, 0.0, kStart + 3);
  EXPECT_DOUBLE_EQ(steps.toldUmPerPx(kStart + 4), 5.0) << "a valid one that does not know";
  steps.tellRegistration(true, 5.2, kStart + 5);
  EXPECT_DOUBLE_EQ(steps.toldUmPerPx(kStart + 6), 5.2);
  steps.tellRegistration(false, 7.0, kStart + 7);
  EXPECT_DOUBLE_EQ(steps.toldUmPerPx(kStart + 8), 5.2) << "the last valid one stays";
}

TEST(VisionPublisher, PassesTheWholeMap)
{
  LockStep steps;
  retina::VesselMap map;
  map.width = 90;
  map.height = 50;
  map.version = 3;
  for (std::size_t i = 0; i < 90 * 50; ++i) map.probability.push_back(static_cast<std::uint8_t>(i % 251));
  map.calibre_px = map.seen = map.probability;
  messaging::MapAssembler assembler;
  messaging::Subscription<vessel_map_t> tiles(
      steps.link, [&](const vessel_map_t& tile, const messaging::MessageHeader&) { assembler.add(tile); });
  for (int frame = 0; frame < 2; ++frame) {  // 15 tiles, 8 a frame
    steps.publisher.publishTiles({kStart + frame, frame, 0.0}, map, kStart + frame);
    steps.drain(kStart + frame);
  }
  EXPECT_EQ(assembler.map().probability, map.probability);
  EXPECT_DOUBLE_EQ(assembler.map().um_per_px, 5.0);
}

TEST(VisionPublisher, TellsNothingOfAnEmptyMap)
{
  LockStep steps;
  messaging::Subscription<vessel_map_t> tiles(steps.link);
  steps.publisher.publishTiles({kStart, 0, 0.0}, retina::VesselMap{}, kStart);
  steps.drain(kStart);
  EXPECT_EQ(tiles.received(), 0);
}

}  // namespace
}  // namespace eyeslam::vision
