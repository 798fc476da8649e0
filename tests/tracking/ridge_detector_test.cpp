// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/ridge_detector.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/drawn_retina.h"

namespace eyeslam::tracking {
namespace {

using support::arc;
using support::Centreline;
using support::DrawnRetina;
using support::PreparedFrame;

constexpr int kWidth = 200, kHeight = 160;  // frame px
const Eigen::Vector2d kMiddle(100.3, 79.6);

VesselPoints detected(RidgeDetector& detector, const cv::Mat& photo)
{
  const PreparedFrame view(photo);
  VesselPoints points;
  detector.detect(view.frame, view.mask, points);
  return points;
}

VesselPoints detected(const cv::Mat& photo)
{
  RidgeDetector detector;
  return detected(detector, photo);
}

// Nothing but grain, of so many grey levels.
cv::Mat grain(double noise, unsigned seed) { return DrawnRetina(kWidth, kHeight).photograph(noise, seed); }

TEST(RidgeDetector, PutsItsPointsOnTheCentrelineOfAVessel)
{
  for (const double width_px : {2.0, 4.0, 6.0, 8.0}) {
    for (int step = 0; step < 12; ++step) {
      const double angle = M_PI * step / 12.0 + 0.02;
      const Centreline line = arc(kMiddle, angle, 0.0, 100.0);
      DrawnRetina retina(kWidth, kHeight);
      retina.vessel(line, width_px, 0.3);
      int along = 0;
      for (const VesselPoint& point : detected(retina.photograph(0.0, 1))) {
        const Eigen::Vector2d from_middle = Eigen::Vector2d(point.x, point.y) - kMiddle;
        if (from_middle.norm() > 42.0) continue;  // a blunt end is not a line
        const double across = from_middle.y() * std::cos(angle) - from_middle.x() * std::sin(angle);
        ASSERT_LT(std::abs(across), 0.7) << "width " << width_px << " angle " << angle;
        ++along;
      }
      // One point for every pixel of the halved picture, at least two in three of them.
      EXPECT_GT(along, 84 / 2 * 2 / 3 * std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle))))
          << "width " << width_px << " angle " << angle;
    }
  }
}

TEST(RidgeDetector, NeverTakesTheWayAlongAVesselForTheWayAcross)
{
  for (const double angle : {0.0, M_PI / 4, M_PI / 2, 3 * M_PI / 4}) {
    DrawnRetina retina(kWidth, kHeight);
    retina.vessel(arc(kMiddle, angle, 0.0, 100.0), 4.0, 0.3);
    for (const VesselPoint& point : detected(retina.photograph(0.0, 1))) {
      if ((Eigen::Vector2d(point.x, point.y) - kMiddle).norm() > 42.0) continue;
      // Three of the four directions leave the vessel; they differ from the right one by 45 deg at most.
      EXPECT_LT(std::abs(std::remainder(static_cast<double>(point.direction) - angle, M_PI)), M_PI / 4 + 1e-3) << angle;
    }
  }
}

TEST(RidgeDetector, FindsNothingOnAFlatField) { EXPECT_TRUE(detected(grain(0.0, 1)).empty()); }

TEST(RidgeDetector, FindsNothingUnderTheInstrument)
{
  DrawnRetina retina(kWidth, kHeight);
  retina.vessel(arc(kMiddle, 0.0, 0.0, 180.0), 4.0, 0.3);
  retina.shaft({110.0, 60.0}, M_PI / 3, 8.0);
  retina.bloom({60.0, 80.0}, 4.0);
  const PreparedFrame view(retina.photograph(1.0, 1));
  RidgeDetector detector;
  VesselPoints points;
  detector.detect(view.frame, view.mask, points);
  EXPECT_GT(points.size(), 20u);
  for (const VesselPoint& point : points)
    EXPECT_TRUE(view.mask.isVisible(static_cast<int>(std::lround(point.x)), static_cast<int>(std::lround(point.y))))
        << point.x << " " << point.y;
}

TEST(RidgeDetector, KeepsTheStrongest)
{
  RidgeDetectorOptions options;
  options.most_points = 5000;
  RidgeDetector all(options);
  const cv::Mat photo = grain(20.0, 2);
  VesselPoints every = detected(all, photo);
  options.most_points = 100;
  RidgeDetector few(options);
  const VesselPoints kept = detected(few, photo);
  ASSERT_GT(every.size(), 200u);
  ASSERT_EQ(kept.size(), 100u);
  std::sort(every.begin(), every.end(),
            [](const VesselPoint& a, const VesselPoint& b) { return a.strength > b.strength; });
  for (const VesselPoint& point : kept) EXPECT_GE(point.strength, every[99].strength);
}

TEST(RidgeDetector, FollowsTheStrengthOfThePicture)
{
  // Strong texture raises the threshold, so that a faint vessel is under it at first, but not for long: it falls by a
  // quarter each frame.
  RidgeDetectorOptions options;
  options.most_points = 50;
  RidgeDetector detector(options);
  for (unsigned seed = 1; seed <= 3; ++seed) EXPECT_EQ(detected(detector, grain(40.0, seed)).size(), 50u);
  DrawnRetina faint(kWidth, kHeight);
  faint.vessel(arc(kMiddle, 0.3, 0.0, 100.0), 4.0, 0.08);
  const cv::Mat photo = faint.photograph(0.0, 1);
  EXPECT_TRUE(detected(detector, photo).empty());
  int frames = 0;
  while (detected(detector, photo).size() < 30u && frames < 20) ++frames;
  EXPECT_LT(frames, 8);
}

TEST(RidgeDetector, NeverReportsLessThanTheLeastContrast)
{
  RidgeDetectorOptions options;
  options.least_contrast = 0.1;
  RidgeDetector detector(options);
  for (int frame = 0; frame < 10; ++frame) {
    for (const VesselPoint& point : detected(detector, grain(20.0, 3))) ASSERT_GE(point.strength, 0.0999F);
  }
}

TEST(RidgeDetector, RepeatsItself)
{
  RidgeDetector first, second;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const cv::Mat photo = grain(15.0, seed);
    const VesselPoints a = detected(first, photo), b = detected(second, photo);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      ASSERT_EQ(a[i].x, b[i].x);
      ASSERT_EQ(a[i].y, b[i].y);
      ASSERT_EQ(a[i].strength, b[i].strength);
    }
  }
}

}  // namespace
}  // namespace eyeslam::tracking
