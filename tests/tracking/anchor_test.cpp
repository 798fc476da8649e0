// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/anchor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/analytic_retina.h"

namespace eyeslam::tracking {
namespace {

using retina::Pose2;
using support::AnalyticRetina;
using support::AnalyticView;
using support::distance;

const cv::Size kSize(240, 184);
constexpr double kNoise = 0.01;

Anchor makeAnchor() { return {{}, {}, {}, {}}; }

AnalyticView noisy(AnalyticView view, unsigned seed, double noise = kNoise)
{
  view.addNoise(noise, seed);
  return view;
}

// What the tracker does with frames whose poses in the mosaic are all off by the same `offset`: the errors of the first
// frames as they are baked in.
class OffsetRun {
 public:
  OffsetRun(unsigned seed, const Pose2& offset, double noise) : retina_(seed), offset_(offset), noise_(noise)
  {
    const AnalyticView first = noisy(retina_.view({}, kSize), 1000, noise_);
    anchor.start(first.picture());
    mosaic.start(first.picture());
  }

  void advance(int frames)
  {
    for (int i = 0; i < frames; ++i) {
      ++number_;
      const Pose2 truth{4.0 * std::sin(0.9 * number_), 3.0 * std::cos(0.7 * number_), 0.01 * std::sin(0.5 * number_)};
      const AnalyticView view = noisy(retina_.view(truth, kSize), static_cast<unsigned>(number_), noise_);
      mosaic.blend(view.picture(), offset_ * truth, std::max(noise_, 0.002) * Frame::kContrastUnit, number_);
      const Pose2 before = anchor.mosaic_T_start();
      anchor.update(mosaic, number_);
      longest_step_px = std::max(longest_step_px, distance(anchor.mosaic_T_start(), before));
    }
  }

  Anchor anchor = makeAnchor();
  Mosaic mosaic;
  double longest_step_px = 0.0;

 private:
  AnalyticRetina retina_;
  Pose2 offset_;
  double noise_;
  int number_ = 0;
};

TEST(Anchor, CorrectsAnOffsetThatTheFirstFramesBakedIn)
{
  const Pose2 offset{0.3, -0.2, 0.001};
  for (unsigned seed = 1; seed <= 2; ++seed) {
    OffsetRun run(seed, offset, 0.0);
    run.advance(23);
    EXPECT_EQ(distance(run.anchor.mosaic_T_start(), {}), 0.0);  // frame 24 is the first turn
    run.advance(60);
    // Frame 0's own share, a quarter of the mosaic at first, would pull by 0.09 px if it were not taken out.
    EXPECT_LT(distance(run.anchor.mosaic_T_start(), offset), 0.01) << seed;
    EXPECT_LT(std::abs(run.anchor.mosaic_T_start().theta - offset.theta), 5e-5) << seed;
  }
}

TEST(Anchor, CorrectsMostOfAnOffsetUnderNoise)
{
  // Frame 0's noise is in the gradients of the mosaic as well and holds it back a little.
  const Pose2 offset{0.3, -0.2, 0.001};
  for (unsigned seed = 1; seed <= 2; ++seed) {
    OffsetRun run(seed, offset, kNoise);
    run.advance(83);
    EXPECT_LT(distance(run.anchor.mosaic_T_start(), offset), 0.3 * offset.translation().norm()) << seed;
  }
}

TEST(Anchor, SpreadsItsCorrectionSoThatNobodySeesAStep)
{
  const Pose2 offset{0.3, -0.2, 0.0};
  OffsetRun run(4, offset, 0.0);
  run.advance(60);
  EXPECT_GT(run.longest_step_px, 0.0);
  EXPECT_LT(run.longest_step_px, (offset.translation().norm() + 0.01) / 8.0);
}

TEST(Anchor, StaysWhereFramesAreRight)
{
  OffsetRun run(5, {}, kNoise);
  run.advance(60);
  EXPECT_LT(distance(run.anchor.mosaic_T_start(), {}), 0.03);
}

TEST(Anchor, CallsASharpFrameABetterStartThanASmearedOne)
{
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const AnalyticRetina retina(seed);
    Anchor anchor = makeAnchor();
    anchor.start(retina.smeared({}, kSize, {16.0, 6.0}).picture());
    const AnalyticView sharp = retina.view({20.0, 7.5}, kSize);
    EXPECT_TRUE(anchor.isBetterStart(sharp.picture(), 1)) << seed;
    EXPECT_TRUE(anchor.isBetterStart(sharp.picture(), 4)) << seed;
    EXPECT_FALSE(anchor.isBetterStart(sharp.picture(), 5)) << seed;  // too late to start again
  }
}

// Every start anew forgets what was seen: a frame as sharp as the one started from is no reason.
TEST(Anchor, StartsAgainOnceForFramesAsSharpAsTheOneItStartedFrom)
{
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const AnalyticRetina retina(seed);
    Anchor anchor = makeAnchor();
    anchor.start(noisy(retina.smeared({}, kSize, {16.0, 6.0}), seed).picture());
    const auto frame = [&](int number) { return noisy(retina.view({20.0 + number, 7.5}, kSize), seed + number); };
    Mosaic mosaic;
    const AnalyticView first = frame(1);
    ASSERT_TRUE(anchor.isBetterStart(first.picture(), 1));
    mosaic.start(first.picture());
    anchor.startAgain(first.picture(), mosaic, 1);
    for (int number = 2; number <= 4; ++number)
      EXPECT_FALSE(anchor.isBetterStart(frame(number).picture(), number)) << seed << " frame " << number;
  }
}

