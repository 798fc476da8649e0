// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/frame_times.h"

#include <gtest/gtest.h>

#include <rapidcheck/gtest.h>
#include <cmath>
#include <limits>

namespace eyeslam::files {
namespace {

constexpr double kRounding_s = 1e-9;

TEST(FrameTimes, StartsAtZeroWhereverTheContainerDoes)
{
  FrameTimes times(30.0);
  EXPECT_EQ(times.next(67.0), 0.0);
  EXPECT_NEAR(times.next(100.0), 0.033, kRounding_s);
}

TEST(FrameTimes, FollowsAVariableRate)
{
  FrameTimes times(30.0);
  times.next(0.0);
  EXPECT_NEAR(times.next(20.0), 0.020, kRounding_s);
  EXPECT_NEAR(times.next(120.0), 0.120, kRounding_s);
}

TEST(FrameTimes, ContinuesAtTheNominalRateWhereThePositionFallsBackToZero)
{
  FrameTimes times(25.0);
  times.next(0.0);
  times.next(40.0);
  EXPECT_NEAR(times.next(0.0), 0.080, kRounding_s);
  EXPECT_NEAR(times.next(0.0), 0.120, kRounding_s);
}

TEST(FrameTimes, TakesThirtyFramesASecondWhereTheContainerKnowsNone)
{
  for (const double rate : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    FrameTimes times(rate);
    times.next(0.0);
    EXPECT_NEAR(times.next(0.0), 1.0 / 30.0, kRounding_s);
  }
}

RC_GTEST_PROP(FrameTimes, AlwaysIncreases, (std::vector<double> positions))
{
  FrameTimes times(30.0);
  double before = -1.0;
  for (const double position : positions) {
    const double time = times.next(std::fmod(position, 1e6));
    RC_ASSERT(time > before);
    before = time;
  }
}

}  // namespace
}  // namespace eyeslam::files
