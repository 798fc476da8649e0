// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/scale_evidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/analytic_retina.h"

namespace eyeslam::tracking {
namespace {

using retina::Pose2;
using support::AnalyticRetina;
using support::AnalyticView;
using support::MappedRetina;

const cv::Size kSize(200, 152);

AnalyticView noisyView(const AnalyticRetina& retina, const Pose2& pose, double noise, unsigned seed)
{
  AnalyticView view = retina.view(pose, kSize);
  view.addNoise(noise, seed);
  return view;
}

ScaleEvidence started(const MappedRetina& scene)
{
  ScaleEvidence evidence({}, {});
  evidence.start(scene.retina.view({}, kSize).picture(), scene.mosaic);
  return evidence;
}

TEST(ScaleEvidence, NoticesAHundredthWithinThreeLooksOnEveryTexture)
{
  for (unsigned seed = 1; seed <= 8; ++seed) {
    for (const double scale : {0.99, 1.01}) {
      // Fine, usual and coarse texture, strong and weak.
      const AnalyticRetina retina(seed, 10.0 + 2.0 * (seed % 3), 40.0 + 20.0 * (seed % 4), seed % 2 ? 0.06 : 0.03);
      const MappedRetina scene(retina, kSize);
      ScaleEvidence evidence = started(scene);
      int frame = 0;
      for (; frame < 12 && !evidence.isMagnified(); ++frame) {
        const Pose2 truth{0.8 * frame, -0.5 * frame, 0.002 * frame, scale};
        // The pose is known as a rigid one.
        evidence.update(noisyView(retina, truth, 0.01, seed + static_cast<unsigned>(100 * frame)).picture(),
                        scene.mosaic, {truth.x, truth.y, truth.theta}, frame);
      }
      EXPECT_TRUE(evidence.isMagnified()) << seed << " " << scale;
      EXPECT_LE(frame, 9) << seed << " " << scale;  // frames 0, 4 and 8
    }
  }
}

TEST(ScaleEvidence, NeverTakesARigidMotionForAScale)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  int looks = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const AnalyticRetina retina(seed, 12.0, 60.0, 0.04);
    const MappedRetina scene(retina, kSize);
    ScaleEvidence evidence = started(scene);
    for (int number = 0; number < 20; number += 4) {
      const Pose2 truth{40.0 * share(random), 30.0 * share(random), 0.2 * share(random)};
      const double noise = 0.02 * std::abs(share(random));
      const AnalyticView view = noisyView(retina, truth, noise, seed + static_cast<unsigned>(1000 * number));
      const Pose2 guess{truth.x + 0.3 * share(random), truth.y + 0.3 * share(random), truth.theta};
      EXPECT_FALSE(evidence.update(view.picture(), scene.mosaic, guess, number)) << seed << " " << number;
      ++looks;
    }
    EXPECT_FALSE(evidence.isMagnified());
  }
  EXPECT_GE(looks, 150);
}

TEST(ScaleEvidence, WantsEvidenceTwiceRunningAndOfOneSign)
{
  const AnalyticRetina retina(3);
  const MappedRetina scene(retina, kSize);
  ScaleEvidence evidence = started(scene);
  // Larger, smaller, larger, true, ...: no two alike.
  int number = 0;
  for (const double scale : {1.02, 0.98, 1.02, 1.0, 1.02, 1.0}) {
    EXPECT_FALSE(evidence.update(retina.view({0.0, 0.0, 0.0, scale}, kSize).picture(), scene.mosaic, {}, number));
    number += 4;
  }
  EXPECT_FALSE(evidence.update(retina.view({0.0, 0.0, 0.0, 1.02}, kSize).picture(), scene.mosaic, {}, number));
  EXPECT_TRUE(evidence.update(retina.view({0.0, 0.0, 0.0, 1.02}, kSize).picture(), scene.mosaic, {}, number + 4));
  EXPECT_TRUE(evidence.isMagnified());
}

TEST(ScaleEvidence, LooksOnlyWhenItsTurnHasCome)
{
  const AnalyticRetina retina(4);
  const MappedRetina scene(retina, kSize);
  ScaleEvidence evidence = started(scene);
  const AnalyticView view = retina.view({0.0, 0.0, 0.0, 1.02}, kSize);
  for (const int number : {1, 2, 3, 5, 6, 7, 9})
    EXPECT_FALSE(evidence.update(view.picture(), scene.mosaic, {}, number)) << number;
  EXPECT_FALSE(evidence.isMagnified());
}

TEST(ScaleEvidence, SaysItOnceAndRemembersItUntilTheNextStart)
{
  const AnalyticRetina retina(5);
  const MappedRetina scene(retina, kSize);
  ScaleEvidence evidence = started(scene);
  const AnalyticView view = retina.view({0.0, 0.0, 0.0, 1.02}, kSize);
  EXPECT_FALSE(evidence.update(view.picture(), scene.mosaic, {}, 0));
  EXPECT_TRUE(evidence.update(view.picture(), scene.mosaic, {}, 4));
  EXPECT_FALSE(evidence.update(view.picture(), scene.mosaic, {}, 8));
  EXPECT_TRUE(evidence.isMagnified());
  evidence.start(retina.view({}, kSize).picture(), scene.mosaic);
  EXPECT_FALSE(evidence.isMagnified());
}

TEST(ScaleEvidence, UsesTheMosaicWhereTheFirstFrameIsOutOfView)
{
  const AnalyticRetina retina(6);
  MappedRetina scene(retina, kSize);
  ScaleEvidence evidence = started(scene);
  const Pose2 away{180.0, 0.0};
  const AnalyticView there = retina.view(away, kSize);
  for (int number = 0; number < 8; ++number) scene.mosaic.blend(there.picture(), away, 20.0, number);
  const AnalyticView view = retina.view({away.x, away.y, 0.0, 1.01}, kSize);
  evidence.update(view.picture(), scene.mosaic, away, 0);
  evidence.update(view.picture(), scene.mosaic, away, 4);
  EXPECT_TRUE(evidence.isMagnified());
}

}  // namespace
}  // namespace eyeslam::tracking
