// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/sequence_renderer.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "eyeslam/simulation/procedural_fundus.h"

namespace eyeslam::simulation {
namespace {

const cv::Size kSmall{200, 152};

Fundus retinaFor(const Condition& condition, const SequenceOptions& options)
{
  ProceduralFundusOptions procedural;
  procedural.um_per_px = umPerPixel(condition.tissue, options);
  return proceduralFundus(procedural, options.seed);
}

std::vector<RenderedFrame> rendered(const Condition& condition, const SequenceOptions& options)
{
  SequenceRenderer renderer(retinaFor(condition, options), condition, options);
  std::vector<RenderedFrame> frames;
  while (auto frame = renderer.next()) frames.push_back(*frame);
  return frames;
}

double meanRed(const RenderedFrame& frame) { return cv::mean(frame.image)[2]; }

TEST(SequenceRenderer, EqualSeedsGiveEqualBytesAndOthersDoNot)
{
  const Condition look = condition("human");
  const auto a = rendered(look, {kSmall, 8, 30.0, 3});
  const auto b = rendered(look, {kSmall, 8, 30.0, 3});
  const auto c = rendered(look, {kSmall, 8, 30.0, 4});
  ASSERT_EQ(a.size(), 8U);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(cv::norm(a[i].image, b[i].image, cv::NORM_INF), 0.0) << i;
  EXPECT_GT(cv::norm(a[0].image, c[0].image, cv::NORM_INF), 0.0);
}

TEST(SequenceRenderer, EveryConditionRendersFromTheSmallestSize)
{
  for (const char* name : conditionNames()) {
    for (const cv::Size size : {cv::Size(128, 96), cv::Size(320, 240)}) {
      const auto frames = rendered(condition(name), {size, 3, 30.0, 2});
      ASSERT_EQ(frames.size(), 3U) << name;
      EXPECT_EQ(frames[2].image.size(), size) << name;
      EXPECT_GT(meanRed(frames[0]), 50.0) << name;
      EXPECT_LT(meanRed(frames[0]), 235.0) << name;
    }
  }
}

TEST(SequenceRenderer, TheLightsColourIsThatOfARetina)
{
  const auto frames = rendered(condition("plain"), {kSmall, 1, 30.0, 6});
  const cv::Scalar mean = cv::mean(frames[0].image);
  EXPECT_GT(mean[0] / mean[2], 0.08);  // source: tracker study 2.3, retina 0.12-0.25 with disc 0.3
  EXPECT_LT(mean[0] / mean[2], 0.32);
}

TEST(SequenceRenderer, FramesWithoutLightAreDarkAndMarked)
{
  Condition look = condition("blackout");
  const auto frames = rendered(look, {kSmall, 240, 30.0, 8});
  int hidden = 0;
  for (const RenderedFrame& frame : frames) {
    if (!frame.visible) ++hidden;
    // Half the light is the border; a frame within the switching lies near it.
    if (frame.visible) {
      EXPECT_GT(meanRed(frame), 30.0) << frame.frame;
    } else {
      EXPECT_LT(meanRed(frame), 75.0) << frame.frame;
    }
  }
  EXPECT_GT(hidden, 30);
  EXPECT_LT(hidden, 150);
}

TEST(SequenceRenderer, TheTipIsWhereTheTruthSays)
{
  Condition look = condition("porcine");
  look.microscope.blooms.count = 0;
  int seen = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const auto frames = rendered(look, {{400, 304}, 2, 30.0, seed});
    const InstrumentPose& tool = frames[1].tool;
    const cv::Point2d ahead(std::cos(tool.shaft_angle), std::sin(tool.shaft_angle));
    const auto blueOverRed = [&](cv::Point2d place) {
      const cv::Vec3b pixel = frames[1].image(cv::Point(cvRound(place.x), cvRound(place.y)));
      return pixel[0] / (1.0 + pixel[2]);
    };
    if (!tool.present || tool.tip.x < 30 || tool.tip.y < 30 || tool.tip.x > 370 || tool.tip.y > 270) continue;
    EXPECT_GT(blueOverRed(tool.tip - 5.0 * ahead), 0.6) << seed;
    EXPECT_LT(blueOverRed(tool.tip + 4.0 * ahead), 0.45) << seed;
    EXPECT_GT(frames[1].tool_cover, 0.005);
    ++seen;
  }
  EXPECT_GT(seen, 0);
}

TEST(SequenceRenderer, BurnsStayOnTheRetinaAsItMoves)
{
  Condition look = condition("laser");
  look.microscope.laser.first_frame = 3;
  look.microscope.blooms.count = 0;
  look.microscope.instrument.present_fraction = 1.0;
  const SequenceOptions options{{400, 304}, 24, 30.0, 5};
  const Fundus fundus = retinaFor(look, options);
  SequenceRenderer with(fundus, look, options);
  look.microscope.laser.every_frames = 0;
  SequenceRenderer without(fundus, look, options);
  cv::Point2d burn;
  for (int i = 0; i < options.frames; ++i) {
    const RenderedFrame a = *with.next();
    const RenderedFrame b = *without.next();
    const Eigen::Vector2d centre(199.5, 151.5);
    if (a.fired) {
      const Eigen::Vector2d map = a.map_T_frame * (Eigen::Vector2d(a.tool.tip.x, a.tool.tip.y) - centre);
      burn = {map.x(), map.y()};
    }
    if (i != options.frames - 1) continue;
    const Eigen::Vector2d place = centre + a.map_T_frame.inverse() * Eigen::Vector2d(burn.x, burn.y);
    const cv::Point2d off = cv::Point2d(place.x(), place.y()) - a.tool.tip;
    if (std::hypot(off.x, off.y) < 25.0) GTEST_SKIP() << "the instrument still stands over its burn";
    const cv::Point pixel(cvRound(place.x()), cvRound(place.y()));
    EXPECT_GT(a.image(pixel)[1], b.image(pixel)[1] + 20);
  }
}

TEST(SequenceRenderer, TheVesselTruthLiesWhereTheFirstFrameIsDark)
{
  Condition look = condition("paper");
  look.microscope.instrument.present_fraction = 0.0;
  const SequenceOptions options{{400, 304}, 1, 30.0, 3};
  SequenceRenderer renderer(retinaFor(look, options), look, options);
  const RenderedFrame frame = *renderer.next();
  const cv::Point corner(cvRound(-renderer.vesselsOrigin().x), cvRound(-renderer.vesselsOrigin().y));
  const cv::Mat calibre = renderer.vessels()(cv::Rect(corner, options.size));
  cv::Mat green;
  cv::extractChannel(frame.image, green, 1);
  green.convertTo(green, CV_32F);
  cv::Mat mean;
  cv::blur(green, mean, {41, 41});
  const cv::Mat ratio = green / mean;
  EXPECT_LT(cv::mean(ratio, calibre >= 4.0F)[0], cv::mean(ratio, calibre == 0.0F)[0] - 0.05);
}

TEST(SequenceRenderer, RefusesARetinaSmallerThanTheView)
{
  Fundus tiny = proceduralFundus({40.0, 6.0, 4.0, 1.0, 1.0, {}}, 1);
  tiny.um_per_px = 5.0;
  EXPECT_THROW(SequenceRenderer(tiny, condition("human"), {{800, 608}, 10, 30.0, 1}), std::invalid_argument);
}

TEST(Condition, NamesThoseKnownWhenAskedForAnother)
{
  EXPECT_THROW(condition("foggy"), std::invalid_argument);
  for (const char* name : conditionNames()) EXPECT_EQ(condition(name).name, name);
}

}  // namespace
}  // namespace eyeslam::simulation
