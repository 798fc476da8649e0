// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <random>
#include <string>

#include "eyeslam/tracking/eyeslam_tracker.h"
#include "support/moving_retina.h"

namespace eyeslam::tracking {
namespace {

using retina::Reason;
using support::centreError;
using support::smallRetina;
using support::toString;

const cv::Size kSmall{320, 240};
const cv::Mat kDark(kSmall, CV_8UC3, cv::Scalar(2, 3, 5));
constexpr double kSubPixel_px = 0.3;

cv::Mat view(const cv::Point& shift, int frame)
{
  return smallRetina().view(kSmall, shift, static_cast<unsigned>(frame));
}

/// A view that drifts by 3 px a frame from frame 0 on.
cv::Point drift(int frame) { return {3 * frame, -frame}; }

void expectRefused(const TrackResult& result, Reason why)
{
  EXPECT_FALSE(result.tracked);
  EXPECT_EQ(result.reason, why) << toString(result);
}

void expectAt(const TrackResult& result, const cv::Point& truth, double tolerance_px)
{
  EXPECT_TRUE(result.tracked) << "frame " << result.frame << ": " << toString(result);
  EXPECT_LT(centreError(result, truth.x, truth.y), tolerance_px) << "frame " << result.frame;
}

TEST(EyeSlamTracker, RefusesPicturesOfAnotherSizeAndLosesNothing)
{
  EyeSlamTracker tracker;
  for (int frame = 0; frame < 8; ++frame) tracker.track(view(drift(frame), frame));
  const retina::Pose2 last = tracker.getPose();
  const cv::Mat picture = view(drift(8), 8);
  cv::Mat grey;
  cv::extractChannel(picture, grey, 1);
  const cv::Mat others[] = {cv::Mat(), picture(cv::Rect(0, 0, 318, 240)), picture(cv::Rect(0, 0, 10, 10)), grey};
  for (const cv::Mat& other : others) {
    expectRefused(tracker.track(other), Reason::wrong_size);
    EXPECT_EQ(tracker.getPose().x, last.x);
    EXPECT_EQ(tracker.getPose().y, last.y);
  }
  for (int frame = 8; frame < 12; ++frame)
    expectAt(tracker.track(view(drift(frame), frame)), drift(frame), kSubPixel_px);
}

TEST(EyeSlamTracker, WaitsForTheFirstPictureThatIsLargeEnough)
{
  EyeSlamTracker tracker;
  expectRefused(tracker.track(cv::Mat()), Reason::wrong_size);
  expectRefused(tracker.track(cv::Mat(20, 20, CV_8UC3, cv::Scalar(30, 80, 180))), Reason::wrong_size);
  expectRefused(tracker.track(cv::Mat(30, 400, CV_8UC3, cv::Scalar(30, 80, 180))), Reason::wrong_size);
  expectRefused(tracker.track(cv::Mat(240, 320, CV_32FC3, cv::Scalar(0.1, 0.3, 0.7))), Reason::wrong_size);
  expectAt(tracker.track(view({0, 0}, 0)), {0, 0}, 1e-9);
  expectAt(tracker.track(view({3, 1}, 1)), {3, 1}, kSubPixel_px);
}

TEST(EyeSlamTracker, StartsWithTheFirstFrameThatShowsARetina)
{
  EyeSlamTracker tracker;
  for (int frame = 0; frame < 6; ++frame) expectRefused(tracker.track(kDark), Reason::blackout);
  EXPECT_TRUE(tracker.getVesselMap().empty());
  const cv::Point start = drift(6);
  for (int frame = 6; frame < 12; ++frame) {
    expectAt(tracker.track(view(drift(frame), frame)), drift(frame) - start, kSubPixel_px);
    EXPECT_EQ(tracker.getResult().frame, frame);
  }
}

// The map's frame stays frame 0 at mid-exposure, although the map itself starts from a sharp frame.
TEST(EyeSlamTracker, StartsInASaccadeAndKeepsFrameZero)
{
  for (const cv::Point smear : {cv::Point(24, 8), cv::Point(-40, 12), cv::Point(5, 60)}) {
    SCOPED_TRACE(smear);
    EyeSlamTracker tracker;
    tracker.track(smallRetina().smeared(kSmall, {0, 0}, smear, 0));
    const cv::Point stop = 2 * smear;
    double error = 0.0;
    for (int frame = 1; frame < 40; ++frame) {
      const cv::Point truth = stop + cv::Point(frame, 0);
      const TrackResult& result = tracker.track(view(truth, frame));
      ASSERT_TRUE(result.tracked) << frame << ": " << toString(result);
      error = centreError(result, truth.x, truth.y);
    }
    // Where the middle of a smear lies is known to a small part of it only.
    EXPECT_LT(error, 0.05 * cv::norm(smear) + kSubPixel_px);
  }
}

TEST(EyeSlamTracker, NeverTracksTheDarkAndIsBackInTheFirstVisibleFrame)
{
  EyeSlamTracker tracker;
  int frame = 0;
  for (; frame < 20; ++frame) tracker.track(view(drift(frame), frame));
  // The eye moves on meanwhile: by nothing, by a jerk, by a large part of the view.
  for (const cv::Point jump : {cv::Point(0, 0), cv::Point(-60, 30), cv::Point(20, 70), cv::Point(-100, 0)}) {
    SCOPED_TRACE(jump);
    for (int dark = 0; dark < 15; ++dark) expectRefused(tracker.track(kDark), Reason::blackout);
    expectAt(tracker.track(view(jump, ++frame)), jump, 2.0 * kSubPixel_px);
    expectAt(tracker.track(view(jump, ++frame)), jump, kSubPixel_px);
  }
}

// Its vessels fit elsewhere as well, in every frame alike; what lies between them does not.
TEST(EyeSlamTracker, ComesBackWhereTheVesselsAloneFitAtSeveralPlaces)
{
  for (const cv::Point jump : {cv::Point(20, 100), cv::Point(30, 110), cv::Point(20, 90)}) {
    SCOPED_TRACE(jump);
    EyeSlamTracker tracker;
    int frame = 0;
    for (; frame < 20; ++frame) tracker.track(view(drift(frame), frame));
    for (int dark = 0; dark < 15; ++dark) tracker.track(kDark);
    const int last = frame + 12;
    while (frame < last && !tracker.track(view(jump, frame)).tracked) ++frame;
    expectAt(tracker.getResult(), jump, 2.0 * kSubPixel_px);
  }
}

// The same retina twice, side by side: no picture of it tells which of the two is seen.
TEST(EyeSlamTracker, TakesNoneOfTwoPlacesThatAreTheSame)
{
  constexpr int kPeriod = 640;
  cv::Mat twice;
  const cv::Mat once = smallRetina().view({kPeriod, kSmall.height + 60}, {0, 0}, 0);
  cv::hconcat(once, once, twice);
  const auto at = [&](int x, int y) { return twice(cv::Rect(x, y, kSmall.width, kSmall.height)).clone(); };
  EyeSlamTracker tracker;
  for (int x = 0; x <= 2 * kPeriod - kSmall.width; x += 8) ASSERT_TRUE(tracker.track(at(x, 0)).tracked) << x;
  for (int dark = 0; dark < 15; ++dark) tracker.track(kDark);
  for (int frame = 0; frame < 30; ++frame) EXPECT_FALSE(tracker.track(at(60, 40)).tracked) << frame;
}

struct Nothing {
  std::string name;
  cv::Scalar colour;
  double noise;
  double blur_px = 0.0;
};
void PrintTo(const Nothing& nothing, std::ostream* out) { *out << nothing.name; }

cv::Mat pictureOf(const Nothing& nothing, unsigned seed)
{
  cv::RNG random(seed + 1);
  cv::Mat picture(kSmall, CV_8UC3);
  if (nothing.noise > 0.0)
    random.fill(picture, cv::RNG::NORMAL, nothing.colour,
                cv::Scalar::all(nothing.noise * (1.0 + 3.5 * nothing.blur_px)));
  else
    picture.setTo(nothing.colour);
  if (nothing.blur_px > 0.0) cv::GaussianBlur(picture, picture, {}, nothing.blur_px);
  return picture;
}

const Nothing kBlack{"black", cv::Scalar::all(0.0), 0.0};
const Nothing kWhite{"white", cv::Scalar::all(255.0), 0.0};
const Nothing kNoise{"noise", cv::Scalar::all(128.0), 60.0};
const Nothing kRedNoise{"noise in a retina's colour", cv::Scalar(30.0, 70.0, 170.0), 25.0};
const Nothing kSoftNoise{"the same through a lens out of focus", cv::Scalar(30.0, 70.0, 170.0), 8.0, 1.5};
const Nothing kSofterNoise{"farther out of focus", cv::Scalar(30.0, 70.0, 170.0), 8.0, 3.0};

class NothingToSee : public testing::TestWithParam<Nothing> {};
class NothingThatFits : public testing::TestWithParam<Nothing> {};

TEST_P(NothingToSee, IsNeverTrackedAndGivesNoMap)
{
  EyeSlamTracker tracker;
  for (int frame = 0; frame < 20; ++frame) {
    const TrackResult& result = tracker.track(pictureOf(GetParam(), static_cast<unsigned>(frame)));
    tracker.updateMap();
    EXPECT_FALSE(result.tracked) << frame;
    EXPECT_NE(result.reason, Reason::none) << frame;
    EXPECT_EQ(result.map_T_frame.x, 0.0);
  }
  tracker.finishMap();
  EXPECT_TRUE(vesselPoints(tracker.getVesselMap()).empty());
}

// A map that was there stays as it was, however long nothing fits.
TEST_P(NothingThatFits, NeverErasesTheMap)
{
  EyeSlamTracker tracker;
  for (int frame = 0; frame < 20; ++frame) tracker.track(view(drift(frame), frame));
  for (int frame = 20; frame < 80; ++frame) {
    EXPECT_FALSE(tracker.track(pictureOf(GetParam(), static_cast<unsigned>(frame))).tracked) << frame;
  }
  int frame = 80;
  const cv::Point back(15, 10);
  // Frames that nothing fits need the search of the whole map, which takes a few frames.
  while (frame < 90 && !tracker.track(view(back, frame)).tracked) ++frame;
  expectAt(tracker.getResult(), back, 2.0 * kSubPixel_px);
}

INSTANTIATE_TEST_SUITE_P(Pictures, NothingToSee,
                         testing::Values(kBlack, kWhite, kNoise, kRedNoise, kSoftNoise, kSofterNoise));
INSTANTIATE_TEST_SUITE_P(Pictures, NothingThatFits, testing::Values(kBlack, kWhite, kNoise, kRedNoise));

TEST(EyeSlamTracker, KeepsItsMapWhileAnotherRetinaIsShown)
{
  const support::MovingRetina other(13.0, 8);
  EyeSlamTracker tracker;
  for (int frame = 0; frame < 20; ++frame) tracker.track(view(drift(frame), frame));
  int wrong = 0;
  for (int frame = 20; frame < 60; ++frame)
    wrong += tracker.track(other.view(kSmall, drift(frame), static_cast<unsigned>(frame))).tracked;
  EXPECT_EQ(wrong, 0);
  int frame = 60;
  while (frame < 70 && !tracker.track(view({10, 5}, frame)).tracked) ++frame;
  expectAt(tracker.getResult(), {10, 5}, 2.0 * kSubPixel_px);
}

/// Draws what hides the retina and stands still while the retina moves.
using Painter = void (*)(cv::Mat& picture, int frame);

void bloom(cv::Mat& picture, int)
{
  for (const cv::Point at : {cv::Point(90, 80), cv::Point(200, 150)}) {
    cv::circle(picture, at, 22, cv::Scalar(220, 225, 235), cv::FILLED, cv::LINE_AA);
    cv::circle(picture, at, 18, cv::Scalar::all(255), cv::FILLED, cv::LINE_AA);
  }
}

void instrument(cv::Mat& picture, int)
{
  cv::line(picture, {316, 236}, {170, 130}, cv::Scalar(110, 115, 118), 22, cv::LINE_AA);
  cv::line(picture, {316, 232}, {171, 127}, cv::Scalar(170, 172, 175), 7, cv::LINE_AA);
}

// Burns belong to the retina, but not to the map as it was.
void burns(cv::Mat& picture, int frame)
{
  for (int n = 0; n < frame / 8; ++n) {
    const cv::Point at = cv::Point(60 + 45 * n, 70 + 25 * (n % 3)) - drift(frame);
    cv::circle(picture, at, 5, cv::Scalar(190, 215, 240), cv::FILLED, cv::LINE_AA);
  }
}

class Disturbance : public testing::TestWithParam<Painter> {};

TEST_P(Disturbance, DoesNotPullThePose)
{
  EyeSlamTracker tracker;
  double sum = 0.0;
  for (int frame = 0; frame < 40; ++frame) {
    cv::Mat picture = view(drift(frame), frame);
    GetParam()(picture, frame);
    const TrackResult& result = tracker.track(picture);
    ASSERT_TRUE(result.tracked) << frame << ": " << toString(result);
    const double error = centreError(result, drift(frame).x, drift(frame).y);
    EXPECT_LT(error, 2.0 * kSubPixel_px) << frame;
    sum += error * error;
  }
  EXPECT_LT(std::sqrt(sum / 40.0), kSubPixel_px);
}

INSTANTIATE_TEST_SUITE_P(BloomInstrumentBurns, Disturbance, testing::Values(&bloom, &instrument, &burns));

}  // namespace
}  // namespace eyeslam::tracking
