// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/microscope.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "eyeslam/simulation/eye_motion.h"
#include "eyeslam/simulation/retina_sampler.h"

namespace eyeslam::simulation {
namespace {

const cv::Size kView{200, 152};
constexpr int kMargin = 150;
const cv::Point2d kOrigin(-kMargin, -kMargin);

// A smooth picture whose value is known everywhere: no interpolation is needed to say what a pixel must show.
double pattern(double x, double y)
{
  return 0.5 + 0.12 * std::sin(0.21 * x + 0.4) + 0.1 * std::sin(0.17 * y + 1.1) + 0.08 * std::sin(0.13 * (x + y)) +
         0.07 * std::cos(0.11 * (x - 2 * y));
}

cv::Mat patternCanvas()
{
  cv::Mat canvas(kView.height + 2 * kMargin, kView.width + 2 * kMargin, CV_32FC4);
  for (int y = 0; y < canvas.rows; ++y) {
    for (int x = 0; x < canvas.cols; ++x)
      canvas.at<cv::Vec4f>(y, x) = cv::Vec4f::all(static_cast<float>(pattern(x + kOrigin.x, y + kOrigin.y)));
  }
  return canvas;
}

// Even light, no noise, no blur, no objects.
MicroscopeOptions bareOptions()
{
  MicroscopeOptions options;
  options.optics.exposure_ms = 0.0;
  options.optics.defocus_px = 0.0;
  options.optics.defocus_change_px = 0.0;
  options.illumination.gain = 1.0;
  options.illumination.floor = 1.0;
  options.illumination.rim_radius_px = 0.0;
  options.blooms.count = 0;
  options.instrument.present_fraction = 0.0;
  options.sensor = {0.0, 0.0, 0.0};
  return options;
}

double expected(const retina::Pose2& pose, int column, int row)
{
  // m = c + s R(theta) (p - c) + (x, y): contracts, section 1, written out.
  const double cx = (kView.width - 1) / 2.0;
  const double cy = (kView.height - 1) / 2.0;
  const double dx = pose.scale * (column - cx);
  const double dy = pose.scale * (row - cy);
  return pattern(cx + std::cos(pose.theta) * dx - std::sin(pose.theta) * dy + pose.x,
                 cy + std::sin(pose.theta) * dx + std::cos(pose.theta) * dy + pose.y);
}

// By how much the truth would have to be moved for the picture to fit best: (x, y) in px, theta times half the width.
Eigen::Vector3d misplaced(const cv::Mat_<cv::Vec3b>& image, const retina::Pose2& truth)
{
  constexpr double kStep = 0.01;
  constexpr double kTurn = kStep / 100.0;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.cols; ++column) {
      const double here = expected(truth, column, row);
      const auto slope = [&](double dx, double dy, double dtheta) {
        return (expected({truth.x + dx, truth.y + dy, truth.theta + dtheta, truth.scale}, column, row) - here) / kStep;
      };
      const Eigen::Vector3d jacobian(slope(kStep, 0, 0), slope(0, kStep, 0), slope(0, 0, kTurn));
      normal += jacobian * jacobian.transpose();
      right += jacobian * (image(row, column)[1] / 255.0 - here);
    }
  }
  return normal.ldlt().solve(right);
}

TEST(RetinaSampler, ShowsAKnownPatternAtItsExactPlace)
{
  const cv::Mat canvas = patternCanvas();
  double worst = 0.0;
  for (int i = 0; i < 12; ++i) {
    const retina::Pose2 pose{7.3 * std::sin(i), 11.1 * std::cos(2.0 * i), 0.01 * i, 1.0 + 0.004 * i};
    cv::Mat view(kView, CV_32FC4, cv::Scalar::all(0));
    accumulateView(canvas, {pose, {}, kOrigin}, {}, view);
    for (int y = 0; y < kView.height; ++y) {
      for (int x = 0; x < kView.width; ++x) {
        worst = std::max(worst, std::abs(view.at<cv::Vec4f>(y, x)[1] - expected(pose, x, y)));
      }
    }
  }
  // The pattern's slope is up to 0.06 a px: 1/32 px would show as 0.001 to 0.002.
  EXPECT_LT(worst, 4e-4);
}

