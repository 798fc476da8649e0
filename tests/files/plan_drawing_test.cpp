// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/plan_drawing.h"

#include <gtest/gtest.h>

namespace eyeslam::files {
namespace {

constexpr int kSide = 300;  // px of the retina; the figure is 1500 px wide, so five to one

fixtures::BurnPlan planOf(const std::vector<Eigen::Vector2d>& places, retina::Reason reason)
{
  fixtures::BurnPlan plan;
  plan.um_per_px = 10.0;
  for (const Eigen::Vector2d& place : places) {
    fixtures::BurnTarget target;
    target.id = static_cast<int>(plan.targets.size());
    target.position_px = place;
    target.burn_um = target.spot_um = 200.0;
    target.reason = reason;
    plan.targets.push_back(target);
  }
  return plan;
}

PlanBackground grey() { return {cv::Mat(kSide, kSide, CV_8UC3, cv::Scalar::all(120)), {}}; }

int brightness(const cv::Mat& picture, double x, double y)
{
  return picture.at<cv::Vec3b>(cvRound(5.0 * (y + 0.5) - 0.5), cvRound(5.0 * (x + 0.5) - 0.5))[1];
}

TEST(PlanDrawing, ShowsABurnInItsTrueSizeWhiteOrBlack)
{
  for (const auto& [reason, colour] :
       {std::pair(retina::Reason::none, 255), std::pair(retina::Reason::near_vessel, 0)}) {
    const cv::Mat picture = drawPlan(planOf({{100.0, 150.0}}, reason), grey(), {}).pixels();
    EXPECT_EQ(brightness(picture, 100.0, 150.0), colour);
    EXPECT_EQ(brightness(picture, 109.0, 150.0), colour);  // 200 um are 20 px across
    EXPECT_EQ(brightness(picture, 111.0, 150.0), 120);
  }
}

TEST(PlanDrawing, LiesWhereTheBackgroundSaysItDoes)
{
  PlanBackground background = grey();
  background.geometry = {40.0, -20.0, 2.0};
  const cv::Mat picture = drawPlan(planOf({{240.0, 180.0}}, retina::Reason::none), background, {}).pixels();
  EXPECT_EQ(brightness(picture, 100.0, 100.0), 255);
}

TEST(PlanDrawing, ShowsZonesTravelAndTilesAndNothingWithoutThem)
{
  fixtures::BurnPlan plan = planOf({{50.0, 50.0}, {250.0, 50.0}}, retina::Reason::none);
  plan.targets[1].tile = 1;
  plan.prescription.order.reach_um = 400.0;
  const cv::Mat bare = drawPlan(planOf({{50.0, 50.0}}, retina::Reason::none), grey(), {}).pixels();
  plan.prescription.keep_out.circles_px = "150 200 30";
  plan.prescription.keep_out.polygons_px = "20 200 60 200 40 240";
  const cv::Mat full = drawPlan(plan, grey(), {true}).pixels();
  const std::vector<cv::Point2d> drawn = {{180.0, 200.0}, {40.0, 200.0}, {150.0, 50.0}, {250.0, 70.0}};
  for (const cv::Point2d& at : drawn) {
    EXPECT_EQ(brightness(bare, at.x, at.y), 120) << at;
    EXPECT_NE(brightness(full, at.x, at.y), 120) << at;
  }
}

TEST(PlanDrawing, OfAnEmptyPlanIsTheRetina)
{
  const cv::Mat picture = drawPlan(planOf({}, retina::Reason::none), grey(), {true}).pixels();
  EXPECT_EQ(picture.cols, 1500);
  EXPECT_EQ(cv::countNonZero(picture.rowRange(0, 1500).reshape(1) != 120), 0);
}

TEST(PlanDrawing, TellsVesselsFromRetinaAndFromWhatWasNotSeen)
{
  retina::VesselMap map;
  map.width = 30;
  map.height = 10;
  map.probability.assign(300, 0);
  map.seen.assign(300, 20);
  for (int row = 0; row < 10; ++row) {
    map.probability[map.index(5, row)] = 200;
    map.seen[map.index(29, row)] = 1;
  }
  const cv::Mat picture = mapBackground(map, 128, 15).picture;
  ASSERT_EQ(picture.size(), cv::Size(30, 10));
  EXPECT_NE(picture.at<cv::Vec3b>(4, 5), picture.at<cv::Vec3b>(4, 6));
  EXPECT_NE(picture.at<cv::Vec3b>(4, 29), picture.at<cv::Vec3b>(4, 28));
  EXPECT_EQ(picture.at<cv::Vec3b>(4, 6), picture.at<cv::Vec3b>(4, 28));
}

}  // namespace
}  // namespace eyeslam::files
