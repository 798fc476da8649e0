// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/baselines/method.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "support/drawn_retina.h"

namespace eyeslam::baselines {
namespace {

using support::arc;
using tracking::TrackResult;

// A retina larger than the view; crops at whole px have an exactly known pose, without any interpolation.
const cv::Mat& widePicture()
{
  static const cv::Mat picture = [] {
    support::DrawnRetina retina(320, 260);
    for (int i = 0; i < 7; ++i) {
      const double angle = 0.5 * i;
      retina.vessel(arc({40.0 + 40.0 * i, 60.0 + 25.0 * (i % 4)}, angle, 0.004 * (i % 3 - 1), 220.0), 2.0 + i % 3, 0.2);
    }
    return retina.photograph(3.0, 1);
  }();
  return picture;
}

// The view of 400 x 300 full px whose corner lies `shift` away from frame 0's.
cv::Mat view(const cv::Point& shift)
{
  return widePicture()(cv::Rect(cv::Point(100, 100) + shift, cv::Size(400, 300)));
}

std::vector<std::string> rivals()
{
  std::vector<std::string> names = methodNames();
  names.erase(names.begin());
  return names;
}

class Rival : public testing::TestWithParam<std::string> {};

TEST_P(Rival, FollowsAViewThatMoves)
{
  const auto method = makeMethod(GetParam(), {});
  for (int frame = 0; frame < 30; ++frame) {
    const cv::Point shift(3 * frame - frame * frame / 20, -2 * frame);
    const TrackResult& result = method->track(view(shift));
    ASSERT_TRUE(result.tracked) << "frame " << frame << ": " << word(result.reason);
    constexpr double kAcceptance_px = 3.0;  // the paper's recipe shall stay within 1.5 half-resolution px
    EXPECT_NEAR(result.map_T_frame.x, shift.x, kAcceptance_px) << "frame " << frame;
    EXPECT_NEAR(result.map_T_frame.y, shift.y, kAcceptance_px) << "frame " << frame;
    EXPECT_NEAR(result.map_T_frame.theta, 0.0, 0.02) << "frame " << frame;
  }
}

TEST_P(Rival, RefusesDarknessAndGoesOnAfterIt)
{
  const auto method = makeMethod(GetParam(), {});
  method->track(view({0, 0}));
  method->track(view({2, 0}));
  const TrackResult& dark = method->track(cv::Mat(300, 400, CV_8UC3, cv::Scalar::all(0)));
  EXPECT_FALSE(dark.tracked);
  EXPECT_EQ(dark.reason, retina::Reason::blackout);
  EXPECT_TRUE(method->track(view({4, 2})).tracked);
}

TEST_P(Rival, GivesTheSameResultsAgain)
{
  const auto first = makeMethod(GetParam(), {});
  const auto second = makeMethod(GetParam(), {});
  for (int frame = 0; frame < 5; ++frame) {
    const retina::Pose2 a = first->track(view({frame, frame})).map_T_frame;
    const retina::Pose2 b = second->track(view({frame, frame})).map_T_frame;
    EXPECT_EQ(a.x, b.x);
    EXPECT_EQ(a.y, b.y);
    EXPECT_EQ(a.theta, b.theta);
  }
}

TEST_P(Rival, RefusesAPictureOfAnotherSize)
{
  const auto method = makeMethod(GetParam(), {});
  method->track(view({0, 0}));
  EXPECT_EQ(method->track(cv::Mat(100, 100, CV_8UC3, cv::Scalar(30, 80, 180))).reason, retina::Reason::wrong_size);
  EXPECT_EQ(method->track(cv::Mat()).reason, retina::Reason::wrong_size);
}

INSTANTIATE_TEST_SUITE_P(Methods, Rival, testing::ValuesIn(rivals()));

TEST(PaperMethod, PublishesCellsThatLieOnVessels)
{
  const auto method = makeMethod("paper", {});
  for (int frame = 0; frame < 10; ++frame) {
    method->track(view({2 * frame, 0}));
    method->updateMap();
  }
  const retina::VesselMap& map = method->vesselMap();
  ASSERT_FALSE(map.empty());
  const cv::Mat_<cv::Vec3b> picture = widePicture();
  int cells = 0, dark = 0;
  for (const retina::MapPoint& point : vesselPoints(map)) {
    const cv::Point at(100 + static_cast<int>(std::lround(point.x_px)),
                       100 + static_cast<int>(std::lround(point.y_px)));
    ASSERT_TRUE(cv::Rect({0, 0}, picture.size()).contains(at));
    const cv::Scalar mean = cv::mean(picture(cv::Rect(at - cv::Point(2, 2), cv::Size(5, 5))));
    ++cells;
    dark += mean[1] < 77.0;  // green of the bare retina is 80
  }
  EXPECT_GT(cells, 200);
  EXPECT_GT(dark, cells * 9 / 10);
  EXPECT_GT(*std::max_element(map.seen.begin(), map.seen.end()), 8);
}

TEST(MakeMethod, NamesTheMethodsThereAreWhenItKnowsNone)
{
  try {
    makeMethod("guess", {});
    FAIL();
  } catch (const std::invalid_argument& error) {
    for (const std::string& name : methodNames()) EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
  }
}

}  // namespace
}  // namespace eyeslam::baselines