TEST(Microscope, TheTruthIsWhereThePixelsSayBelowAHundredthOfAPixel)
{
  for (const char* name : {"jerky", "saccade", "in_situ"}) {
    const EyeMotion motion(eyeMotionOptions(name), kView.width / 800.0, 2.0, 9);
    Microscope microscope(bareOptions(), {kView, kView.width / 800.0, 30.0, 2.0}, patternCanvas(), kOrigin, 1);
    for (int frame = 0; frame < 60; frame += 6) {
      const RenderedFrame result = microscope.expose(frame, motion);
      const Eigen::Vector3d error = misplaced(result.image, result.map_T_frame);
      EXPECT_LT(error.norm(), 0.01) << name << " frame " << frame;
    }
  }
}

TEST(Microscope, TheTruthIsThePoseAtMidExposure)
{
  MicroscopeOptions options = bareOptions();
  options.optics.exposure_ms = 30.0;
  EyeMotionOptions quick = eyeMotionOptions("smooth");
  quick.tremor_px = 0.0;
  quick.drift_px = 120.0;
  const EyeMotion motion(quick, 1.0, 2.0, 4);
  Microscope microscope(options, {kView, 1.0, 30.0, 2.0}, patternCanvas(), kOrigin, 1);
  double moved = 0.0;
  for (int frame = 1; frame < 40; frame += 5) {
    const RenderedFrame result = microscope.expose(frame, motion);
    moved = std::max(
        moved, (motion.at(result.t_s + 0.015).translation() - motion.at(result.t_s - 0.015).translation()).norm());
    EXPECT_LT(misplaced(result.image, result.map_T_frame).norm(), 0.01) << "frame " << frame;
  }
  EXPECT_GT(moved, 1.0);  // the exposure's start or end would be off by half of it
}

TEST(Microscope, MotionDuringTheExposureSmears)
{
  EyeMotionOptions still = eyeMotionOptions("smooth");
  still.drift_px = still.tremor_px = still.rotation_deg = 0.0;
  EyeMotion motion(still, 1.0, 2.0, 4);
  motion.addJump(0.4775, 60.0, 0.0);
  MicroscopeOptions options = bareOptions();
  options.optics.exposure_ms = 20.0;
  Microscope microscope(options, {kView, 1.0, 30.0, 2.0}, patternCanvas(), kOrigin, 1);
  const auto roughness = [&](int frame) {
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(microscope.expose(frame, motion).image, mean, deviation);
    return deviation[1];
  };
  const double sharp = roughness(3);
  EXPECT_LT(roughness(15), 0.95 * sharp);  // the jump is at its fastest at frame 15, 0.5 s
  EXPECT_NEAR(roughness(30), sharp, 0.25 * sharp);
}

TEST(Microscope, TheWarpVanishesAtTheImageCentreWithItsSlope)
{
  const cv::Mat canvas = patternCanvas();
  cv::Mat plain(kView, CV_32FC4, cv::Scalar::all(0));
  cv::Mat warped = plain.clone();
  accumulateView(canvas, {{}, {}, kOrigin}, {}, plain);
  accumulateView(canvas, {{}, {4e-4, 2e-4, -3e-4, 1e-4, -2e-4, 4e-4}, kOrigin}, {}, warped);
  const auto differenceAt = [&](int x, int y) {
    return std::abs(plain.at<cv::Vec4f>(y, x)[0] - warped.at<cv::Vec4f>(y, x)[0]);
  };
  EXPECT_LT(differenceAt(99, 75), 1e-4);
  EXPECT_LT(differenceAt(104, 78), 2e-3);
  EXPECT_GT(differenceAt(5, 5) + differenceAt(190, 10) + differenceAt(20, 140), 0.02);
}

}  // namespace
}  // namespace eyeslam::simulation
