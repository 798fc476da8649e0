// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/refiner.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "support/analytic_retina.h"

namespace eyeslam::tracking {
namespace {

using retina::Pose2;
using support::AnalyticRetina;
using support::AnalyticView;
using support::distance;
using support::MappedRetina;

const cv::Size kSize(320, 240);
constexpr double kDegree = M_PI / 180.0;

class Poses {
 public:
  explicit Poses(unsigned seed) : random_(seed) {}
  // Within `reach` px and rad / 100 of another pose.
  Pose2 near(const Pose2& pose, double reach_px, double reach_rad)
  {
    return {pose.x + reach_px * share_(random_), pose.y + reach_px * share_(random_),
            pose.theta + reach_rad * share_(random_), pose.scale};
  }
  Pose2 any() { return near({}, 20.0, 0.1); }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> share_{-1.0, 1.0};
};

Refinement refined(const MappedRetina& scene, const AnalyticView& view, const Pose2& start,
                   Freedom freedom = Freedom::rigid)
{
  return Refiner().refine(view.contrast, scene.pixelsIn(view, start), start, freedom);
}

TEST(Refiner, FindsAnyPoseToAHundredthOfAPixelWithoutNoise)
{
  Poses poses(1);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const MappedRetina scene(AnalyticRetina(seed), kSize);
    for (int i = 0; i < 8; ++i) {
      const Pose2 truth = poses.any();
      const Refinement found = refined(scene, scene.retina.view(truth, kSize), poses.near(truth, 1.5, 0.004));
      ASSERT_TRUE(found.valid && found.settled);
      EXPECT_LT(distance(found.map_T_frame, truth), 0.01);
      EXPECT_LT(std::abs(found.map_T_frame.theta - truth.theta), 0.005 * kDegree);
      EXPECT_EQ(found.map_T_frame.scale, 1.0);
      EXPECT_GT(found.ncc, 0.999);
    }
  }
}

TEST(Refiner, RecoversTheScaleToATenThousandth)
{
  Poses poses(2);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const MappedRetina scene(AnalyticRetina(seed, 16.0), kSize);
    for (const double scale : {0.98, 0.995, 1.0, 1.005, 1.02}) {
      Pose2 truth = poses.any();
      truth.scale = scale;
      Pose2 start = poses.near(truth, 1.0, 0.004);
      start.scale = 1.0;
      const Refinement found = refined(scene, scene.retina.view(truth, kSize), start, Freedom::similarity);
      ASSERT_TRUE(found.valid && found.settled);
      EXPECT_NEAR(found.map_T_frame.scale, scale, 1e-4);
      EXPECT_LT(distance(found.map_T_frame, truth), 0.01);
      EXPECT_LT(std::abs(found.map_T_frame.theta - truth.theta), 0.005 * kDegree);
    }
  }
}

TEST(Refiner, HoldsTheScaleAsTightlyAsItsPriorSays)
{
  const MappedRetina scene(AnalyticRetina(3, 16.0), kSize);
  const Pose2 truth{3.0, -2.0, 0.01, 1.004};
  const Pose2 start{3.0, -2.0, 0.01, 1.0};
  AnalyticView view = scene.retina.view(truth, kSize);
  view.addNoise(0.02, 1);
  const auto scaleWith = [&](double sigma) {
    return Refiner()
        .refine(view.contrast, scene.pixelsIn(view, start), start, Freedom::similarity, sigma)
        .map_T_frame.scale;
  };
  EXPECT_NEAR(scaleWith(1e-7), 1.0, 1e-5);
  EXPECT_NEAR(scaleWith(1.0), 1.004, 5e-4);
}

// The error of (x, y, theta) measured in the covariance that was claimed; 3 on average when that is honest.
double normalisedSquaredError(const Refinement& found, const Pose2& truth)
{
  const Eigen::Vector3d error(found.map_T_frame.x - truth.x, found.map_T_frame.y - truth.y,
                              found.map_T_frame.theta - truth.theta);
  return error.dot(found.covariance.topLeftCorner<3, 3>().ldlt().solve(error));
}

