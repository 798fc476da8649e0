// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/dense_search.h"

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
constexpr double kShortest_px = 24.0, kLongest_px = 120.0;  // what survives the means over 8 px

AnalyticRetina coarseRetina(unsigned seed) { return AnalyticRetina(seed, kShortest_px, kLongest_px); }

Pose2 shifted(double length_px, double angle, double theta)
{
  return {length_px * std::cos(angle), length_px * std::sin(angle), theta};
}

TEST(DenseSearch, FindsAViewThatMovedByUpTo100Pixels)
{
  DenseSearch search;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const MappedRetina scene(coarseRetina(seed), kMapped);
    for (const double length_px : {0.0, 13.0, 41.0, 70.0, 100.0}) {
      const Pose2 truth = shifted(length_px, 1.3 * seed + 0.03 * length_px, 0.0);
      AnalyticView view = scene.retina.view(truth, kSize);
      view.addNoise(0.03, seed);
      const auto found = search.find(scene.mosaic, view.picture(), {});
      ASSERT_TRUE(found) << length_px;
      EXPECT_LT(distance(*found, truth), 3.0) << seed << " " << length_px;
    }
  }
}

TEST(DenseSearch, KeepsTheAngleAndTheScaleItWasGiven)
{
  DenseSearch search;
  const MappedRetina scene(coarseRetina(5), kMapped);
  for (const double theta : {-0.6, 0.3, 1.5}) {
    Pose2 truth = shifted(60.0, theta, theta);
    truth.scale = 1.05;
    const auto found = search.find(scene.mosaic, scene.retina.view(truth, kSize).picture(), {5.0, -7.0, theta, 1.05});
    ASSERT_TRUE(found) << theta;
    EXPECT_LT(distance(*found, truth), 3.0) << theta;
    EXPECT_EQ(found->theta, theta);
    EXPECT_EQ(found->scale, 1.05);
  }
}

TEST(DenseSearch, FindsTheMiddleOfASmearedView)
{
  DenseSearch search;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const MappedRetina scene(coarseRetina(seed + 10), kMapped);
    const Pose2 truth = shifted(60.0, 2.0 * seed, 0.0);
    const AnalyticView view = scene.retina.smeared(truth, kSize, 0.6 * truth.translation());
    const auto found = search.find(scene.mosaic, view.picture(), {});
    ASSERT_TRUE(found);
    EXPECT_LT(distance(*found, truth), 3.0) << seed;
  }
}

TEST(DenseSearch, IgnoresWhatTheInstrumentCovers)
{
  DenseSearch search;
  const MappedRetina scene(coarseRetina(6), kMapped);
  const Pose2 truth = shifted(50.0, 1.0, 0.0);
  AnalyticView view = scene.retina.view(truth, kSize);
  view.hide({20, 0, 20, 46});
  view.contrast(cv::Rect(80, 0, 80, kSize.height)).setTo(8000);
  const auto found = search.find(scene.mosaic, view.picture(), {});
  ASSERT_TRUE(found);
  EXPECT_LT(distance(*found, truth), 3.0);
}

TEST(DenseSearch, TakesNoPlaceThatCorrelatesTooWeakly)
{
  // An unrelated picture of waves this long correlates by 0.3 somewhere among a thousand places; the true place by
  // nearly 1. A threshold between them tells.
  DenseSearchOptions options;
  options.least_ncc = 0.8;
  DenseSearch search(options);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const MappedRetina scene(coarseRetina(seed), kMapped);
    EXPECT_FALSE(search.find(scene.mosaic, coarseRetina(seed + 50).view({}, kSize).picture(), {})) << seed;
    EXPECT_TRUE(search.find(scene.mosaic, scene.retina.view({30.0, 9.0}, kSize).picture(), {})) << seed;
  }
}

TEST(DenseSearch, FindsNothingInAFlatPicture)
{
  DenseSearch search;
  const MappedRetina scene(coarseRetina(7), kMapped);
  AnalyticView view = scene.retina.view({}, kSize);
  view.contrast.setTo(100);
  EXPECT_FALSE(search.find(scene.mosaic, view.picture(), {}));
}

TEST(DenseSearch, FindsNothingWhereTooLittleIsMapped)
{
  DenseSearch search;
  const MappedRetina scene(coarseRetina(8), kMapped);
  // Even the nearest shift overlaps by less than a fifth.
  const Pose2 away{200.0 + 120.0 + 128.0 - 40.0, 0.0};
  EXPECT_FALSE(search.find(scene.mosaic, scene.retina.view(away, kSize).picture(), away));
}

}  // namespace
}  // namespace eyeslam::tracking
