// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/tool_tip_tracker.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/allocation_counter.h"
#include "support/sanitized.h"

using eyeslam::tracking::Frame;
using eyeslam::tracking::OcclusionMask;
using eyeslam::tracking::ToolTip;
using eyeslam::tracking::ToolTipOptions;
using eyeslam::tracking::ToolTipTracker;

namespace {

const cv::Scalar kRetina(42, 66, 200), kSteel(80, 80, 82), kShine(170, 168, 170);
constexpr double kPixel = 1.0;          // drawn edges are blurred over 2 px, and cut off at 1/16 px
constexpr double kDrawnWider_px = 2.0;  // smooth polygons are drawn up to a px wider on each side
constexpr double kAngle_deg = 0.3;      // a px over the visible length of the shaft

/// An instrument: a shaft of one width with a taper that is twice as long as the shaft is wide.
struct Instrument {
  cv::Point2d tip;
  double angle_deg = 0.0;
  double width = 30.0;
};

class Scene {
 public:
  explicit Scene(cv::Size size = {800, 608}) : picture_(size, CV_8UC3, kRetina) {}

  Scene& rim(int radius)
  {
    cv::Mat outside(picture_.size(), CV_8U, cv::Scalar(255));
    cv::circle(outside, cv::Point(picture_.cols / 2, picture_.rows / 2), radius, 0, -1);
    picture_.setTo(cv::Scalar(2, 2, 4), outside);
    return *this;
  }
  Scene& shadow(const Instrument& tool, double shift)
  {
    cv::Mat dark = picture_.clone();
    draw(dark, {tool.tip + cv::Point2d(0.0, shift), tool.angle_deg, tool.width}, tool.width, kRetina * 0.55);
    picture_ = dark;
    return *this;
  }
  Scene& instrument(const Instrument& tool)
  {
    draw(picture_, tool, tool.width, kSteel);
    draw(picture_, tool, tool.width / 4.0, kShine);
    return *this;
  }
  Scene& bloom(cv::Point at, int radius)
  {
    cv::circle(picture_, at, radius, cv::Scalar(250, 252, 254), -1, cv::LINE_AA);
    return *this;
  }
  /// As the rendered sequences have them: white in the middle, with a glow that fades over four radii.
  Scene& glow(cv::Point2d at, double radius)
  {
    for (int y = 0; y < picture_.rows; ++y) {
      for (int x = 0; x < picture_.cols; ++x) {
        const double square = ((x - at.x) * (x - at.x) + (y - at.y) * (y - at.y)) / (radius * radius);
        const double light = 255.0 * (1.03 * std::exp(-0.28 * square) + 0.8 * std::exp(-1.4 * square));
        auto& pixel = picture_.at<cv::Vec3b>(y, x);
        for (int c = 0; c < 3; ++c) pixel[c] = cv::saturate_cast<std::uint8_t>(pixel[c] + light);
      }
    }
    return *this;
  }
  Scene& beam(cv::Point at, int radius)
  {
    cv::Mat light = cv::Mat::zeros(picture_.size(), CV_8UC3);
    cv::circle(light, at, radius, cv::Scalar(0, 20, 130), -1, cv::LINE_AA);
    picture_ += light;
    return *this;
  }
  cv::Mat blurred() const
  {
    cv::Mat soft;
    cv::GaussianBlur(picture_, soft, {}, 1.0);
    return soft;
  }

 private:
  static void draw(cv::Mat& picture, const Instrument& tool, double width, const cv::Scalar& colour)
  {
    const double angle = tool.angle_deg * CV_PI / 180.0, taper = 2.0 * tool.width;
    const cv::Point2d along(std::cos(angle), std::sin(angle)), across(-along.y, along.x);
    const cv::Point2d shoulder = tool.tip - taper * along, far = tool.tip - 2000.0 * along;
    const double blunt = std::min(2.0, width / 4.0);
    std::vector<cv::Point> corners;
    for (const cv::Point2d corner :
         {far - width / 2 * across, shoulder - width / 2 * across, tool.tip - blunt * across, tool.tip + blunt * across,
          shoulder + width / 2 * across, far + width / 2 * across}) {
      corners.emplace_back(cvRound(corner.x * 16.0), cvRound(corner.y * 16.0));
    }
    cv::fillConvexPoly(picture, corners, colour, cv::LINE_AA, 4);
  }

