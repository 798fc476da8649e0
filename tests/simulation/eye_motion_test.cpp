// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/eye_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace eyeslam::simulation {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;

EyeMotion motionOf(const char* name, std::uint64_t seed = 5) { return {eyeMotionOptions(name), 1.0, 12.0, seed}; }

// The longest way between two instants `step_s` apart.
double longestStep(const EyeMotion& motion, double step_s)
{
  double longest = 0.0;
  for (double t = 0.0; t < 12.0; t += step_s) {
    longest = std::max(longest, (motion.at(t + step_s).translation() - motion.at(t).translation()).norm());
  }
  return longest;
}

TEST(EyeMotion, StartsAtTheIdentityWhateverItsKind)
{
  for (const char* name : eyeMotionNames()) {
    const retina::Pose2 start = motionOf(name).at(0.0);
    EXPECT_EQ(start.x, 0.0) << name;
    EXPECT_EQ(start.y, 0.0) << name;
    EXPECT_EQ(start.theta, 0.0) << name;
    EXPECT_EQ(start.scale, 1.0) << name;
    for (const double coefficient : motionOf(name).warpAt(0.0)) EXPECT_EQ(coefficient, 0.0) << name;
  }
}

TEST(EyeMotion, HasNoStepsWithinAnExposure)
{
  // A saccade of 260 px lasts 36 ms at least; a minimum-jerk step is at most 1.875 times as fast as its mean.
  for (const char* name : eyeMotionNames())
    EXPECT_LT(longestStep(motionOf(name), 1e-4), 260.0 / 36e-3 * 1.9 * 1e-4 + 0.1) << name;
}

TEST(EyeMotion, JerksAndSaccadesReachTheirLengths)
{
  EXPECT_GT(longestStep(motionOf("saccade"), 2 * kFrame_s), 90.0);
  EXPECT_GT(longestStep(motionOf("jerky"), 4 * kFrame_s), 20.0);
  EXPECT_LT(longestStep(motionOf("smooth"), kFrame_s), 6.0);
}

TEST(EyeMotion, ExcursionsLeaveTheFirstViewAndReturn)
{
  const EyeMotion motion = motionOf("excursion");
  EXPECT_GT(motion.at(3.5).translation().norm(), 500.0);
  EXPECT_LT(motion.at(7.0).translation().norm(), 80.0);
}

TEST(EyeMotion, LengthsGrowWithThePixels)
{
  const EyeMotion once(eyeMotionOptions("jerky"), 1.0, 12.0, 3);
  const EyeMotion twice(eyeMotionOptions("jerky"), 2.0, 12.0, 3);
  for (double t = 0.0; t < 12.0; t += 0.37) EXPECT_NEAR(twice.at(t).x, 2.0 * once.at(t).x, 1e-9);
}

TEST(EyeMotion, NamesWhatIsKnownWhenAskedForAnotherMotion)
{
  try {
    eyeMotionOptions("wild");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("wild"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("in_situ"), std::string::npos);
  }
}

}  // namespace
}  // namespace eyeslam::simulation