TEST(Anchor, StartsAgainFromASharpFrameAlsoWhenOneLessSmearedCameBefore)
{
  const AnalyticRetina retina(2);
  Anchor anchor = makeAnchor();
  anchor.start(noisy(retina.smeared({}, kSize, {24.0, 6.0}), 1).picture());
  const AnalyticView less = noisy(retina.smeared({20.0, 5.0}, kSize, {10.0, 3.0}), 2);
  const AnalyticView sharp = noisy(retina.view({30.0, 8.0}, kSize), 3);
  ASSERT_TRUE(anchor.isBetterStart(less.picture(), 1));
  Mosaic mosaic;
  mosaic.start(less.picture());
  anchor.startAgain(less.picture(), mosaic, 1);
  EXPECT_TRUE(anchor.isBetterStart(sharp.picture(), 2));
}

TEST(Anchor, KeepsAStartThatIsAsSharpAsTheFramesAfterIt)
{
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const AnalyticRetina retina(seed);
    Anchor anchor = makeAnchor();
    anchor.start(noisy(retina.view({}, kSize), 1).picture());
    EXPECT_FALSE(anchor.isBetterStart(noisy(retina.view({10.0, 5.0, 0.05}, kSize), 2).picture(), 1));
    EXPECT_FALSE(anchor.isBetterStart(noisy(retina.smeared({}, kSize, {16.0, 6.0}), 3).picture(), 1));
  }
}

TEST(Anchor, FindsASmearedFrame0InTheMosaicOfASharperFrame)
{
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const AnalyticRetina retina(seed);
    for (const Eigen::Vector2d& motion : {Eigen::Vector2d(20.0, -8.0), Eigen::Vector2d(-12.0, 25.0)}) {
      Anchor anchor = makeAnchor();
      anchor.start(noisy(retina.smeared({}, kSize, 0.8 * motion), 1).picture());
      Mosaic mosaic;
      const AnalyticView sharp = noisy(retina.view({motion.x(), motion.y()}, kSize), 2);
      mosaic.start(sharp.picture());
      anchor.startAgain(sharp.picture(), mosaic, 1);
      EXPECT_LT(distance(anchor.mosaic_T_start(), {-motion.x(), -motion.y()}), 0.3) << seed;
    }
  }
}

TEST(Anchor, AssumesThatTheViewStoodStillWhereFrame0ShowsNothing)
{
  const AnalyticRetina retina(6);
  AnalyticView flat = retina.view({}, kSize);
  flat.contrast.setTo(0);
  Anchor anchor = makeAnchor();
  anchor.start(flat.picture());
  Mosaic mosaic;
  const AnalyticView other = retina.view({20.0, 0.0}, kSize);
  mosaic.start(other.picture());
  anchor.startAgain(other.picture(), mosaic, 1);
  EXPECT_EQ(distance(anchor.mosaic_T_start(), {}), 0.0);
}

TEST(Anchor, KeepsItsPlaceWhereTheMosaicShowsAnotherRetina)
{
  const AnalyticRetina retina(7), other(70);
  Anchor anchor = makeAnchor();
  anchor.start(retina.view({}, kSize).picture());
  Mosaic mosaic;
  mosaic.start(other.view({}, kSize).picture());
  for (int number = 1; number < 60; ++number) anchor.update(mosaic, number);
  EXPECT_EQ(distance(anchor.mosaic_T_start(), {}), 0.0);
}

TEST(Anchor, RestoresTheMosaicOfFrame0OnlyBeforeItsFirstTurn)
{
  const auto meanAt = [](const Mosaic& mosaic, const cv::Rect& part) {
    cv::Mat_<std::int16_t> mean;
    cv::Mat_<std::uint8_t> count;
    mosaic.read(part, mean, count);
    return mean;
  };
  const cv::Rect part(50, 50, 200, 140);
  OffsetRun run(8, {2.0, 0.0}, 0.0);
  const cv::Mat first = meanAt(run.mosaic, part);
  run.advance(16);
  ASSERT_GT(cv::norm(meanAt(run.mosaic, part), first), 0.0);
  run.anchor.restore(run.mosaic);
  EXPECT_EQ(cv::norm(meanAt(run.mosaic, part), first), 0.0);
  run.advance(16);
  const cv::Mat later = meanAt(run.mosaic, part);
  run.anchor.restore(run.mosaic);
  EXPECT_EQ(cv::norm(meanAt(run.mosaic, part), later), 0.0);
}

}  // namespace
}  // namespace eyeslam::tracking