  cv::Mat picture_;
};

ToolTip find(const cv::Mat& picture, const ToolTipOptions& options = {})
{
  Frame frame;
  OcclusionMask mask;
  ToolTipTracker tracker(options);
  EXPECT_EQ(frame.assign(picture), eyeslam::retina::Reason::none);
  mask.update(frame);
  return tracker.update(frame, mask, picture);
}

double distance(const ToolTip& tip, const Instrument& tool)
{
  return std::hypot(tip.x_px - tool.tip.x, tip.y_px - tool.tip.y);
}

double turn(const ToolTip& tip, double angle_deg)
{
  return std::abs(std::remainder(tip.shaft_angle * 180.0 / CV_PI - angle_deg, 360.0));
}

TEST(ToolTipTracker, FindsTipAxisAndWidthFromAnySide)
{
  for (const double angle_deg : {0.0, 25.0, 70.0, 110.0, 158.0, 190.0, 245.0, 290.0, 333.0}) {
    for (const double width : {20.0, 32.0, 60.0}) {
      const Instrument tool{{402.3, 297.6}, angle_deg, width};
      const ToolTip tip = find(Scene().instrument(tool).blurred());
      ASSERT_TRUE(tip.present) << angle_deg << " deg, " << width << " px";
      EXPECT_LT(distance(tip, tool), 2.0 * kPixel) << angle_deg << " deg, " << width << " px";
      EXPECT_LT(turn(tip, angle_deg), kAngle_deg) << angle_deg << " deg, " << width << " px";
      EXPECT_NEAR(tip.shaft_width_px, width, kDrawnWider_px);
    }
  }
}

TEST(ToolTipTracker, FindsAnInstrumentThatComesOutOfTheRim)
{
  const Instrument tool{{430.0, 330.0}, 15.0, 32.0};
  const ToolTip tip = find(Scene().instrument(tool).rim(290).blurred());
  ASSERT_TRUE(tip.present);
  EXPECT_LT(distance(tip, tool), 2.0 * kPixel);
}

TEST(ToolTipTracker, SeesNoneWhereThereIsNone)
{
  EXPECT_FALSE(find(Scene().blurred()).present);
  EXPECT_FALSE(find(Scene().rim(290).bloom({300, 200}, 25).bloom({120, 300}, 20).blurred()).present);
  EXPECT_FALSE(find(Scene().bloom({2, 300}, 30).bloom({500, 606}, 18).blurred()).present) << "blooms at the border";
  EXPECT_FALSE(find(cv::Mat(608, 800, CV_8UC3, cv::Scalar(0, 0, 0))).present);
  EXPECT_FALSE(find(cv::Mat(608, 800, CV_8UC3, cv::Scalar(255, 255, 255))).present);
}

TEST(ToolTipTracker, TakesARodInsideTheViewForNoInstrument)
{
  Scene scene;
  for (int x = 300; x < 500; x += 6) scene.bloom({x, 300}, 8);
  EXPECT_FALSE(find(scene.blurred()).present);
}

TEST(ToolTipTracker, SeesNoTipWhereTheShaftCrossesTheWholeView)
{
  EXPECT_FALSE(find(Scene().instrument({{1200.0, 400.0}, 10.0, 30.0}).blurred()).present);
}

TEST(ToolTipTracker, IsNotMovedByBloomsOnTheShaftAndBesideIt)
{
  const Instrument tool{{430.0, 310.0}, 12.0, 36.0};
  const cv::Mat picture = Scene().instrument(tool).bloom({250, 262}, 22).bloom({150, 290}, 18).blurred();
  const ToolTip tip = find(picture);
  ASSERT_TRUE(tip.present);
  EXPECT_LT(distance(tip, tool), 2.0 * kPixel);
  EXPECT_LT(turn(tip, 12.0), kAngle_deg);
}

TEST(ToolTipTracker, IsNotMovedByTheShadow)
{
  const Instrument tool{{430.0, 310.0}, 12.0, 36.0};
  for (const double shift : {-24.0, 24.0}) {
    const ToolTip tip = find(Scene().shadow(tool, shift).instrument(tool).blurred());
    ASSERT_TRUE(tip.present);
    EXPECT_LT(distance(tip, tool), 2.0 * kPixel);
    EXPECT_LT(turn(tip, 12.0), kAngle_deg);
  }
}

TEST(ToolTipTracker, FindsTheTipInItsAimingBeam)
{
  const Instrument tool{{430.0, 310.0}, 12.0, 30.0};
  const ToolTip tip = find(Scene().instrument(tool).beam({430, 310}, 9).blurred());
  ASSERT_TRUE(tip.present);
  EXPECT_LT(distance(tip, tool), 2.5 * kPixel);
}

TEST(ToolTipTracker, SaysHowLittleItKnowsWhereABloomHidesTheTip)
{
  const Instrument tool{{430.0, 310.0}, 0.0, 32.0};
  const ToolTip tip = find(Scene().instrument(tool).bloom({430, 310}, 24).blurred());
  ASSERT_TRUE(tip.present);
  const Eigen::Vector2d error(tip.x_px - tool.tip.x, tip.y_px - tool.tip.y);
  EXPECT_GT(std::sqrt(tip.covariance(0, 0)), 5.0);  // along the shaft
  EXPECT_LT(std::sqrt(tip.covariance(1, 1)), 2.0);  // across it is as good as ever
  EXPECT_LT(error.dot(tip.covariance.inverse() * error), 9.0);
}

// Its flank is as grey as steel, and not as white as its middle.
TEST(ToolTipTracker, SaysHowLittleItKnowsWhereABloomGlowsBesideTheTip)
{
  const Instrument tool{{430.0, 310.0}, 140.0, 32.0};
  double farthest = 0.0;
  for (const double radius : {6.0, 8.0, 11.0, 15.0}) {
    for (int turn = 0; turn < 24; turn += eyeslam::support::kSanitized ? 4 : 1) {
      for (const double apart : {0.5, 1.0, 1.4, 1.8, 2.2, 2.6, 3.0}) {
        const double angle = turn * CV_PI / 12.0;
        const cv::Point2d at = tool.tip + apart * radius * cv::Point2d(std::cos(angle), std::sin(angle));
        const ToolTip tip = find(Scene().instrument(tool).glow(at, radius).blurred());
        if (!tip.present) continue;
        const Eigen::Vector2d error(tip.x_px - tool.tip.x, tip.y_px - tool.tip.y);
        farthest = std::max(farthest, error.norm());
        EXPECT_LT(error.dot(tip.covariance.inverse() * error), 16.0)
            << error.norm() << " px, glow of " << radius << " px at " << at;
      }
    }
  }
  EXPECT_TRUE(farthest > 8.0 || eyeslam::support::kSanitized) << "no glow led it on, so that this proves nothing";
}

TEST(ToolTipTracker, ReadsSixteenBitsAlike)
{
  const cv::Mat picture = Scene().instrument({{430.0, 310.0}, 12.0, 36.0}).blurred();
  cv::Mat deep;
  picture.convertTo(deep, CV_16U, 257.0);
  const ToolTip shallow_tip = find(picture), deep_tip = find(deep);
  ASSERT_TRUE(deep_tip.present);
  EXPECT_NEAR(deep_tip.x_px, shallow_tip.x_px, 0.05);
  EXPECT_NEAR(deep_tip.y_px, shallow_tip.y_px, 0.05);
}

TEST(ToolTipTracker, FindsTheShineInGreyImagesAndOwnsUpToItsOffset)
{
  const Instrument tool{{430.0, 310.0}, 12.0, 40.0};
  cv::Mat grey;
  cv::cvtColor(Scene().instrument(tool).blurred(), grey, cv::COLOR_BGR2GRAY);
  const ToolTip tip = find(grey);
  ASSERT_TRUE(tip.present);
  EXPECT_LT(turn(tip, 12.0), 1.0);
  const Eigen::Vector2d error(tip.x_px - tool.tip.x, tip.y_px - tool.tip.y);
  EXPECT_LT(error.dot(tip.covariance.inverse() * error), 9.0);
}

TEST(ToolTipTracker, SaysNothingThatIsNotFiniteOfNoise)
{
  cv::RNG random(7);
  for (int i = 0; i < 60; ++i) {
    const int type = std::array<int, 4>{CV_8UC3, CV_8UC1, CV_16UC3, CV_16UC1}[static_cast<std::size_t>(i % 4)];
    cv::Mat coarse(random.uniform(2, 24), random.uniform(2, 24), type), picture;
    random.fill(coarse, cv::RNG::UNIFORM, 0, CV_MAT_DEPTH(type) == CV_8U ? 256 : 65536);
    cv::resize(coarse, picture, {random.uniform(64, 500), random.uniform(64, 400)}, 0, 0, cv::INTER_NEAREST);
    const ToolTip tip = find(picture);
    EXPECT_TRUE(std::isfinite(tip.x_px + tip.y_px + tip.shaft_angle + tip.shaft_width_px + tip.covariance.sum()));
  }
}

TEST(ToolTipTracker, OptionsSayWhatIsSteel)
{
  const cv::Mat picture = Scene().instrument({{430.0, 310.0}, 12.0, 36.0}).blurred();
  cv::Mat grey;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  ToolTipOptions options;
  EXPECT_TRUE(find(picture, options).present);
  EXPECT_TRUE(find(grey, options).present);
  options.bright_share = 3.0;
  EXPECT_FALSE(find(grey, options).present);
  options.saturated = 130.0;  // the shine counts as a bloom: no end of it is trusted
  const ToolTip doubtful = find(picture, options);
  EXPECT_TRUE(!doubtful.present || doubtful.covariance.trace() > find(picture).covariance.trace());
  cv::Mat reddish = picture.clone();
  cv::multiply(reddish, cv::Scalar(0.6, 0.8, 1.0), reddish);
  options = {};
  options.grey_share = 0.95;
  EXPECT_FALSE(find(reddish, options).present);
}

TEST(ToolTipTracker, AllocatesNothingOnceItHasSeenAFrame)
{
  const cv::Mat picture = Scene().instrument({{430.0, 310.0}, 12.0, 36.0}).bloom({250, 262}, 22).blurred();
  Frame frame;
  OcclusionMask mask;
  ToolTipTracker tracker;
  frame.assign(picture);
  mask.update(frame);
  const ToolTip first = tracker.update(frame, mask, picture);
  const auto before = eyeslam::support::allocations();
  const ToolTip second = tracker.update(frame, mask, picture);
  EXPECT_EQ(eyeslam::support::allocations(), before);
  EXPECT_EQ(first.x_px, second.x_px);
  EXPECT_EQ(first.y_px, second.y_px);
}

double quantile(std::vector<double> values, double part)
{
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

/// One shared sequence followed with each frame taken by itself.
class SharedSequence : public testing::TestWithParam<const char*> {};

TEST_P(SharedSequence, ShowsTipAndAxisWhereTheTruthHasThem)
{
  const char* shared = std::getenv("EYESLAM_SHARED");
  const std::string folder = std::string(shared ? shared : "") + "/sequences/" + GetParam();
  std::ifstream truth(folder + "/tool.csv");
  cv::VideoCapture video(folder + "/video.mp4");
  if (!truth || !video.isOpened()) GTEST_SKIP() << "SKIPPED: no sequence " << folder << " (set EYESLAM_SHARED)";
  Frame frame;
  OcclusionMask mask;
  ToolTipTracker tracker;
  std::vector<double> errors, turns;
  int present = 0, invented = 0, frames = 0;
  std::string line;
  std::getline(truth, line);
  for (cv::Mat picture; std::getline(truth, line) && video.read(picture); ++frames) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream row(line);
    Instrument tool;
    int number = 0, is_there = 0;
    row >> number >> is_there >> tool.tip.x >> tool.tip.y >> tool.angle_deg >> tool.width;
    frame.assign(picture);
    mask.update(frame);
    const ToolTip& tip = tracker.update(frame, mask, picture);
    present += is_there;
    if (!is_there) invented += tip.present ? 1 : 0;
    if (!is_there || !tip.present) continue;
    errors.push_back(distance(tip, tool));
    turns.push_back(turn(tip, tool.angle_deg));
  }
  EXPECT_LE(invented, frames / 100);
  if (present == 0) return;
  EXPECT_GE(static_cast<double>(errors.size()), 0.97 * present);
  EXPECT_LE(quantile(errors, 0.5), 2.0);
  EXPECT_LE(quantile(turns, 0.5), 1.0);
}

INSTANTIATE_TEST_SUITE_P(ToolTipTracker, SharedSequence,
                         testing::Values("human", "human2", "porcine", "laser", "paper", "plain", "saccade", "blackout",
                                         "deform", "excursion", "hd"));

}  // namespace
