// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/frame_truths.h"

#include <gtest/gtest.h>

#include <cmath>

namespace eyeslam::trials {
namespace {

using Eigen::Vector2d;

constexpr std::int64_t kUtime = 1'700'000'000'000'000;
constexpr double kPx = 4e-6;  // m
const Vector2d kCentre(400.0, 300.0);

/// A simulation and a tracker that say what they are told to.
class SeenPlaces : public ::testing::Test {
 protected:
  void expose(std::int64_t frame, const retina::Pose2& pose)
  {
    truth_t truth{};
    truth.um_per_px = 4.0;
    truth.frame = frame;
    truth.frame_utime = kUtime;
    truth.frame_x_px = pose.x;
    truth.frame_y_px = pose.y;
    truth.frame_theta = pose.theta;
    truths.publish(truth, kUtime);
    link.drain({kUtime, kUtime});
  }
  void track(std::int64_t frame, const retina::Pose2& pose, bool tracked = true, std::int64_t map = 8)
  {
    messaging::RetinaPose said;
    said.frame.frame = frame;
    said.map.id = map;
    said.motion.tracked = tracked;
    said.motion.map_T_frame = pose;
    poses.publish(said, kUtime, kUtime);
    link.drain({kUtime, kUtime});
  }
  void expectSeenAt(const Vector2d& place, const Vector2d& map_px)
  {
    const auto seen = places.seenAt(place);
    ASSERT_TRUE(seen);
    EXPECT_LT((*seen - map_px).norm(), 1e-6) << seen->transpose();
  }

  messaging::Link link{"memq://", 3, std::nullopt};
  FrameTruths places{kCentre, link};
  messaging::Publisher<truth_t> truths{link};
  messaging::Publisher<retina_pose_t> poses{link};
};

TEST_F(SeenPlaces, AreWhereTheyAreWhenTrackerAndTruthAgree)
{
  EXPECT_FALSE(places.seenAt({0.0, 0.0}));
  expose(0, {});
  EXPECT_FALSE(places.seenAt({0.0, 0.0})) << "the tracker has seen nothing yet";
  track(0, {});
  expectSeenAt(kPx * Vector2d(500.0, 250.0), {500.0, 250.0});
  EXPECT_EQ(places.mapId(), 8);
}

// In that frame the place is 10 px to the right of the centre; the tracker thinks that the frame is 3 px off, and
// turned.
TEST_F(SeenPlaces, GoThroughTheFrameByItsTrueAndItsTrackedPose)
{
  expose(4, {20.0, -30.0, 0.0, 1.0});
  track(4, {23.0, -30.0, M_PI / 2, 1.0});
  expectSeenAt(kPx * (kCentre + Vector2d(30.0, -30.0)), kCentre + Vector2d(23.0, -20.0));
}

TEST_F(SeenPlaces, AreOfTheFrameThatThePoseNamesNotOfTheNewest)
{
  for (int frame = 0; frame < 5; ++frame) expose(frame, {10.0 * frame, 0.0, 0.0, 1.0});
  track(2, {20.0, 0.0, 0.0, 1.0});
  expectSeenAt(kPx * kCentre, kCentre);
  track(3, {31.0, 0.0, 0.0, 1.0});
  expectSeenAt(kPx * kCentre, kCentre + Vector2d(1.0, 0.0));
}

TEST_F(SeenPlaces, StayWhereTheyWereInFramesThatAreNotTracked)
{
  expose(0, {});
  track(0, {1.0, 0.0, 0.0, 1.0});
  expose(1, {50.0, 0.0, 0.0, 1.0});
  track(1, {}, false, 9);
  expectSeenAt(kPx * kCentre, kCentre + Vector2d(1.0, 0.0));
  EXPECT_EQ(places.mapId(), 9);
}

}  // namespace
}  // namespace eyeslam::trials
