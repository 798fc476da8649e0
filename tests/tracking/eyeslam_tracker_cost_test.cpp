// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include "eyeslam/tracking/eyeslam_tracker.h"
#include "support/allocation_counter.h"
#include "support/moving_retina.h"

namespace eyeslam::tracking {
namespace {

using support::centreError;
using support::smallRetina;
using support::toString;

const cv::Size kSmall{320, 240};
constexpr int kPeriod = 60;  // frames of one round

/// A view that goes round in a circle, so that after one round nothing new comes into view.
cv::Point circle(int frame)
{
  const double angle = 2.0 * M_PI * frame / kPeriod;
  return {cvRound(30.0 * std::sin(angle)), cvRound(30.0 * (1.0 - std::cos(angle)))};
}

std::vector<cv::Mat> oneRound()
{
  std::vector<cv::Mat> views;
  for (int frame = 0; frame < kPeriod; ++frame) {
    views.push_back(smallRetina().view(kSmall, circle(frame), static_cast<unsigned>(frame)));
  }
  return views;
}

enum class Picture { colour, grey };

double threadCpu_ms()
{
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

class SteadyState : public testing::TestWithParam<Picture> {};

TEST_P(SteadyState, DoesNotAllocate)
{
  std::vector<cv::Mat> round = oneRound();
  if (GetParam() == Picture::grey) {
    for (cv::Mat& picture : round) cv::extractChannel(picture.clone(), picture, 1);
  }
  EyeSlamTracker tracker;
  for (int frame = 0; frame < 3 * kPeriod; ++frame) {
    ASSERT_TRUE(tracker.track(round[static_cast<std::size_t>(frame % kPeriod)]).tracked) << frame;
    tracker.updateMap();
  }
  for (int frame = 0; frame < 2 * kPeriod; ++frame) {
    const cv::Mat& picture = round[static_cast<std::size_t>(frame % kPeriod)];
    const std::int64_t before = support::allocations();
    tracker.track(picture);
    EXPECT_EQ(support::allocations(), before) << "frame " << frame;
    tracker.updateMap();
  }
}

INSTANTIATE_TEST_SUITE_P(ColourAndGrey, SteadyState, testing::Values(Picture::colour, Picture::grey));

TEST(EyeSlamTracker, HardlyAllocatesWhileLost)
{
  const std::vector<cv::Mat> round = oneRound();
  const support::MovingRetina other(13.0, 8);
  std::vector<cv::Mat> strange;
  for (int frame = 0; frame < 20; ++frame) strange.push_back(other.view(kSmall, {}, static_cast<unsigned>(frame)));
  EyeSlamTracker tracker;
  for (const cv::Mat& picture : round) tracker.track(picture);
  for (const cv::Mat& picture : strange) tracker.track(picture);
  int frames_that_allocate = 0;
  for (const cv::Mat& picture : strange) {
    const std::int64_t before = support::allocations();
    const bool tracked = tracker.track(picture).tracked;
    frames_that_allocate += support::allocations() != before;
    EXPECT_FALSE(tracked);
  }
  EXPECT_LE(frames_that_allocate, 2);  // a list of a search may still grow, once for all
}

std::size_t memoryInUse()
{
  const struct mallinfo2 heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

// The published map's slice included, which may allocate, but must give back what it takes.
TEST(EyeSlamTracker, TakesNoMoreMemoryWithTime)
{
  const std::vector<cv::Mat> round = oneRound();
  EyeSlamTracker tracker;
  const auto goRound = [&](int rounds) {
    for (int frame = 0; frame < rounds * kPeriod; ++frame) {
      tracker.track(round[static_cast<std::size_t>(frame % kPeriod)]);
      tracker.updateMap();
    }
    return memoryInUse();
  };
  const std::size_t early = goRound(5);
  const std::size_t late = goRound(10);
  constexpr std::size_t kFew_bytes = 4096;  // 600 frames that each kept a number would take more
  EXPECT_LE(late, early + kFew_bytes);
}

/// Moves a tracker over the retina, row by row, and back to the start.
void explore(EyeSlamTracker& tracker, double share)
{
  const cv::Size reach = smallRetina().reach(kSmall);
  const int width = static_cast<int>(share * reach.width), height = static_cast<int>(share * reach.height);
  constexpr int kStep = 10, kRow = 80;
  cv::Point at(0, 0);
  unsigned frame = 0;
  const auto go = [&](const cv::Point& to) {
    while (at != to) {
      const auto towards = [=](int from, int goal) { return from + std::clamp(goal - from, -kStep, kStep); };
      at = cv::Point(towards(at.x, to.x), towards(at.y, to.y));
      const TrackResult& result = tracker.track(smallRetina().view(kSmall, at, frame++));
      ASSERT_TRUE(result.tracked) << at << toString(result);
      ASSERT_LT(centreError(result, at.x, at.y), 2.0) << at;
    }
  };
  for (int y = -height; y <= height; y += kRow) {
    go({-width, y});
    go({width, y});
  }
  go({0, 0});
}

double medianRatio(std::vector<double> ratios)
{
  std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2), ratios.end());
  return ratios[ratios.size() / 2];
}

// A ratio within one run, of frames tracked in turns: what else the machine does meets both alike.
TEST(EyeSlamTracker, CostsTheSameWithALargeMap)
{
  const std::vector<cv::Mat> round = oneRound();
  EyeSlamTracker small, large;
  small.track(round[0]);
  large.track(round[0]);
  explore(large, 0.99);
  cv::Point2d origin;
  double px = 0.0;
  for (int warm = 0; warm < kPeriod; ++warm) {
    small.track(round[static_cast<std::size_t>(warm)]);
    large.track(round[static_cast<std::size_t>(warm)]);
  }
  const double growth =
      static_cast<double>(large.getMosaic(origin, px).total()) / static_cast<double>(kSmall.area() / 4);
  ASSERT_GT(growth, 7.0);
  std::vector<double> ratios;
  for (int frame = 0; frame < 6 * kPeriod; ++frame) {
    const cv::Mat& picture = round[static_cast<std::size_t>(frame % kPeriod)];
    const double start = threadCpu_ms();
    const bool in_small = small.track(picture).tracked;
    const double middle = threadCpu_ms();
    const bool in_large = large.track(picture).tracked;
    const double end = threadCpu_ms();
    ASSERT_TRUE(in_small && in_large) << frame;
    ratios.push_back((end - middle) / (middle - start));
  }
  const double ratio = medianRatio(ratios);
  RecordProperty("map_growth", std::to_string(growth));
  RecordProperty("cpu_ratio", std::to_string(ratio));
  EXPECT_LT(ratio, 1.25);  // 1.1 is what is demanded; a machine at work scatters by the rest
}

}  // namespace
}  // namespace eyeslam::tracking