// Its mean over frames with white noise.
double meanSquaredError(const RefinerOptions& options, double noise)
{
  constexpr int kFrames = 60;
  Poses poses(3);
  Refiner refiner(options);
  const MappedRetina scene(AnalyticRetina(4), kSize);
  double sum = 0.0;
  for (unsigned frame = 1; frame <= kFrames; ++frame) {
    const Pose2 truth = poses.near({}, 8.0, 0.05);
    AnalyticView view = scene.retina.view(truth, kSize);
    view.addNoise(noise, frame);
    const Pose2 start = poses.near(truth, 1.0, 0.004);
    const Refinement found = refiner.refine(view.contrast, scene.pixelsIn(view, start), start, Freedom::rigid);
    EXPECT_TRUE(found.valid && found.settled);
    sum += normalisedSquaredError(found, truth);
  }
  return sum / kFrames;
}

TEST(Refiner, ClaimsTheCovarianceOfItsErrorsUnderWhiteNoise)
{
  // Plain least squares: no weight falls. Three errors in a scatter of some 20 clusters average 3 x 19 / (19 - 4)
  // = 3.8; over 60 frames that is good to 0.4. Half and twice of 3 are far off.
  RefinerOptions squares;
  squares.cut_sigmas = squares.first_cut_sigmas = 100.0;
  squares.last_step_px = 1e-4;
  for (const double noise : {0.015, 0.04}) {
    EXPECT_GT(meanSquaredError(squares, noise), 1.5) << noise;
    EXPECT_LT(meanSquaredError(squares, noise), 6.0) << noise;
  }
}

TEST(Refiner, ClaimsLessThanItsErrorsByNoMoreThanTukeysWeightsExplain)
{
  // The claim divides by the sum of the weights, where the slope of weight x residual belongs. For normal residuals cut
  // at 3 sigma these are 0.815 and 0.515, so that the variance may be 2.5 times too small, and is never too large.
  constexpr double kTukey = 0.815 * 0.815 / (0.515 * 0.515);
  for (const double noise : {0.015, 0.04}) {
    EXPECT_GT(meanSquaredError({}, noise), 1.5) << noise;
    EXPECT_LT(meanSquaredError({}, noise), 3.8 * kTukey) << noise;
  }
}

TEST(Refiner, IsNotLedAstrayByAFifthOfTheAreaBeingSomethingElse)
{
  Poses poses(4);
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const MappedRetina scene(AnalyticRetina(seed), kSize);
    const Pose2 truth = poses.any();
    AnalyticView view = scene.retina.view(truth, kSize);
    // Another retina, shifted and brighter, unmasked.
    const AnalyticView other = AnalyticRetina(seed + 100).view(truth, kSize);
    const cv::Rect part(100, 60, kSize.width / 2, kSize.height * 2 / 5);
    view.contrast(part) = other.contrast(part) + static_cast<std::int16_t>(0.15 * Frame::kContrastUnit);
    const Refinement found = refined(scene, view, poses.near(truth, 1.0, 0.004));
    ASSERT_TRUE(found.valid && found.settled);
    EXPECT_LT(distance(found.map_T_frame, truth), 0.03) << seed;
    EXPECT_LT(std::abs(found.map_T_frame.theta - truth.theta), 0.015 * kDegree) << seed;
  }
}

TEST(Refiner, GivesNothingForTooFewPixels)
{
  const MappedRetina scene(AnalyticRetina(5), kSize);
  const AnalyticView view = scene.retina.view({}, kSize);
  const AlignmentTemplate all = scene.pixelsIn(view, {});
  ASSERT_GT(all.size(), 500u);
  for (const std::size_t count : {0u, 1u, 59u, 60u}) {
    AlignmentTemplate few;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = i * all.size() / 61;
      if (i % 8 == 0) few.cluster_begins.push_back(i);
      few.push(all.x[at], all.y[at], all.value[at], all.gx[at], all.gy[at]);
    }
    EXPECT_EQ(Refiner().refine(view.contrast, few, {}, Freedom::rigid).valid, count >= 60) << count;
  }
}

