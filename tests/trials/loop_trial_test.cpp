// SPDX-License-Identifier: GPL-3.0-or-later
// The loop's bounds (issue 16) on a few seeds; all twenty: eyeslam-bench loop.
#include "eyeslam/trials/loop_trial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "eyeslam/trials/loop_conditions.h"
#include "eyeslam/trials/trace_task.h"
#include "support/sanitized.h"

namespace eyeslam::trials {
namespace {

constexpr int kSeeds = support::kSanitized ? 1 : 5;

ErrorFigures held(LoopTrialSetting setting)
{
  setting.duration_s = 10.0;
  std::vector<ErrorFigures> seeds;
  for (int seed = 0; seed < kSeeds; ++seed)
    seeds.push_back(
        errorFigures(runLoopTrial(setting, holdTask(workingPlace()), static_cast<std::uint64_t>(seed)).errors_m));
  return overSeeds(seeds).mean;
}

void expectWithin(const ErrorFigures& figures, double rms_um, double median_um, double p95_um)
{
  EXPECT_LT(1e6 * figures.rms, rms_um);
  EXPECT_LT(1e6 * figures.median, median_um);
  EXPECT_LT(1e6 * figures.p95, p95_um);
}

TEST(LoopTrial, HoldsInSituWithin20umOfASlowCamera) { expectWithin(held(loopSetting("in_situ", "30/20")), 20, 15, 33); }

TEST(LoopTrial, HoldsInSituWithin16umOfAFastCameraAnd13WhereTheControllerSubtractsTheNull)
{
  LoopTrialSetting setting = loopSetting("in_situ", "120/5");
  expectWithin(held(setting), 16, 15, 27);
  setting.servo.null_at = "controller";
  expectWithin(held(setting), 13, 15, 23);
}

TEST(LoopTrial, HoldsWithin15umOfTruePosesAnd12WhereTheControllerSubtractsTheNull)
{
  LoopTrialSetting setting = loopSetting("in_situ", "true");
  expectWithin(held(setting), 15, 15, 27);
  setting.servo.null_at = "controller";
  expectWithin(held(setting), 12, 15, 23);
}

TEST(LoopTrial, EachPartLeftOutMakesItWorse)
{
  const double whole = held(loopSetting("in_situ", "30/20")).rms;
  for (const LeftOut& part : leftOut()) {
    if (part.part == "nothing" || part.part == "jump gate")
      continue;  // the gate's gain is outliers, rare in so few seconds
    LoopTrialSetting setting = loopSetting("in_situ", "30/20");
    part.leaveOut(setting);
    EXPECT_GT(held(setting).rms, 1.02 * whole) << part.part;
  }
}

TEST(LoopTrial, TheGateKeepsAnOutlierFromTheTip)
{
  LoopTrialSetting setting = loopSetting("in_situ", "120/5");
  setting.tracker.outliers = 0.003;
  setting.tracker.unflagged = 1.0;
  const double gated = held(setting).max;
  setting.servo.retina.gated = false;
  EXPECT_LT(2.0 * gated, held(setting).max);
}

TEST(LoopTrial, ComesBackAfterASaccadeInTime)
{
  for (const char* camera : {"30/20", "120/5"}) {
    LoopTrialSetting setting = loopSetting("saccade", camera);
    RecoveryCount count;
    for (int seed = 0; seed < kSeeds; ++seed)
      countRecoveries(recoveryTiming(setting),
                      runLoopTrial(setting, holdTask(workingPlace()), static_cast<std::uint64_t>(seed)).jumps, count);
    ASSERT_GT(count.jumps, kSeeds);
    EXPECT_GE(count.in_time, 0.95 * count.jumps) << camera;
    EXPECT_EQ(count.whole_in_time, count.whole) << camera;
  }
}

TEST(LoopTrial, AStepOfTheGoalOvershootsUnder2PercentAndIsOverIn10msMoreThanItsWayTakes)
{
  for (const double speed_mm_s : {10.0, 20.0, 30.0}) {
    for (const double step : {50e-6, 100e-6, 300e-6, 1e-3}) {
      const StepResponse response = stepResponse(step, speed_mm_s);
      EXPECT_LT(response.overshoot, 0.02) << step << " m at " << speed_mm_s;
      EXPECT_LT(response.late_s, 10e-3) << step << " m at " << speed_mm_s;
    }
  }
}

TEST(LoopTrial, TheTrimAndTheIntegralDoNotWindUpInASaccade)
{
  // Calm again: the error is what it is without saccades.
  LoopTrialSetting setting = loopSetting("saccade", "30/20");
  std::vector<double> calm;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const LoopResult result = runLoopTrial(setting, holdTask(workingPlace()), static_cast<std::uint64_t>(seed));
    for (std::size_t i = 0; i < result.errors_m.size(); ++i)
      if (result.calm[i]) calm.push_back(result.errors_m[i]);
  }
  EXPECT_LT(1e6 * errorFigures(calm).rms, 20.0);
}

ErrorFigures traced(LoopTrialSetting setting, double lambda)
{
  setting.duration_s = 15.0;  // the vessel there and back
  std::vector<ErrorFigures> seeds;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed)
    seeds.push_back(errorFigures(runLoopTrial(setting, traceTask(seed, lambda), seed).errors_m));
  return overSeeds(seeds).mean;
}

// Bounds of the loop study, section 6.
TEST(LoopTrial, TracesAVesselHardWithin16umOfASlowCameraAnd12OfAFastOneAndSoftWithin30)
{
  expectWithin(traced(loopSetting("in_situ", "30/20"), 0.0), 16, 10, 28);
  expectWithin(traced(loopSetting("in_situ", "120/5"), 0.0), 12, 10, 28);
  EXPECT_LT(1e6 * traced(loopSetting("in_situ", "30/20"), 0.1).rms, support::kSanitized ? 40.0 : 30.0)
      << "one seed scatters by a quarter";
}

TEST(LoopTrial, IsTheSameToTheBitEachTime)
{
  LoopTrialSetting setting = loopSetting("jerky", "30/20");
  setting.duration_s = 2.0;
  EXPECT_EQ(runLoopTrial(setting, holdTask(workingPlace()), 3).errors_m,
            runLoopTrial(setting, holdTask(workingPlace()), 3).errors_m);
}

TEST(LoopTrial, TheGoalKeepsItsSpeedLimitInSaccades)
{
  EXPECT_LE(runLoopTrial(loopSetting("saccade", "30/20"), holdTask(workingPlace()), 1).highest_goal_speed,
            20e-3 * 1.000001);
}

TEST(LoopTrial, AnUnknownConditionIsRefusedByName)
{
  EXPECT_THROW(loopSetting("in_situ", "60/10"), std::invalid_argument);
  EXPECT_THROW(loopSetting("calm", "30/20"), std::invalid_argument);
}

TEST(ErrorFigures, AreWhatTheirNamesSay)
{
  std::vector<double> errors;
  for (int i = 0; i <= 100; ++i) errors.push_back(i);
  const ErrorFigures figures = errorFigures(errors);
  EXPECT_EQ(figures.median, 50.0);
  EXPECT_EQ(figures.p95, 95.0);
  EXPECT_EQ(figures.max, 100.0);
  EXPECT_NEAR(figures.rms, std::sqrt(100.0 * 201.0 / 6.0), 1e-9);  // sum of squares 0..100 over 101
}

}  // namespace
}  // namespace eyeslam::trials
