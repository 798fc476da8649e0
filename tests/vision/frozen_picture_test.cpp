// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/vision/frozen_picture.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace eyeslam::vision {
namespace {

/// Counts what it is given, and says where it is by that.
struct CountingTracker {
  int frames = 0;
  tracking::TrackResult result;

  const tracking::TrackResult& track(const cv::Mat&)
  {
    result.tracked = true;
    result.map_T_frame.x = ++frames;
    result.velocity = {1.0, 2.0, 0.1};
    result.score = 0.8;
    return result;
  }
};

cv::Mat pictureOf(int grey) { return cv::Mat(30, 40, CV_8UC3, cv::Scalar::all(grey)); }

TEST(FrozenPicture, IsRefusedWithTheLastGoodPoseAndKeptFromTheTracker)
{
  CountingTracker tracker;
  FrozenPicture live;
  live.track(tracker, pictureOf(1));
  for (int repetition = 0; repetition < 3; ++repetition) {
    const tracking::TrackResult& result = live.track(tracker, pictureOf(1));
    EXPECT_FALSE(result.tracked);
    EXPECT_EQ(result.reason, retina::Reason::frozen);
    EXPECT_DOUBLE_EQ(result.map_T_frame.x, 1.0);
    EXPECT_TRUE(result.velocity.isZero());
  }
  EXPECT_EQ(tracker.frames, 1);
  EXPECT_TRUE(live.track(tracker, pictureOf(2)).tracked);
  EXPECT_EQ(tracker.frames, 2);
}

// One bit of one pixel anywhere, in a picture that is a part of a larger one: rows are not contiguous.
RC_GTEST_PROP(FrozenPicture, DiffersByASingleBit, ())
{
  cv::Mat whole = pictureOf(77);
  FrozenPicture live;
  const cv::Rect part(3, 2, 30, 20);
  live.repeats(whole(part));
  const int x = *rc::gen::inRange(0, part.width);
  const int y = *rc::gen::inRange(0, part.height);
  const int channel = *rc::gen::inRange(0, 3);
  whole.at<cv::Vec3b>(part.y + y, part.x + x)[channel] ^= static_cast<uchar>(1U << *rc::gen::inRange(0U, 8U));
  RC_ASSERT(!live.repeats(whole(part)));
  RC_ASSERT(live.repeats(whole(part)));
}

TEST(FrozenPicture, LooksAtThePictureOnly)
{
  FrozenPicture live;
  cv::Mat whole = pictureOf(77);
  const cv::Rect part(3, 2, 30, 20);
  live.repeats(whole(part));
  whole.at<cv::Vec3b>(0, 0)[0] = 1;  // outside
  EXPECT_TRUE(live.repeats(whole(part)));
}

TEST(FrozenPicture, OfAnotherSizeOrTypeIsANewOne)
{
  FrozenPicture live;
  EXPECT_FALSE(live.repeats(pictureOf(5)));
  EXPECT_FALSE(live.repeats(cv::Mat(40, 30, CV_8UC3, cv::Scalar::all(5))));
  EXPECT_FALSE(live.repeats(cv::Mat(40, 30, CV_8UC1, cv::Scalar::all(5))));
  EXPECT_FALSE(live.repeats(cv::Mat()));
  EXPECT_FALSE(live.repeats(cv::Mat())) << "nothing is no picture; the tracker refuses it by its size";
}

}  // namespace
}  // namespace eyeslam::vision
