// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/overlay.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "eyeslam/tracking/track_display.h"
#include "eyeslam/tracking/view_geometry.h"

using eyeslam::retina::Pose2;
using eyeslam::retina::VesselMap;
using namespace eyeslam::tracking;

namespace {

constexpr double kRounding = 1e-9;

VesselMap mapWithOneVessel(int column, int row)
{
  VesselMap map;
  map.width = 300;
  map.height = 200;
  map.origin_x = -50.0;
  map.origin_y = -40.0;
  map.px_per_cell = 2.0;
  map.probability.assign(60000, 0);
  map.probability[map.index(column, row)] = 255;
  return map;
}

TEST(ViewGeometry, LeavesTheImageCentreToTheTranslation)
{
  const cv::Point2d centre = transformed(mapFromImage({3.0, -4.0, 0.7, 1.3}, {401, 305}), {200.0, 152.0});
  EXPECT_NEAR(centre.x, 203.0, kRounding);
  EXPECT_NEAR(centre.y, 148.0, kRounding);
}

TEST(ViewGeometry, UndoesWhatItDid)
{
  const cv::Matx23d forth = mapFromImage({13.0, -4.0, 0.7, 1.3}, {400, 304});
  const cv::Point2d point = transformed(chain(inverse(forth), forth), {17.0, 290.0});
  EXPECT_NEAR(point.x, 17.0, 1e-6);
  EXPECT_NEAR(point.y, 290.0, 1e-6);
}

TEST(ViewGeometry, BringsAMapCellToWhereTheViewShowsIt)
{
  // Cell (100, 60) lies at map (150, 80); the view is shifted by (10, 20) and not turned.
  const auto seen = vesselsInView(mapWithOneVessel(100, 60), {10.0, 20.0, 0.0, 1.0}, {400, 304}, 10);
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_NEAR(seen[0].x, 140.0, kRounding);
  EXPECT_NEAR(seen[0].y, 60.0, kRounding);
  EXPECT_TRUE(vesselsInView(mapWithOneVessel(100, 60), {1000.0, 0.0, 0.0, 1.0}, {400, 304}, 10).empty());
}

TEST(ViewGeometry, KeepsAboutAsManyCellsAsAsked)
{
  VesselMap map = mapWithOneVessel(0, 0);
  std::fill(map.probability.begin(), map.probability.end(), std::uint8_t{200});
  const auto seen = vesselsInView(map, {}, {400, 304}, 500);
  EXPECT_GE(seen.size(), 500U);
  EXPECT_LE(seen.size(), 501U);
}

/// One picture of the overlay over a grey frame.
class OverlayPicture : public testing::Test {
 protected:
  const cv::Mat& draw(cv::Size size = {800, 608}, int type = CV_8UC3)
  {
    frame = cv::Mat(size, type, cv::Scalar::all(60));
    return overlay.draw({frame, points, map, mosaic, {0.0, 0.0}, 2.0, result, tip, 1.0, spot});
  }

  cv::Mat frame, mosaic;
  std::vector<cv::Point2f> points;
  VesselMap map;
  TrackResult result;
  ToolTip tip;
  AimingSpot spot;
  Overlay overlay;
};

TEST_F(OverlayPicture, HasEvenSidesForAnyFrameAndPixel)
{
  for (const cv::Size size : {cv::Size(800, 608), cv::Size(1920, 1080), cv::Size(129, 97), cv::Size(641, 479)}) {
    for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3}) {
      const cv::Mat& picture = draw(size, type);
      EXPECT_EQ(picture.type(), CV_8UC3);
      EXPECT_EQ(picture.cols % 2, 0);
      EXPECT_EQ(picture.rows % 2, 0);
      EXPECT_LE(picture.cols, 1284);
    }
  }
}

TEST_F(OverlayPicture, IsAsWideAsItsOptionSays)
{
  OverlayOptions options;
  options.panel_width = 200;
  overlay = Overlay(options);
  EXPECT_EQ(draw().cols, 2 * 200 + 4);
}

TEST_F(OverlayPicture, ForgetsThePathBeyondItsTrail)
{
  const auto walk = [this](int trail) {
    OverlayOptions options;
    options.trail_frames = trail;
    overlay = Overlay(options);
    result.tracked = true;
    for (const double x : {-200.0, 0.0, 200.0, 200.0, 200.0}) {
      result.map_T_frame.x = x;
      draw();
    }
    return draw().clone();
  };
  EXPECT_GT(cv::norm(walk(100), walk(2), cv::NORM_INF), 50.0);
}

TEST_F(OverlayPicture, MarksAPointWhereItLies)
{
  const cv::Mat before = draw().clone();
  points.emplace_back(400.0F, 304.0F);
  const cv::Mat after = draw();
  EXPECT_NE(before.at<cv::Vec3b>(152, 200), after.at<cv::Vec3b>(152, 200));
  EXPECT_EQ(before.at<cv::Vec3b>(250, 100), after.at<cv::Vec3b>(250, 100));
}

TEST_F(OverlayPicture, BringsTheMapIntoATrackedFrameOnly)
{
  map = mapWithOneVessel(0, 0);
  std::fill(map.probability.begin(), map.probability.end(), std::uint8_t{255});
  result.tracked = true;
  const auto below = [](const cv::Mat& picture) { return picture.at<cv::Vec3b>(304 + 4 + 100, 100); };
  const cv::Vec3b tracked = below(draw());
  result.tracked = false;
  EXPECT_NE(below(draw()), tracked);
}

TEST_F(OverlayPicture, RingsTheTip)
{
  const cv::Mat before = draw().clone();
  tip.present = true;
  tip.x_px = 400.0;
  tip.y_px = 304.0;
  tip.shaft_width_px = 30.0;
  const cv::Mat after = draw();
  const cv::Rect around(195, 304 + 4 + 147, 11, 11);
  EXPECT_GT(cv::norm(before(around), after(around), cv::NORM_INF), 50.0);
}

TEST_F(OverlayPicture, MarksTheAimingSpot)
{
  const cv::Mat before = draw().clone();
  spot.present = true;
  spot.x_px = 400.0;
  spot.y_px = 304.0;
  const cv::Mat after = draw();
  const cv::Rect around(195, 304 + 4 + 147, 11, 11);
  EXPECT_GT(cv::norm(before(around), after(around), cv::NORM_INF), 50.0);
}

TEST(TrackDisplay, LeavesAnImageWithoutWindowAlone)
{
  vpImage<vpRGBa> colour(304, 400);
  vpImage<unsigned char> grey(304, 400);
  EXPECT_NO_THROW(displayTrack(colour, mapWithOneVessel(9, 9), {}, {}, vpColor::cyan, 1));
  EXPECT_NO_THROW(displayTrack(grey, mapWithOneVessel(9, 9), {}, {}, vpColor::cyan, 1));
}

}  // namespace
