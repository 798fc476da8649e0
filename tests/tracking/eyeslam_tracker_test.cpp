// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/eyeslam_tracker.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "support/moving_retina.h"

namespace eyeslam::tracking {
namespace {

using retina::Pose2;
using retina::Reason;
using support::centreError;
using support::MovingRetina;
using support::smallRetina;
using support::toString;

const cv::Size kSmall{320, 240};
constexpr double kDegree = M_PI / 180.0;
constexpr double kSubPixel_px = 0.3;  // a third of the smallest difference that a whole-px tracker could see

cv::Point drift(int frame) { return {3 * frame, -2 * frame + frame * frame / 12}; }

cv::Mat driftingView(int frame) { return smallRetina().view(kSmall, drift(frame), static_cast<unsigned>(frame)); }

cv::Mat grey(const cv::Mat& colour)
{
  cv::Mat result;
  cv::extractChannel(colour, result, 1);
  return result;
}

cv::Mat sixteenBit(const cv::Mat& picture)
{
  cv::Mat result;
  picture.convertTo(result, CV_16U, 257.0);
  return result;
}

vpImage<vpRGBa> visp(const cv::Mat_<cv::Vec3b>& bgr)
{
  vpImage<vpRGBa> image(static_cast<unsigned>(bgr.rows), static_cast<unsigned>(bgr.cols));
  for (int y = 0; y < bgr.rows; ++y) {
    for (int x = 0; x < bgr.cols; ++x) {
      image[static_cast<unsigned>(y)][x] = vpRGBa(bgr(y, x)[2], bgr(y, x)[1], bgr(y, x)[0]);
    }
  }
  return image;
}

vpImage<unsigned char> vispGrey(const cv::Mat_<std::uint8_t>& picture)
{
  vpImage<unsigned char> image(static_cast<unsigned>(picture.rows), static_cast<unsigned>(picture.cols));
  for (int y = 0; y < picture.rows; ++y) std::memcpy(image[static_cast<unsigned>(y)], picture[y], image.getWidth());
  return image;
}

void expectIdentical(const TrackResult& a, const TrackResult& b)
{
  EXPECT_EQ(a.frame, b.frame);
  EXPECT_EQ(a.tracked, b.tracked);
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.map_T_frame.x, b.map_T_frame.x);
  EXPECT_EQ(a.map_T_frame.y, b.map_T_frame.y);
  EXPECT_EQ(a.map_T_frame.theta, b.map_T_frame.theta);
  EXPECT_EQ(a.map_T_frame.scale, b.map_T_frame.scale);
  EXPECT_TRUE(a.covariance == b.covariance);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.score, b.score);
}

TEST(EyeSlamTracker, FollowsADriftBelowAPixel)
{
  EyeSlamTracker tracker;
  for (int frame = 0; frame < 30; ++frame) {
    const TrackResult& result = tracker.track(driftingView(frame));
    ASSERT_TRUE(result.tracked) << frame << ": " << toString(result);
    EXPECT_EQ(result.frame, frame);
    EXPECT_LT(centreError(result, drift(frame).x, drift(frame).y), kSubPixel_px) << frame;
    EXPECT_NEAR(result.map_T_frame.theta, 0.0, 0.05 * kDegree) << frame;
    EXPECT_EQ(result.map_T_frame.scale, 1.0);
  }
}

TEST(EyeSlamTracker, SaysHowFastTheViewMovesAndNothingWhereItIsLost)
{
  EyeSlamTracker tracker;
  const auto follow = [&](int from, int to, const cv::Point& step) {
    for (int frame = from; frame < to; ++frame)
      tracker.track(smallRetina().view(kSmall, frame * step, static_cast<unsigned>(frame)));
    return tracker.getResult().velocity;
  };
  EXPECT_EQ(follow(0, 1, {}).norm(), 0.0) << "one frame shows no motion";
  const Eigen::Vector3d velocity = follow(1, 25, {4, -2});
  EXPECT_NEAR(velocity.x(), 4.0, kSubPixel_px);
  EXPECT_NEAR(velocity.y(), -2.0, kSubPixel_px);
  EXPECT_NEAR(velocity.z(), 0.0, 0.1 * kDegree);
  tracker.track(cv::Mat(kSmall, CV_8UC3, cv::Scalar(2, 3, 5)));
  ASSERT_FALSE(tracker.getResult().tracked);
  EXPECT_EQ(tracker.getResult().velocity.norm(), 0.0);
}

TEST(EyeSlamTracker, TakesImagesOfViSPLikeThoseOfOpenCV)
{
  EyeSlamTracker opencv, visp_colour;
  EyeSlamTracker opencv_grey, visp_grey;
  for (int frame = 0; frame < 8; ++frame) {
    SCOPED_TRACE(frame);
    const cv::Mat picture = driftingView(frame);
    expectIdentical(opencv.track(picture), visp_colour.track(visp(picture)));
    expectIdentical(opencv_grey.track(grey(picture)), visp_grey.track(vispGrey(grey(picture))));
  }
}

TEST(EyeSlamTracker, KeepsThePoseInViSPsParameters)
{
  EyeSlamTracker tracker;
  ASSERT_EQ(tracker.p.size(), 4U);
  for (int frame = 0; frame < 5; ++frame) tracker.track(driftingView(frame));
  const Pose2& pose = tracker.getPose();
  EXPECT_EQ(tracker.p[0], pose.x);
  EXPECT_EQ(tracker.p[1], pose.y);
  EXPECT_EQ(tracker.p[2], pose.theta);
  EXPECT_EQ(tracker.p[3], pose.scale);
  EXPECT_GT(std::abs(pose.x), 1.0);
}

