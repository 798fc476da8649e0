// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/smear_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/analytic_retina.h"

namespace eyeslam::tracking {
namespace {

using retina::Pose2;
using support::AnalyticRetina;
using support::AnalyticView;
using support::distance;
using support::MappedRetina;

const cv::Size kSize(240, 184), kMapped(400, 304);

Refinement refined(const MappedRetina& scene, const AnalyticView& view, const Pose2& start,
                   const Eigen::Vector2d& motion)
{
  SmearModel model({}, {});
  return model.refine(scene.mosaic, view.picture(), scene.pixelsIn(view, start), start, motion, Freedom::rigid, 1.0);
}

TEST(SmearModel, FindsTheMiddleOfASmearedExposure)
{
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const MappedRetina scene(AnalyticRetina(seed), kMapped);
    for (const double length_px : {10.0, 20.0, 30.0, 40.0}) {
      const double angle = 0.7 * seed + 0.05 * length_px;
      const Eigen::Vector2d extent = length_px * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      const Pose2 truth{6.3, -4.8, 0.02};
      AnalyticView view = scene.retina.smeared(truth, kSize, extent);
      view.addNoise(0.005, seed);
      const Refinement found = refined(scene, view, {truth.x + 1.2, truth.y - 0.9, truth.theta + 0.003}, extent);
      ASSERT_TRUE(found.valid) << length_px;
      EXPECT_LT(distance(found.map_T_frame, truth), 0.2) << seed << " " << length_px;
      EXPECT_LT(std::abs(found.map_T_frame.theta - truth.theta), 0.002) << seed << " " << length_px;
      EXPECT_GT(found.ncc, 0.9) << seed << " " << length_px;
    }
  }
}

TEST(SmearModel, FindsWhichShareOfTheMotionFellIntoTheExposure)
{
  const MappedRetina scene(AnalyticRetina(5), kMapped);
  const Eigen::Vector2d extent(18.0, 9.0);
  const Pose2 truth{-3.3, 2.1, -0.01};
  const AnalyticView view = scene.retina.smeared(truth, kSize, extent);
  for (const double share : {0.35, 0.6, 0.9, 1.4, 1.9}) {
    const Refinement found = refined(scene, view, {truth.x + 1.0, truth.y + 1.0, truth.theta}, extent / share);
    ASSERT_TRUE(found.valid) << share;
    EXPECT_LT(distance(found.map_T_frame, truth), 0.2) << share;
    EXPECT_GT(found.ncc, 0.97) << share;
  }
}

TEST(SmearModel, FitsASmearedViewBetterThanASharpTemplate)
{
  const MappedRetina scene(AnalyticRetina(6), kMapped);
  const Eigen::Vector2d extent(20.0, -15.0);
  const AnalyticView view = scene.retina.smeared({}, kSize, extent);
  const Refinement sharp = Refiner().refine(view.contrast, scene.pixelsIn(view, {}), {}, Freedom::rigid);
  const Refinement smeared = refined(scene, view, {}, extent);
  EXPECT_GT(smeared.ncc, sharp.ncc + 0.05);
  EXPECT_LT(smeared.sigma, 0.5 * sharp.sigma);
}

TEST(SmearModel, IsNotLedAstrayByGroundNeverSeen)
{
  // The mosaic is no larger than the frame, so that a third of what the smear sweeps over was never seen.
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const MappedRetina scene(AnalyticRetina(seed + 20), kSize);
    const Eigen::Vector2d extent(40.0, 0.0);
    const Pose2 truth{50.0, 20.0};
    const AnalyticView view = scene.retina.smeared(truth, kSize, extent);
    const Refinement found = refined(scene, view, {truth.x - 1.0, truth.y + 1.0}, extent);
    ASSERT_TRUE(found.valid);
    EXPECT_LT(distance(found.map_T_frame, truth), 0.2) << seed;
    EXPECT_GT(found.ncc, 0.97) << seed;
  }
}

TEST(SmearModel, GivesNothingWhereNothingIsMapped)
{
  const MappedRetina scene(AnalyticRetina(7), kSize);
  const Pose2 away{1000.0, 0.0};
  EXPECT_FALSE(refined(scene, scene.retina.view(away, kSize), away, {20.0, 0.0}).valid);
}

}  // namespace
}  // namespace eyeslam::tracking
