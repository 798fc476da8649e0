// SPDX-License-Identifier: GPL-3.0-or-later
// The whole chain in lock step: rendered frames, the real tracker, a calibration, the servo, the simulated hardware.
// All seeds and cameras: eyeslam-bench loop --rendered.
#include "eyeslam/trials/rendered_trial.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "eyeslam/trials/error_figures.h"

namespace eyeslam::trials {
namespace {

constexpr double kMicro = 1e-6;

RenderedTrialSetting shortTrial(const std::string& motion = "in_situ")
{
  RenderedTrialSetting setting = renderedSetting(motion, "30/20", "human");
  setting.settling_s = 3.0;
  setting.duration_s = 3.0;
  return setting;
}

RenderedTrialSetting smallTrial()
{
  RenderedTrialSetting setting = shortTrial();
  setting.hardware.camera.width = 400;
  setting.hardware.camera.height = 304;
  setting.servo.image_width_px = 400.0;
  setting.servo.image_height_px = 304.0;
  setting.vision.tracker.frame.scale = 1.0;
  return setting;
}

TEST(RenderedTrial, HoldsAPointBetterThanTheBareHandByFarAndNeverStops)
{
  RenderedTrialSetting setting = shortTrial();
  const RenderedResult held = holdOnRenderedFrames(setting, 3);
  const ErrorFigures tip = errorFigures(held.errors_m);
  EXPECT_GT(held.errors_m.size(), 2900U);
  EXPECT_TRUE(held.obstacles.empty());
  EXPECT_TRUE(held.plane_swept) << "the aiming beam was not seen";
  EXPECT_LT(tip.rms, 20 * kMicro);
  EXPECT_LT(tip.p95, 33 * kMicro);
  EXPECT_LT(held.highest_tip_speed, 30e-3);
  EXPECT_LT(held.worst_pivot_error, 100 * kMicro);
  EXPECT_EQ(held.tracked, held.frames);

  setting.aided = false;
  EXPECT_GT(errorFigures(holdOnRenderedFrames(setting, 3).errors_m).rms, 100 * kMicro);
}

TEST(RenderedTrial, IsTheSameToTheBitForTheSameSeed)
{
  const RenderedTrialSetting setting = smallTrial();
  const RenderedResult first = holdOnRenderedFrames(setting, 5), second = holdOnRenderedFrames(setting, 5);
  ASSERT_FALSE(first.errors_m.empty());
  EXPECT_EQ(first.errors_m, second.errors_m);
  EXPECT_EQ(first.pose_errors_m, second.pose_errors_m);
}

TEST(RenderedTrial, RefusesAnUnknownCamera)
{
  EXPECT_THROW(renderedSetting("in_situ", "25/20", "human"), std::invalid_argument);
  EXPECT_THROW(renderedSetting("waltz", "30/20", "human"), std::invalid_argument);
}

}  // namespace
}  // namespace eyeslam::trials
