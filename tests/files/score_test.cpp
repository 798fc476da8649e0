// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

using eyeslam::files::EstimatedPose;
using eyeslam::files::percentile;
using eyeslam::files::poseError;
using eyeslam::files::PoseScore;
using eyeslam::files::scorePoses;
using eyeslam::files::TruthPose;

namespace {

std::vector<TruthPose> still(std::size_t frames) { return std::vector<TruthPose>(frames); }

std::vector<EstimatedPose> tracked(std::size_t frames)
{
  return std::vector<EstimatedPose>(frames, EstimatedPose{true, 0.0, 0.0, 0.0, 1.0});
}

TEST(Score, HalvesFullResolutionErrors)
{
  const auto error = poseError({0.0, 10.0, 20.0, 0.0, 1.0, true}, {true, 16.0, 12.0, 0.0, 0.0});
  EXPECT_DOUBLE_EQ(error.x_px, 3.0);
  EXPECT_DOUBLE_EQ(error.y_px, -4.0);
  EXPECT_DOUBLE_EQ(error.distance_px, 5.0);
}

TEST(Score, TakesAnglesTheShortWayRound)
{
  EXPECT_NEAR(poseError({0.0, 0.0, 0.0, 179.0, 1.0, true}, {true, 0.0, 0.0, -179.0, 0.0}).theta_deg, 2.0, 1e-12);
  EXPECT_NEAR(poseError({0.0, 0.0, 0.0, -179.0, 1.0, true}, {true, 0.0, 0.0, 179.0, 0.0}).theta_deg, -2.0, 1e-12);
}

TEST(Score, IsTheRootOfTheMeanSquareOverVisibleFrames)
{
  auto truth = still(3);
  auto estimate = tracked(3);
  estimate[0].x_px = 2.0;   // 1 half-resolution px
  estimate[1].x_px = 14.0;  // 7, over 5
  estimate[0].theta_deg = 3.0;
  estimate[1].theta_deg = 4.0;
  truth[2].visible = false;
  estimate[2].x_px = 1000.0;
  const PoseScore score = scorePoses(truth, estimate);
  EXPECT_EQ(score.visible, 2);
  EXPECT_DOUBLE_EQ(score.rms_px, 5.0);  // sqrt((1 + 49) / 2)
  EXPECT_DOUBLE_EQ(score.rms_deg, std::sqrt(12.5));
  EXPECT_DOUBLE_EQ(score.median_px, 4.0);
  EXPECT_DOUBLE_EQ(score.max_px, 7.0);
  EXPECT_DOUBLE_EQ(score.under_5_px, 0.5);
}

TEST(Score, ForgivesAConstantOffsetWhenItIsRemoved)
{
  auto estimate = tracked(5);
  for (EstimatedPose& pose : estimate) pose = {true, 3.0, -8.0, 0.5, 1.0};
  const PoseScore score = scorePoses(still(5), estimate);
  EXPECT_NEAR(score.rms_px, std::hypot(1.5, 4.0), 1e-12);
  EXPECT_NEAR(score.aligned_rms_px, 0.0, 1e-12);
  EXPECT_NEAR(score.aligned_rms_deg, 0.0, 1e-12);
}

TEST(Score, CountsFramesUntilAReturnedViewIsFollowed)
{
  auto truth = still(8);
  truth[1].visible = truth[4].visible = truth[6].visible = false;
  auto estimate = tracked(8);
  estimate[2].x_px = 30.0;                            // returns at 2, followed at 3
  estimate[7].x_px = 30.0;                            // returns at 7, never followed
  estimate[1].tracked = estimate[4].tracked = false;  // the third hidden frame is claimed
  const PoseScore score = scorePoses(truth, estimate);
  EXPECT_EQ(score.frames_to_return, (std::vector<int>{1, 0, -1}));
  EXPECT_DOUBLE_EQ(score.tracked_while_hidden, 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(score.tracked, 1.0);
}

TEST(Score, InterpolatesPercentilesBetweenNeighbours)
{
  EXPECT_DOUBLE_EQ(percentile({4.0, 1.0, 3.0, 2.0}, 50.0), 2.5);
  EXPECT_DOUBLE_EQ(percentile({0.0, 10.0}, 95.0), 9.5);
  EXPECT_DOUBLE_EQ(percentile({7.0}, 99.0), 7.0);
}

TEST(Score, RefusesWhatCannotBeScored)
{
  EXPECT_THROW(scorePoses(still(3), tracked(2)), std::invalid_argument);
  auto hidden = still(2);
  hidden[0].visible = hidden[1].visible = false;
  EXPECT_THROW(scorePoses(hidden, tracked(2)), std::invalid_argument);
  auto estimate = tracked(2);
  estimate[1].y_px = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(scorePoses(still(2), estimate), std::invalid_argument);
}

}  // namespace