TEST(Refiner, GivesNothingWhereThePixelsFixNoPose)
{
  const MappedRetina scene(AnalyticRetina(5), kSize);
  const AnalyticView view = scene.retina.view({}, kSize);
  AlignmentTemplate flat = scene.pixelsIn(view, {});
  std::fill(flat.gx.begin(), flat.gx.end(), 0.0F);
  std::fill(flat.gy.begin(), flat.gy.end(), 0.0F);
  EXPECT_FALSE(Refiner().refine(view.contrast, flat, {}, Freedom::rigid).valid);
}

TEST(Refiner, DoesNotPassAPlaceFromWhichItCouldNotFindTheWay)
{
  std::mt19937 random(6);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const MappedRetina scene(AnalyticRetina(seed), kSize);
    for (int i = 0; i < 4; ++i) {
      const double direction = angle(random);
      const Pose2 start{40.0 * std::cos(direction), 40.0 * std::sin(direction)};
      const Refinement found = refined(scene, scene.retina.view({}, kSize), start);
      // The tracker asks for both: settled, and correlated.
      if (distance(found.map_T_frame, {}) < 1.0) continue;
      EXPECT_FALSE(found.valid && found.settled && found.ncc > 0.6) << seed << " ncc " << found.ncc;
    }
  }
}

TEST(Refiner, HasNotSettledWhileItsStepsAreLong)
{
  RefinerOptions options;
  options.most_steps = 1;
  const MappedRetina scene(AnalyticRetina(7), kSize);
  const AnalyticView view = scene.retina.view({}, kSize);
  const Pose2 off{1.5, -1.0, 0.003};
  const AlignmentTemplate pixels = scene.pixelsIn(view, off);
  EXPECT_FALSE(Refiner(options).refine(view.contrast, pixels, off, Freedom::rigid).settled);
  EXPECT_TRUE(Refiner(options).refine(view.contrast, scene.pixelsIn(view, {}), {}, Freedom::rigid).settled);
}

TEST(Refiner, MeasuresTheNoise)
{
  const MappedRetina scene(AnalyticRetina(8), kSize);
  for (const double noise : {0.01, 0.03}) {
    AnalyticView view = scene.retina.view({}, kSize);
    view.addNoise(noise, 1);
    const Refinement found = refined(scene, view, {});
    // At whole pixels the samples carry all of it.
    EXPECT_NEAR(found.sigma / Frame::kContrastUnit, noise, 0.15 * noise);
    cv::Scalar mean, signal;
    cv::meanStdDev(scene.pixelsIn(view, {}).value, mean, signal);
    EXPECT_NEAR(found.ncc, signal[0] / std::hypot(signal[0], noise * Frame::kContrastUnit), 0.02);
  }
}

TEST(Refiner, RepeatsItselfWhateverItDidBefore)
{
  const MappedRetina scene(AnalyticRetina(9), kSize);
  AnalyticView view = scene.retina.view({1.0, 2.0, 0.01}, kSize);
  view.addNoise(0.03, 1);
  Refiner used;
  const AlignmentTemplate pixels = scene.pixelsIn(view, {});
  used.refine(scene.retina.view({}, kSize).contrast, pixels, {}, Freedom::similarity);
  const Refinement a = used.refine(view.contrast, pixels, {}, Freedom::rigid);
  const Refinement b = Refiner().refine(view.contrast, pixels, {}, Freedom::rigid);
  EXPECT_EQ(a.map_T_frame.x, b.map_T_frame.x);
  EXPECT_EQ(a.map_T_frame.theta, b.map_T_frame.theta);
  EXPECT_EQ(a.covariance, b.covariance);
}

}  // namespace
}  // namespace eyeslam::tracking
