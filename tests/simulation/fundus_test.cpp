// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "eyeslam/simulation/fundus_photograph.h"
#include "eyeslam/simulation/procedural_fundus.h"

namespace eyeslam::simulation {
namespace {

ProceduralFundusOptions smallRetina()
{
  ProceduralFundusOptions options;
  options.um_per_px = 12.0;
  return options;
}

// An orange disc with a dark line 9 px wide, in a black surround.
cv::Mat photograph()
{
  cv::Mat picture(480, 640, CV_8UC3, cv::Scalar::all(2));
  cv::circle(picture, {320, 240}, 220, cv::Scalar(30, 70, 200), -1);
  cv::rectangle(picture, cv::Rect(150, 236, 340, 9), cv::Scalar(25, 40, 180), -1);
  return picture;
}

cv::Mat mask()
{
  cv::Mat picture(480, 640, CV_8UC1, cv::Scalar(0));
  cv::rectangle(picture, cv::Rect(150, 236, 340, 9), cv::Scalar(255), -1);
  return picture;
}

TEST(ProceduralFundus, IsTheSameToTheByteForTheSameSeedOnly)
{
  const Fundus a = proceduralFundus(smallRetina(), 4);
  const Fundus b = proceduralFundus(smallRetina(), 4);
  const Fundus c = proceduralFundus(smallRetina(), 5);
  EXPECT_EQ(cv::norm(a.bgr, b.bgr, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(a.calibre_px, b.calibre_px, cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(a.calibre_px, c.calibre_px, cv::NORM_INF), 0.0);
}

TEST(ProceduralFundus, ItsVesselTruthLiesOnDarkRidges)
{
  ProceduralFundusOptions options;
  options.um_per_px = 5.0;
  options.width_mm = 9.0;
  options.height_mm = 6.0;
  const Fundus fundus = proceduralFundus(options, 2);
  cv::Mat green;
  cv::extractChannel(fundus.bgr, green, 1);
  cv::Mat mean;
  cv::blur(green, mean, {61, 61});
  const cv::Mat ratio = green / mean;
  const auto over = [&](double low, double high) {
    return cv::mean(ratio, (fundus.calibre_px >= low) & (fundus.calibre_px < high))[0];
  };
  const double beside = cv::mean(ratio, fundus.calibre_px == 0.0F)[0];
  EXPECT_LT(over(2, 5), beside - 0.02);
  EXPECT_LT(over(5, 10), beside - 0.06);
  EXPECT_LT(over(10, 40), beside - 0.12);
}

TEST(ProceduralFundus, VesselsDivideByMurraysLaw)
{
  const RetinaPlan plan{{14000, 9400}, {4300, 4500}, {8800, 4900}, 850};
  const auto vessels = growVessels(plan, {}, 3);
  int forks = 0;
  for (const Vessel& twig : vessels) {
    for (const Vessel& stem : vessels) {
      for (std::size_t i = 1; i + 13 < stem.nodes.size(); ++i) {
        if (&twig == &stem || twig.nodes.size() < 14 || (twig.nodes[0].place - stem.nodes[i].place).norm() > 1e-9)
          continue;
        const auto cube = [](double r) { return r * r * r; };
        EXPECT_NEAR(cube(stem.nodes[i + 1].radius) + cube(twig.nodes[0].radius), cube(stem.nodes[i].radius),
                    0.01 * cube(stem.nodes[i].radius));
        ++forks;
      }
    }
  }
  EXPECT_GT(forks, 20);
}

TEST(ProceduralFundus, HasVesselsOfAllCalibresAndKeepsTheFoveaFree)
{
  const Fundus fundus = proceduralFundus(smallRetina(), 6);
  const double area = static_cast<double>(fundus.calibre_px.total());
  const double share = cv::countNonZero(fundus.calibre_px > 0.0F) / area;
  EXPECT_GT(share, 0.04);
  EXPECT_LT(share, 0.25);
  double widest = 0.0;
  cv::minMaxLoc(fundus.calibre_px, nullptr, &widest);
  EXPECT_GT(widest * fundus.um_per_px, 100.0);
  EXPECT_LT(widest * fundus.um_per_px, 200.0);
  EXPECT_GT(cv::countNonZero((fundus.calibre_px > 0.0F) & (fundus.calibre_px < 25.0 / fundus.um_per_px)), 100);
}

TEST(FundusPhotograph, CutsTheBlackSurroundOffAndFillsIt)
{
  const Fundus fundus = fundusFromPhotograph(photograph(), mask());
  EXPECT_EQ(fundus.known(5, 5), 0);
  EXPECT_EQ(fundus.known(240, 320), 255);
  EXPECT_EQ(fundus.known(240, 102), 0);  // within the seam of 120 um
  double darkest = 0.0;
  cv::Mat red;
  cv::extractChannel(fundus.bgr, red, 2);
  cv::minMaxLoc(red, &darkest);
  EXPECT_GT(darkest, 0.6);
}

TEST(FundusPhotograph, MeasuresTheCalibreOfAMask)
{
  const Fundus fundus = fundusFromPhotograph(photograph(), mask());
  EXPECT_NEAR(fundus.calibre_px(240, 320), 9.0F, 1.0F);
  EXPECT_NEAR(fundus.calibre_px(236, 320), 9.0F, 1.0F);
  EXPECT_EQ(fundus.calibre_px(220, 320), 0.0F);
}

TEST(FundusPhotograph, CalibresFollowTheZoom)
{
  const Fundus fundus = resampled(fundusFromPhotograph(photograph(), mask()), 0.5);
  EXPECT_EQ(fundus.bgr.size(), cv::Size(320, 240));
  EXPECT_NEAR(fundus.calibre_px(120, 160), 4.5F, 0.6F);
  EXPECT_NEAR(fundus.um_per_px, 8.0, 1e-9);
}

TEST(FundusPhotograph, RefusesWhatDoesNotFit)
{
  EXPECT_THROW(fundusFromPhotograph(cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(0)), {}), std::invalid_argument);
  EXPECT_THROW(fundusFromPhotograph(cv::Mat(480, 640, CV_8UC1, cv::Scalar::all(99)), {}), std::invalid_argument);
  EXPECT_THROW(fundusFromPhotograph(photograph(), cv::Mat(10, 10, CV_8UC1, cv::Scalar(0))), std::invalid_argument);
}

TEST(Fundus, WithoutTextureOnlyTheVesselsRemain)
{
  const Fundus fundus = proceduralFundus(smallRetina(), 7);
  const Fundus plain = withoutTexture(fundus);
  cv::Mat away;
  cv::dilate(fundus.calibre_px > 0.0F, away, cv::getStructuringElement(cv::MORPH_ELLIPSE, {9, 9}));
  const auto roughness = [&](const Fundus& picture) {
    cv::Mat green;
    cv::Mat smooth;
    cv::extractChannel(picture.bgr, green, 1);
    cv::GaussianBlur(green, smooth, {}, 6.0);
    return cv::mean(cv::abs(green - smooth), ~away)[0];
  };
  EXPECT_LT(roughness(plain), 0.4 * roughness(fundus));
}

}  // namespace
}  // namespace eyeslam::simulation
