// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/occlusion_mask.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace eyeslam::tracking {
namespace {

constexpr int kColumns = 40, kRows = 30;  // cells of 8 full px
const cv::Scalar kRetina(30, 90, 180), kShade(10, 20, 40), kSteel(150, 150, 150), kBloom(255, 255, 255);

cv::Mat retinaPicture() { return {8 * kRows, 8 * kColumns, CV_8UC3, kRetina}; }

void paint(cv::Mat& picture, const cv::Rect& cells, const cv::Scalar& colour)
{
  picture(cv::Rect(8 * cells.x, 8 * cells.y, 8 * cells.width, 8 * cells.height)).setTo(colour);
}

OcclusionMask maskOf(const cv::Mat& picture, const OcclusionMaskOptions& options = {})
{
  Frame frame;
  frame.assign(picture);
  OcclusionMask mask(options);
  mask.update(frame);
  return mask;
}

// Every cell within the rectangle has these bits, every other is visible.
void expectOnly(const cv::Mat_<std::uint8_t>& cells, const cv::Rect& inside, int bits)
{
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) ASSERT_EQ(cells(y, x), inside.contains({x, y}) ? bits : 0) << x << " " << y;
  }
}

TEST(OcclusionMask, SeesAllOfABareRetina)
{
  const OcclusionMask mask = maskOf(retinaPicture());
  expectOnly(mask.cells(), {}, OcclusionMask::kVisible);
  EXPECT_DOUBLE_EQ(mask.visibleFraction(), 1.0);
  EXPECT_EQ(mask.medianRed(), 180);
}

TEST(OcclusionMask, HidesTheRimAndTwoCellsBesideIt)
{
  cv::Mat picture = retinaPicture();
  paint(picture, {0, 0, 10, kRows}, kShade);
  const OcclusionMask mask = maskOf(picture);
  expectOnly(mask.cells(), {0, 0, 12, kRows}, OcclusionMask::kRim);
  EXPECT_DOUBLE_EQ(mask.visibleFraction(), 28.0 / 40.0);
}

TEST(OcclusionMask, HidesInstrumentsAndBlooms)
{
  for (const cv::Scalar& colour : {kSteel, kBloom}) {
    cv::Mat picture = retinaPicture();
    paint(picture, {20, 10, 5, 6}, colour);
    const OcclusionMask mask = maskOf(picture);
    expectOnly(mask.cells(), {18, 8, 9, 10}, OcclusionMask::kBright);
    expectOnly(mask.brightCells(), {20, 10, 5, 6}, 1);
  }
}

TEST(OcclusionMask, TakesADiscForRetina)
{
  cv::Mat picture = retinaPicture();
  paint(picture, {20, 10, 8, 8}, cv::Scalar(70, 190, 230));  // blue is 0.3 of red
  EXPECT_DOUBLE_EQ(maskOf(picture).visibleFraction(), 1.0);
}

TEST(OcclusionMask, GrowsByAsManyCellsAsAsked)
{
  cv::Mat picture = retinaPicture();
  paint(picture, {20, 10, 1, 1}, kBloom);
  for (const int growth : {0, 1, 4}) {
    OcclusionMaskOptions options;
    options.growth_cells = growth;
    expectOnly(maskOf(picture, options).cells(), {20 - growth, 10 - growth, 1 + 2 * growth, 1 + 2 * growth},
               OcclusionMask::kBright);
  }
}

TEST(OcclusionMask, GrowsNoFurtherThanTheFrame)
{
  cv::Mat picture = retinaPicture();
  paint(picture, {kColumns - 1, kRows - 1, 1, 1}, kBloom);
  expectOnly(maskOf(picture).cells(), {kColumns - 3, kRows - 3, 3, 3}, OcclusionMask::kBright);
}

TEST(OcclusionMask, SaysBothWhereARimAndABloomMeet)
{
  cv::Mat picture = retinaPicture();
  paint(picture, {0, 0, 10, kRows}, kShade);
  paint(picture, {12, 10, 1, 1}, kBloom);
  EXPECT_EQ(maskOf(picture).cells()(10, 11), OcclusionMask::kRim | OcclusionMask::kBright);
}

TEST(OcclusionMask, MeasuresTheLightWithoutWhatIsBlack)
{
  // Three quarters of the picture black: the median is the retina's.
  cv::Mat picture = retinaPicture();
  paint(picture, {0, 0, 30, kRows}, cv::Scalar(5, 5, 5));
  EXPECT_EQ(maskOf(picture).medianRed(), 180);
  EXPECT_EQ(maskOf(0.5 * retinaPicture()).medianRed(), 90);
}

TEST(OcclusionMask, FindsTheMedianThatSortingFinds)
{
  for (int seed = 1; seed <= 20; ++seed) {
    cv::Mat picture(8 * kRows, 8 * kColumns, CV_8UC3);
    cv::RNG(static_cast<std::uint64_t>(seed)).fill(picture, cv::RNG::UNIFORM, 0.0, 20.0 + 12.0 * seed);
    Frame frame;
    frame.assign(picture);
    OcclusionMask mask;
    mask.update(frame);
    std::vector<int> red;
    for (const std::uint8_t value : frame.cellRed()) {
      if (value > 25) red.push_back(value);
    }
    if (red.empty()) continue;
    std::sort(red.begin(), red.end());
    EXPECT_EQ(mask.medianRed(), red[(red.size() - 1) / 2]) << seed;
  }
}

TEST(OcclusionMask, SeesNothingInTheDark)
{
  const OcclusionMask mask = maskOf(cv::Mat(240, 320, CV_8UC3, cv::Scalar(2, 3, 4)));
  EXPECT_EQ(mask.medianRed(), 0);
  EXPECT_DOUBLE_EQ(mask.visibleFraction(), 0.0);
  EXPECT_EQ(cv::countNonZero(mask.brightCells()), 0);
}

TEST(OcclusionMask, KnowsInstrumentsInGreyByTheirBrightness)
{
  cv::Mat picture(8 * kRows, 8 * kColumns, CV_8UC1, cv::Scalar(100));
  picture(cv::Rect(8 * 20, 8 * 10, 8 * 5, 8 * 5)).setTo(170);  // 1.6 x 100 and more
  picture(cv::Rect(8 * 5, 8 * 5, 8 * 5, 8 * 5)).setTo(150);
  expectOnly(maskOf(picture).cells(), {18, 8, 9, 9}, OcclusionMask::kBright);
}

TEST(OcclusionMask, SeesNothingOutsideTheFrame)
{
  const OcclusionMask mask = maskOf(retinaPicture());
  EXPECT_TRUE(mask.isVisible(0, 0));
  EXPECT_TRUE(mask.isVisible(4 * kColumns - 1, 4 * kRows - 1));
  EXPECT_FALSE(mask.isVisible(-1, 0));
  EXPECT_FALSE(mask.isVisible(0, -1));
  EXPECT_FALSE(mask.isVisible(4 * kColumns, 0));
  EXPECT_FALSE(mask.isVisible(0, 4 * kRows));
}

}  // namespace
}  // namespace eyeslam::tracking
