// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "eyeslam/tracking/occlusion_mask.h"

namespace eyeslam::tracking {
namespace {

// The pictures of these tests are small, and no vessel has to be found in them.
FrameOptions smallPictures()
{
  FrameOptions options;
  options.least_rows = 32;
  return options;
}

using retina::Reason;

cv::Mat randomPicture(int width, int height, int type, double highest)
{
  cv::Mat picture(height, width, type);
  cv::RNG random(7);
  random.fill(picture, cv::RNG::UNIFORM, 0.0, highest + 1.0);
  return picture;
}

// A retina in 16 bits, so that rounding stays out of the way; brightness as a share of full, at full px.
cv::Mat retinaPicture(int width, int height, const std::function<double(int, int)>& brightness)
{
  cv::Mat_<cv::Vec3w> picture(height, width);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double share = 65535.0 * brightness(x, y);
      picture(y, x) = {cv::saturate_cast<std::uint16_t>(0.15 * share), cv::saturate_cast<std::uint16_t>(share),
                       cv::saturate_cast<std::uint16_t>(0.8 * share)};
    }
  }
  return picture;
}

struct Prepared {
  explicit Prepared(const cv::Mat& picture)
  {
    EXPECT_EQ(frame.assign(picture), Reason::none);
    mask.update(frame);
    frame.normalise(mask);
  }
  Frame frame{smallPictures()};
  OcclusionMask mask;
};

double worstContrast(const Frame& frame, int border)
{
  double worst = 0.0;
  for (int y = border; y < frame.height() - border; ++y) {
    for (int x = border; x < frame.width() - border; ++x)
      worst = std::max(worst, std::abs(static_cast<double>(frame.contrast()(y, x))) / Frame::kContrastUnit);
  }
  return worst;
}

TEST(Frame, HalvesByTheExactSumOfTwoByTwoGreen)
{
  // 163 x 125: an odd last column and row are left out; 81 columns end within a vector of the kernel.
  const cv::Mat picture = randomPicture(163, 125, CV_8UC3, 255);
  Frame frame(smallPictures());
  ASSERT_EQ(frame.assign(picture), Reason::none);
  ASSERT_EQ(frame.green().size(), cv::Size(81, 62));
  const auto green = [&](int x, int y) { return static_cast<int>(picture.at<cv::Vec3b>(y, x)[1]); };
  for (int y = 0; y < 62; ++y) {
    for (int x = 0; x < 81; ++x) {
      const int sum =
          green(2 * x, 2 * y) + green(2 * x + 1, 2 * y) + green(2 * x, 2 * y + 1) + green(2 * x + 1, 2 * y + 1);
      ASSERT_EQ(frame.green()(y, x), sum) << x << " " << y;
    }
  }
}

TEST(Frame, SaysWhereItsCentreLiesInAPictureOfOddSize)
{
  Frame frame(smallPictures());
  ASSERT_EQ(frame.assign(randomPicture(163, 125, CV_8UC3, 255)), Reason::none);
  EXPECT_EQ(frame.pixelSize(), Eigen::Vector2d(2.0, 2.0));
  EXPECT_EQ(frame.centre(), Eigen::Vector2d(40.0, 30.5));
  // 81 and 62 pairs: columns 0 to 161 and rows 0 to 123.
  EXPECT_EQ(frame.centreInImage(), Eigen::Vector2d(80.5, 61.5));
}

TEST(Frame, TakesGreyAsEveryColour)
{
  const cv::Mat picture = randomPicture(128, 96, CV_8UC1, 255);
  Frame frame(smallPictures());
  ASSERT_EQ(frame.assign(picture), Reason::none);
  EXPECT_TRUE(frame.isGrey());
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) {
      const cv::Scalar sum = cv::sum(picture(cv::Rect(2 * x, 2 * y, 2, 2)));
      ASSERT_EQ(frame.green()(y, x), static_cast<int>(sum[0]));
    }
  }
  EXPECT_EQ(cv::countNonZero(frame.cellRed() != frame.cellBlue()), 0);
}

TEST(Frame, ReadsSixteenBitsAsItReadsEight)
{
  const cv::Mat bytes = randomPicture(128, 96, CV_8UC3, 255);
  cv::Mat words;
  bytes.convertTo(words, CV_16U, 257.0);  // 255 x 257 = 65535
  Frame of_bytes, of_words;
  ASSERT_EQ(of_bytes.assign(bytes), Reason::none);
  ASSERT_EQ(of_words.assign(words), Reason::none);
  EXPECT_EQ(cv::countNonZero(of_bytes.green() != of_words.green()), 0);
  EXPECT_LE(cv::norm(of_bytes.cellRed(), of_words.cellRed(), cv::NORM_INF), 1.0);
  EXPECT_LE(cv::norm(of_bytes.cellBlue(), of_words.cellBlue(), cv::NORM_INF), 1.0);
}