TEST(EyeSlamTracker, StartsAgainWithInitTracking)
{
  EyeSlamTracker used, fresh;
  for (int frame = 0; frame < 6; ++frame) used.track(driftingView(frame));
  used.initTracking(driftingView(10));
  expectIdentical(used.getResult(), fresh.initTracking(driftingView(10)));
  EXPECT_EQ(used.getResult().frame, 0);
  EXPECT_EQ(used.getPose().x, 0.0);
  for (int frame = 11; frame < 15; ++frame)
    expectIdentical(used.track(driftingView(frame)), fresh.track(driftingView(frame)));
}

TEST(EyeSlamTracker, GivesIdenticalResultsForIdenticalInput)
{
  EyeSlamTracker first, second;
  for (int frame = 0; frame < 20; ++frame) {
    SCOPED_TRACE(frame);
    expectIdentical(first.track(driftingView(frame)), second.track(driftingView(frame)));
    first.updateMap();
    second.updateMap();
  }
  EXPECT_FALSE(first.getVesselMap().empty());
  EXPECT_EQ(first.getVesselMap().probability, second.getVesselMap().probability);
  EXPECT_EQ(first.getVesselMap().seen, second.getVesselMap().seen);
}

TEST(EyeSlamTracker, TakesSixteenBitsLikeEight)
{
  EyeSlamTracker eight, sixteen;
  for (int frame = 0; frame < 12; ++frame) {
    const Pose2 a = eight.track(driftingView(frame)).map_T_frame;
    const TrackResult& b = sixteen.track(sixteenBit(driftingView(frame)));
    ASSERT_TRUE(b.tracked) << frame << ": " << toString(b);
    constexpr double kRoundedColours_px = 0.05;  // red and blue of the masks are rounded to eight bits elsewhere
    EXPECT_LT(centreError(b, a.x, a.y), kRoundedColours_px) << frame;
  }
}

TEST(EyeSlamTracker, FollowsGreyPictures)
{
  EyeSlamTracker tracker;
  for (int frame = 0; frame < 30; ++frame) {
    const TrackResult& result = tracker.track(grey(driftingView(frame)));
    ASSERT_TRUE(result.tracked) << frame << ": " << toString(result);
    EXPECT_LT(centreError(result, drift(frame).x, drift(frame).y), kSubPixel_px) << frame;
  }
}

struct Geometry {
  cv::Size size;
  double scale;
};
void PrintTo(const Geometry& geometry, std::ostream* out)
{
  *out << geometry.size.width << "x" << geometry.size.height << " at " << geometry.scale;
}

class AnyGeometry : public testing::TestWithParam<Geometry> {};

// An origin half a px beside the image centre would show as 0.37 px after 30 deg.
TEST_P(AnyGeometry, TurnsAboutTheImageCentre)
{
  TrackerOptions options;
  options.frame.scale = GetParam().scale;
  EyeSlamTracker tracker(options);
  Pose2 error;
  for (int frame = 0; frame <= 30; ++frame) {
    const Pose2 truth{1.5 * frame, 0.5 * frame, frame * kDegree, 1.0};
    const TrackResult& result =
        tracker.track(smallRetina().turned(GetParam().size, truth, static_cast<unsigned>(frame)));
    ASSERT_TRUE(result.tracked) << frame << ": " << toString(result);
    error = {result.map_T_frame.x - truth.x, result.map_T_frame.y - truth.y, result.map_T_frame.theta - truth.theta};
  }
  constexpr double kInterpolation_px = 0.15;  // noise, and the picture's 1/32 px
  EXPECT_NEAR(error.x, 0.0, kInterpolation_px);
  EXPECT_NEAR(error.y, 0.0, kInterpolation_px);
  EXPECT_NEAR(error.theta, 0.0, 0.05 * kDegree);
}

INSTANTIATE_TEST_SUITE_P(SizesAndScales, AnyGeometry,
                         testing::Values(Geometry{{320, 240}, 0.5}, Geometry{{321, 241}, 0.5},
                                         Geometry{{322, 243}, 0.5}, Geometry{{320, 240}, 1.0},
                                         Geometry{{321, 241}, 1.0}, Geometry{{320, 240}, 0.4},
                                         Geometry{{321, 241}, 0.4}));

class AnySize : public testing::TestWithParam<cv::Size> {};

TEST_P(AnySize, IsFollowed)
{
  const cv::Size size = GetParam();
  const double factor = size.width / 320.0;
  const MovingRetina retina = smallRetina().enlarged(factor);
  EyeSlamTracker tracker;
  for (int frame = 0; frame < 8; ++frame) {
    const cv::Point shift(cvRound(2 * frame * factor), cvRound(frame * factor));
    const TrackResult& result = tracker.track(retina.view(size, shift, static_cast<unsigned>(frame)));
    ASSERT_TRUE(result.tracked) << frame << ": " << toString(result);
    EXPECT_LT(centreError(result, shift.x, shift.y), kSubPixel_px * std::max(1.0, factor)) << frame;
  }
}

INSTANTIATE_TEST_SUITE_P(FromTheSmallestToHd, AnySize,
                         testing::Values(cv::Size(128, 96), cv::Size(200, 152), cv::Size(400, 304), cv::Size(720, 576),
                                         cv::Size(1920, 1080)));

}  // namespace
}  // namespace eyeslam::tracking
