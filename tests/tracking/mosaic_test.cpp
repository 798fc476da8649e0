// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/mosaic.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/analytic_retina.h"

namespace eyeslam::tracking {
namespace {

using retina::Pose2;
using support::AnalyticRetina;
using support::AnalyticView;

const cv::Size kSize(160, 120);
constexpr double kSigma = 20.0;  // contrast units

struct Region {
  cv::Mat_<std::int16_t> mean;
  cv::Mat_<std::uint8_t> count;
};

Region read(const Mosaic& mosaic, const cv::Rect& region)
{
  Region result;
  mosaic.read(region, result.mean, result.count);
  return result;
}

// As many frames as every row needs for a sample.
void blendEveryRow(Mosaic& mosaic, const AnalyticView& view, const Pose2& pose)
{
  for (int number = 0; number < 8; ++number) mosaic.blend(view.picture(), pose, kSigma, number);
}

// Worst difference from the retina over the pixels of a region that were seen; contrast units.
double worstError(const Mosaic& mosaic, const AnalyticRetina& retina, const cv::Rect& region, int& seen)
{
  const Region found = read(mosaic, region);
  double worst = 0.0;
  seen = 0;
  for (int y = 0; y < region.height; ++y) {
    for (int x = 0; x < region.width; ++x) {
      if (found.count(y, x) == 0) continue;
      const Eigen::Vector2d at = Eigen::Vector2d(region.x + x, region.y + y) - mosaic.centre();
      worst = std::max(worst, std::abs(found.mean(y, x) - Frame::kContrastUnit * retina.at(at)));
      ++seen;
    }
  }
  return worst;
}

TEST(Mosaic, StartsWithThePictureOfFrame0)
{
  const AnalyticRetina retina(1);
  const AnalyticView view = retina.view({}, kSize);
  Mosaic mosaic;
  EXPECT_TRUE(mosaic.empty());
  mosaic.start(view.picture());
  EXPECT_EQ(mosaic.centre(), Eigen::Vector2d(79.5, 59.5));
  const Region found = read(mosaic, {cv::Point(), kSize});
  const cv::Rect inside(2, 2, kSize.width - 4, kSize.height - 4);  // what cubic samples can reach
  EXPECT_EQ(cv::countNonZero(found.mean(inside) != view.contrast(inside)), 0);
  EXPECT_EQ(cv::countNonZero(found.count(inside) != 1), 0);
  EXPECT_EQ(cv::countNonZero(found.count), inside.area());
  EXPECT_EQ(mosaic.count(50, 50), 1);
  EXPECT_EQ(mosaic.count(-1000, 50), 0);
}

TEST(Mosaic, ShowsTheRetinaThatFramesAtKnownPosesSaw)
{
  const AnalyticRetina retina(2);
  Mosaic mosaic;
  mosaic.start(retina.view({}, kSize).picture());
  for (const Pose2& pose : {Pose2{31.4, -22.7, 0.2, 1.0}, Pose2{-60.3, 15.2, -0.4, 1.0}, Pose2{5.5, 70.1, 1.0, 1.03}})
    blendEveryRow(mosaic, retina.view(pose, kSize), pose);
  int seen = 0;
  // Cubic samples of waves of 12 px and more are good to 0.003.
  EXPECT_LT(worstError(mosaic, retina, mosaic.bounds(), seen), 0.003 * Frame::kContrastUnit);
  EXPECT_GT(seen, 156 * 116 * 2);
}

TEST(Mosaic, GivesEachRowItsTurnOnceInAPeriod)
{
  const AnalyticRetina retina(3);
  const AnalyticView view = retina.view({}, kSize);
  Mosaic mosaic;
  mosaic.start(view.picture());
  for (int number = 0; number < 8; ++number) {
    mosaic.blend(view.picture(), {}, kSigma, number);
    for (int y = 8; y < 64; ++y) EXPECT_EQ(mosaic.count(80, y), y % 8 <= number ? 2 : 1) << number << " " << y;
  }
  // From frame 60 on, once in 16.
  for (int number = 64; number < 80; ++number) mosaic.blend(view.picture(), {}, kSigma, number);
  for (int y = 8; y < 64; ++y) EXPECT_EQ(mosaic.count(80, y), 3);
}

TEST(Mosaic, AveragesNoiseAway)
{
  const AnalyticRetina retina(4);
  MosaicOptions options;
  options.row_period = options.settled_row_period = 1;
  Mosaic mosaic(options);
  constexpr int kFrames = 16;
  for (unsigned seed = 0; seed < kFrames; ++seed) {
    AnalyticView view = retina.view({}, kSize);
    view.addNoise(0.02, seed + 1);
    if (seed == 0)
      mosaic.start(view.picture());
    else
      mosaic.blend(view.picture(), {}, 0.02 * Frame::kContrastUnit, seed);
  }
  const cv::Rect inside(10, 10, 140, 100);
  const AnalyticView truth = retina.view({}, kSize);
  const double rms = cv::norm(read(mosaic, inside).mean, truth.contrast(inside)) / std::sqrt(inside.area());
  EXPECT_NEAR(rms / Frame::kContrastUnit, 0.02 / std::sqrt(kFrames), 0.001);
}

TEST(Mosaic, GrowsInEveryDirectionAndKeepsEveryPixel)
{
  const AnalyticRetina retina(5);
  Mosaic mosaic;
  mosaic.start(retina.view({}, kSize).picture());
  const cv::Rect first(cv::Point(), kSize);
  const Region before = read(mosaic, first);
  // Views beside, above and below the first one, which share no pixel with it.
  for (const Pose2& pose : {Pose2{-300.5, 0.0}, Pose2{300.25, 0.0}, Pose2{0.0, -200.5}, Pose2{0.0, 200.75}}) {
    blendEveryRow(mosaic, retina.view(pose, kSize), pose);
    const Region after = read(mosaic, first);
    EXPECT_EQ(cv::countNonZero(before.mean != after.mean), 0) << pose.x << " " << pose.y;
    EXPECT_EQ(cv::countNonZero(before.count != after.count), 0) << pose.x << " " << pose.y;
    const Eigen::Vector2d middle = mosaic.centre() + pose.translation();
    EXPECT_EQ(mosaic.count(static_cast<int>(middle.x()), static_cast<int>(middle.y())), 1);
  }
  int seen = 0;
  EXPECT_LT(worstError(mosaic, retina, mosaic.bounds(), seen), 0.003 * Frame::kContrastUnit);
  EXPECT_NEAR(seen, 5 * 156 * 116, 4 * (156 + 116));  // a row or column less where a view lies between pixels
}

TEST(Mosaic, AcceptsABurnOnceItHasOutvotedWhatWasThere)
{
  const AnalyticRetina retina(6);
  const AnalyticView healthy = retina.view({}, kSize);
  AnalyticView burnt = retina.view({}, kSize);
  const cv::Rect burn(70, 50, 16, 16);
  burnt.contrast(burn) += static_cast<std::int16_t>(0.2 * Frame::kContrastUnit);
  MosaicOptions options;
  options.row_period = options.settled_row_period = 1;
  Mosaic mosaic(options);
  mosaic.start(healthy.picture());
  for (int number = 1; number < 5; ++number) mosaic.blend(healthy.picture(), {}, kSigma, number);
  ASSERT_EQ(mosaic.count(75, 55), 5);
  for (int visit = 1; visit <= 5; ++visit) {
    mosaic.blend(burnt.picture(), {}, kSigma, visit);
    EXPECT_EQ(mosaic.count(75, 55), 5 - visit);
    EXPECT_EQ(cv::countNonZero(read(mosaic, burn).mean != healthy.contrast(burn)), 0);
  }
  mosaic.blend(burnt.picture(), {}, kSigma, 6);
  EXPECT_EQ(cv::countNonZero(read(mosaic, burn).mean != burnt.contrast(burn)), 0);
  EXPECT_EQ(mosaic.count(75, 55), 1);
  // What did not change has only become surer.
  EXPECT_EQ(mosaic.count(40, 40), 11);
}

TEST(Mosaic, TakesAsFarOffWhatTheFramesNoiseDoesNotExplain)
{
  const AnalyticRetina retina(7);
  const AnalyticView healthy = retina.view({}, kSize);
  AnalyticView changed = retina.view({}, kSize);
  changed.contrast += static_cast<std::int16_t>(0.1 * Frame::kContrastUnit);
  MosaicOptions options;
  options.row_period = 1;
  for (const bool noisy : {false, true}) {
    Mosaic mosaic(options);
    mosaic.start(healthy.picture());
    // 0.1 is 4.0 sigma and more of 0.02, but under 4 sigma of 0.03.
    mosaic.blend(changed.picture(), {}, (noisy ? 0.03 : 0.02) * Frame::kContrastUnit, 1);
    EXPECT_EQ(mosaic.count(75, 55), noisy ? 2 : 0);
  }
}

TEST(Mosaic, NeverBlendsMaskedPixels)
{
  const AnalyticRetina retina(8);
  AnalyticView view = retina.view({}, kSize);
  const cv::Rect cells(10, 8, 6, 7), hidden(40, 32, 24, 28);
  view.hide(cells);
  view.contrast(hidden).setTo(7000);
  Mosaic mosaic;
  mosaic.start(view.picture());
  EXPECT_EQ(cv::countNonZero(read(mosaic, hidden).count), 0);
  blendEveryRow(mosaic, view, {});
  EXPECT_EQ(cv::countNonZero(read(mosaic, hidden).count), 0);
  // Once seen, they stay what they were while something covers them.
  const AnalyticView bare = retina.view({}, kSize);
  blendEveryRow(mosaic, bare, {});
  blendEveryRow(mosaic, view, {});
  const Region found = read(mosaic, hidden);
  EXPECT_EQ(cv::countNonZero(found.mean != bare.contrast(hidden)), 0);
  EXPECT_EQ(cv::countNonZero(found.count != 1), 0);
}

// The pixel of a block that has the strongest gradient by 3x3 smoothed central differences, by brute force.
Mosaic::TemplatePixel strongest(const cv::Mat_<std::int16_t>& plane, const cv::Rect& block, double least)
{
  Mosaic::TemplatePixel best;
  double most = least * least;
  for (int y = block.y; y < block.br().y; ++y) {
    for (int x = block.x; x < block.br().x; ++x) {
      double gx = 0.0, gy = 0.0;
      for (int d = -1; d <= 1; ++d) {
        const double weight = d == 0 ? 0.25 : 0.125;
        gx += weight * (plane(y + d, x + 1) - plane(y + d, x - 1));
        gy += weight * (plane(y + 1, x + d) - plane(y - 1, x + d));
      }
      if (gx * gx + gy * gy <= most) continue;
      most = gx * gx + gy * gy;
      best = {static_cast<float>(x),  static_cast<float>(y),  static_cast<float>(plane(y, x)),
              static_cast<float>(gx), static_cast<float>(gy), true};
    }
  }
  return best;
}

TEST(Mosaic, OffersThePixelOfStrongestGradientInEachBlock)
{
  const AnalyticRetina retina(9, 12.0, 60.0, 0.02);  // weak enough that some blocks offer none
  const AnalyticView view = retina.view({}, kSize);
  Mosaic mosaic;
  mosaic.start(view.picture());
  int valid = 0, none = 0;
  for (int by = 1; by < kSize.height / 4 - 1; ++by) {
    for (int bx = 1; bx < kSize.width / 8 - 1; ++bx) {
      const Mosaic::Tile* tile = mosaic.tiles().find(bx / 8, by / 16);
      ASSERT_NE(tile, nullptr);
      const Mosaic::TemplatePixel& pixel = tile->pixels[static_cast<std::size_t>(by % 16 * 8 + bx % 8)];
      const Mosaic::TemplatePixel expected =
          strongest(view.contrast, {8 * bx, 4 * by, 8, 4}, 0.006 * Frame::kContrastUnit);
      ASSERT_EQ(pixel.valid, expected.valid) << bx << " " << by;
      ++(pixel.valid ? valid : none);
      if (!pixel.valid) continue;
      EXPECT_EQ(cv::Point2f(pixel.x, pixel.y), cv::Point2f(expected.x, expected.y)) << bx << " " << by;
      EXPECT_FLOAT_EQ(pixel.value, expected.value);
      EXPECT_FLOAT_EQ(pixel.gx, expected.gx);
      EXPECT_FLOAT_EQ(pixel.gy, expected.gy);
    }
  }
  EXPECT_GT(valid, 20);
  EXPECT_GT(none, 20);
}

TEST(Mosaic, ForgetsEverythingWhenItStartsAgain)
{
  const AnalyticRetina retina(10);
  Mosaic mosaic;
  mosaic.start(retina.view({}, kSize).picture());
  blendEveryRow(mosaic, retina.view({300.0, 0.0}, kSize), {300.0, 0.0});
  const AnalyticView other = retina.view({50.0, 50.0}, kSize);
  mosaic.start(other.picture());
  EXPECT_EQ(mosaic.count(380, 60), 0);
  const cv::Rect inside(2, 2, kSize.width - 4, kSize.height - 4);
  EXPECT_EQ(cv::countNonZero(read(mosaic, inside).mean != other.contrast(inside)), 0);
}

TEST(Mosaic, IgnoresAPoseGoneMad)
{
  const AnalyticRetina retina(11);
  const AnalyticView view = retina.view({}, kSize);
  Mosaic mosaic;
  mosaic.start(view.picture());
  const cv::Rect before = mosaic.bounds();
  blendEveryRow(mosaic, view, {1e9, -1e9, 0.0});
  EXPECT_EQ(mosaic.bounds(), before);
}

}  // namespace
}  // namespace eyeslam::tracking