TEST(Frame, TakesTheWhiteLevelForWhite)
{
  FrameOptions options = smallPictures();
  options.white_level = 4095.0;
  Frame frame(options);
  ASSERT_EQ(frame.assign(cv::Mat(96, 128, CV_16UC3, cv::Scalar(2047.5, 4095.0, 1023.75))), Reason::none);
  EXPECT_DOUBLE_EQ(frame.white(), 4095.0);
  EXPECT_EQ(frame.green()(10, 10), 1020);
  EXPECT_EQ(frame.cellGreen()(5, 5), 1020);
  EXPECT_NEAR(frame.cellBlue()(5, 5), 127.5, 1.0);
  EXPECT_NEAR(frame.cellRed()(5, 5), 63.75, 1.0);
}

TEST(Frame, AveragesTheAreaOfEachPixelAtOtherScales)
{
  const cv::Mat picture = randomPicture(200, 160, CV_8UC3, 255);
  for (const double scale : {1.0, 0.25, 0.2}) {
    FrameOptions options = smallPictures();
    options.scale = scale;
    Frame frame(options);
    ASSERT_EQ(frame.assign(picture), Reason::none);
    const int side = static_cast<int>(std::lround(1.0 / scale));
    ASSERT_EQ(frame.green().size(), cv::Size(200 / side, 160 / side));
    EXPECT_DOUBLE_EQ(frame.pixelSize().x(), side);
    EXPECT_EQ(frame.centreInImage(), Eigen::Vector2d(99.5, 79.5));
    for (int y = 0; y < frame.height(); ++y) {
      for (int x = 0; x < frame.width(); ++x) {
        const cv::Scalar mean = cv::mean(picture(cv::Rect(x * side, y * side, side, side)));
        ASSERT_NEAR(frame.green()(y, x), 4.0 * mean[1], 0.6) << scale;  // rounded to whole steps of ten bits
      }
    }
  }
}

TEST(Frame, StretchesByUnderAPixelWhereTheScaleLeavesARest)
{
  FrameOptions options = smallPictures();
  options.scale = 0.3;
  Frame frame(options);
  ASSERT_EQ(frame.assign(cv::Mat(165, 201, CV_8UC3, cv::Scalar(30, 90, 180))), Reason::none);
  ASSERT_EQ(frame.green().size(), cv::Size(60, 49));  // 60.3, 49.5
  EXPECT_DOUBLE_EQ(frame.pixelSize().x(), 201.0 / 60.0);
  EXPECT_DOUBLE_EQ(frame.pixelSize().y(), 165.0 / 49.0);
  EXPECT_NEAR(frame.centreInImage().x(), 100.0, 1e-9);
  EXPECT_NEAR(frame.centreInImage().y(), 82.0, 1e-9);
  EXPECT_EQ(cv::countNonZero(frame.green() != 360), 0);
}

TEST(Frame, AveragesCells)
{
  const cv::Mat picture = randomPicture(160, 128, CV_8UC3, 255);
  Frame frame(smallPictures());
  ASSERT_EQ(frame.assign(picture), Reason::none);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 20; ++x) {
      const cv::Scalar mean = cv::mean(frame.green()(cv::Rect(4 * x, 4 * y, 4, 4)));
      ASSERT_NEAR(frame.cellGreen()(y, x), mean[0], 0.51);
    }
  }
}

TEST(Frame, HasNoContrastOnAFlatField)
{
  // Sizes that end with a cell, within one, and after a single row of one.
  for (const cv::Size size : {cv::Size(160, 128), cv::Size(163, 125), cv::Size(170, 130)}) {
    const Prepared prepared(cv::Mat(size, CV_8UC3, cv::Scalar(30, 90, 180)));
    EXPECT_LE(worstContrast(prepared.frame, 0), 1.0 / Frame::kContrastUnit) << size;
  }
}

