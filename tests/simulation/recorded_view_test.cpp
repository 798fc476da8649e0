// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/recorded_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "eyeslam/simulation/microscope.h"
#include "eyeslam/simulation/retina_motion.h"

namespace eyeslam::simulation {
namespace {

constexpr double kUm_per_px = 5.0;
const Eigen::Vector2d kImageCentre(159.5, 119.5);

Eigen::Vector3d onRetina(const Eigen::Vector2d& map_px)
{
  return {map_px.x() * kUm_per_px * 1e-6, map_px.y() * kUm_per_px * 1e-6, 0.0};
}

TEST(ViewPose, AgreesWithTheThreeDimensionalPoseForEveryPixel)
{
  const RetinaPose pose{{0.3e-3, 0.7e-3, 0.0}, {120e-6, -45e-6, 30e-6}, 0.05};  // turns about another place
  const retina::Pose2 map_T_frame = viewPose(pose, kImageCentre, kUm_per_px);
  for (const Eigen::Vector2d& frame_px : {Eigen::Vector2d(0, 0), Eigen::Vector2d(300, 20), Eigen::Vector2d(17, 200)}) {
    // The camera stands still: its pixel is always the same place of the world, whatever tissue is there.
    const Eigen::Vector3d tissue = pose.toRetina(onRetina(frame_px) + Eigen::Vector3d(0, 0, pose.shift.z()));
    const Eigen::Vector2d map_px = kImageCentre + map_T_frame * (frame_px - kImageCentre);
    EXPECT_LT((onRetina(map_px) - tissue).norm(), 1e-12);
  }
}

TEST(RecordedView, GivesEachPoseAtItsInstantAndTheMiddleBetweenTwo)
{
  RecordedView view(kImageCentre, kUm_per_px, 0.05);
  EXPECT_EQ(view.at(0.0).x, 0.0);
  RetinaMotion retina(retinaMotionOptions("saccade"), 4, onRetina(kImageCentre));
  std::vector<retina::Pose2> poses;
  for (int i = 0; i < 400; ++i) {
    const RetinaPose& pose = retina.step({}).world_T_retina;
    view.add(pose);
    poses.push_back(viewPose(pose, kImageCentre, kUm_per_px));
  }
  for (const std::size_t i : {355U, 380U, 399U}) {
    EXPECT_NEAR(view.at(1e-3 * static_cast<double>(i)).x, poses[i].x, 1e-9);
    EXPECT_NEAR(view.at(1e-3 * (static_cast<double>(i) - 0.5)).y, (poses[i].y + poses[i - 1].y) / 2.0, 1e-9);
  }
  EXPECT_NEAR(view.at(1.0).theta, poses.back().theta, 1e-12);  // not yet: the newest
  EXPECT_NEAR(view.at(0.0).x, poses[400 - 52].x, 1e-9);        // forgotten: the oldest of 50 ms and two ends
}

TEST(RecordedView, DrivesTheRenderer)
{
  // Two squares on a dark canvas; the eye has moved by 20 px and turned: the frame shows them where the pose says.
  const cv::Size size(320, 240);
  MicroscopeOptions options;
  options.optics.defocus_px = options.optics.defocus_change_px = 0.0;
  options.blooms.count = 0;
  options.instrument.present_fraction = 0.0;
  options.illumination.floor = 1.0;
  options.sensor = SensorOptions{};
  cv::Mat canvas(size.height + 200, size.width + 200, CV_32FC4, cv::Scalar::all(0.05));
  const cv::Point spot(150, 130);  // canvas px
  canvas(cv::Rect(spot.x - 4, spot.y - 4, 9, 9)).setTo(cv::Scalar::all(0.9));
  const cv::Point2d origin(-100.0, -100.0);
  Microscope microscope(options, {size, 0.4, 30.0, 1.0}, canvas, origin, 1);

  RecordedView view(kImageCentre, kUm_per_px, 1.0);
  const RetinaPose moved{onRetina(kImageCentre), {100e-6, 60e-6, 0.0}, 0.1};
  for (int i = 0; i < 100; ++i) view.add(moved);
  const RenderedFrame frame = microscope.expose(1, view);

  cv::Mat bright;
  cv::extractChannel(frame.image, bright, 2);
  double sum = 0.0;
  cv::Point2d centre;
  for (int y = 0; y < bright.rows; ++y) {
    for (int x = 0; x < bright.cols; ++x) {
      const double weight = std::max(0, bright.at<std::uint8_t>(y, x) - 100);
      centre += weight * cv::Point2d(x, y);
      sum += weight;
    }
  }
  ASSERT_GT(sum, 0.0);
  const Eigen::Vector3d tissue = onRetina({spot.x + origin.x, spot.y + origin.y});
  const Eigen::Vector3d seen = moved.toWorld(tissue) / (kUm_per_px * 1e-6);
  EXPECT_NEAR(centre.x / sum, seen.x(), 0.3);  // the light falls off across the square
  EXPECT_NEAR(centre.y / sum, seen.y(), 0.3);
}

}  // namespace
}  // namespace eyeslam::simulation