TEST(Frame, DoesNotTakeASmoothIlluminationForContrast)
{
  // Twice as bright at the right as at the left. In the middle rounding to ten bits remains, half of 306 and more.
  const Prepared ramp(retinaPicture(320, 240, [](int x, int) { return 0.3 + 0.3 * x / 319.0; }));
  EXPECT_LT(worstContrast(ramp.frame, 20), 0.004);
  // At the border the background is the mean of the inner side only: of cells 0 to 3 and 0 to 4, 8.6 px from px 0.
  EXPECT_LT(worstContrast(ramp.frame, 0), 8.7 * (0.3 / 160.0) / 0.3);

  // A light cone, exp(-r^2 / 2 s^2) with s = 100 frame px. The two boxes (half widths 14 and 6 px) average the
  // curvature: at most 2 / s^2 x (14^2 + 6^2) / 6 = 0.008.
  const auto cone = [](int x, int y) {
    return 0.6 * std::exp(-0.5 * (std::pow((x - 160) / 200.0, 2) + std::pow((y - 120) / 200.0, 2)));
  };
  EXPECT_LT(worstContrast(Prepared(retinaPicture(320, 240, cone)).frame, 20), 0.012);
}

TEST(Frame, GivesTheContrastOfALineAgainstItsSurroundings)
{
  // One row of frame px, 20 % darker. [1 2 1] leaves half; the boxes of 28 and 12 px know the line too, so the
  // background is 0.2 x 1/28 darker.
  const Prepared prepared(retinaPicture(320, 240, [](int, int y) { return y / 2 == 60 ? 0.4 : 0.5; }));
  const double background = 1.0 - 0.2 / 28.0;
  const double line = 0.5 * (0.8 / background) + 0.5 * (1.0 / background) - 1.0;
  EXPECT_NEAR(static_cast<double>(prepared.frame.contrast()(60, 80)) / Frame::kContrastUnit, line, 0.002);
}

TEST(Frame, KeepsWhatIsMaskedOutOfTheBackgroundOfWhatIsVisible)
{
  const auto withInstrument = [](double grey) {
    cv::Mat picture(240, 320, CV_8UC3);
    cv::RNG(3).fill(picture, cv::RNG::UNIFORM, cv::Scalar(28, 80, 175), cv::Scalar(33, 100, 186));
    if (grey > 0.0) picture(cv::Rect(120, 80, 80, 64)).setTo(cv::Scalar::all(grey));
    return picture;
  };
  const Prepared none(withInstrument(0.0)), grey(withInstrument(150.0)), white(withInstrument(255.0));
  int compared = 0;
  for (int y = 0; y < white.frame.height(); ++y) {
    for (int x = 0; x < white.frame.width(); ++x) {
      if (!white.mask.isVisible(x, y)) continue;
      ASSERT_EQ(white.frame.contrast()(y, x), grey.frame.contrast()(y, x)) << x << " " << y;
      // Without an instrument the mean rests on more cells, so it differs by their noise.
      ASSERT_NEAR(white.frame.contrast()(y, x), none.frame.contrast()(y, x), 0.02 * Frame::kContrastUnit);
      ++compared;
    }
  }
  EXPECT_GT(compared, 160 * 120 * 3 / 4);
}

TEST(Frame, RefusesWhatItCannotUse)
{
  Frame frame(smallPictures());
  EXPECT_EQ(frame.assign(cv::Mat()), Reason::wrong_size);
  EXPECT_EQ(frame.assign(cv::Mat(96, 128, CV_32FC3)), Reason::wrong_size);
  EXPECT_EQ(frame.assign(cv::Mat(96, 128, CV_8UC4)), Reason::wrong_size);
  EXPECT_EQ(frame.assign(cv::Mat(31, 128, CV_8UC3, cv::Scalar::all(9))), Reason::wrong_size);
  ASSERT_EQ(frame.assign(cv::Mat(64, 128, CV_8UC3, cv::Scalar::all(9))), Reason::none);
  EXPECT_EQ(frame.assign(cv::Mat(66, 128, CV_8UC3, cv::Scalar::all(9))), Reason::wrong_size);
  EXPECT_EQ(frame.assign(cv::Mat(64, 128, CV_8UC1, cv::Scalar::all(9))), Reason::wrong_size);
  EXPECT_EQ(frame.assign(cv::Mat(64, 128, CV_8UC3, cv::Scalar::all(9))), Reason::none);
}

}  // namespace
TEST(Frame, KeepsEnoughRowsOfASmallPicture)
{
  Frame frame;
  ASSERT_EQ(frame.assign(cv::Mat(96, 128, CV_8UC3, cv::Scalar(20, 60, 160))), eyeslam::retina::Reason::none);
  EXPECT_EQ(frame.height(), 96);
  Frame larger;
  ASSERT_EQ(larger.assign(cv::Mat(192, 256, CV_8UC3, cv::Scalar(20, 60, 160))), eyeslam::retina::Reason::none);
  EXPECT_EQ(larger.height(), 96);
}

}  // namespace eyeslam::tracking
