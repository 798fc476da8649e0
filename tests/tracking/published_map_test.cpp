// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/published_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>

namespace eyeslam::tracking {
namespace {

constexpr int kWidth = 800, kHeight = 608;  // full px
constexpr double kPerCell = 2.0;            // full px; frames are halved

// How bright the green of a point (full px) is, as a share of the background.
using Scene = std::function<double(double, double)>;

cv::Mat picture(const Scene& green, double noise, int seed = 1)
{
  cv::Mat rough(kHeight, kWidth, CV_32F);
  cv::RNG random(static_cast<std::uint64_t>(seed));
  random.fill(rough, cv::RNG::NORMAL, 0.0, noise);
  cv::Mat image(kHeight, kWidth, CV_8UC3);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double g = 90.0 * green(x, y) + static_cast<double>(rough.at<float>(y, x));
      image.at<cv::Vec3b>(y, x) = {30, cv::saturate_cast<uchar>(g), 190};
    }
  }
  cv::GaussianBlur(image, image, {}, 1.0);
  return image;
}

// A dark band of this width, its middle `off` px from the point.
double vessel(double off, double width, double depth) { return std::abs(off) <= width / 2 ? 1.0 - depth : 1.0; }

class Retina {
 public:
  Retina(const Scene& green, double noise) { show(picture(green, noise)); }

  void show(const cv::Mat& image, const retina::Pose2& mosaic_T_frame = {})
  {
    frame_.assign(image);
    mask_.update(frame_);
    frame_.normalise(mask_);
    if (mosaic_.empty()) {
      mosaic_.start({frame_, mask_});
    } else {
      for (int number = 0; number < 8; ++number) mosaic_.blend({frame_, mask_}, mosaic_T_frame, 20.0, number);
    }
  }
  void countView(PublishedMap& map, const retina::Pose2& mosaic_T_frame = {}) const
  {
    map.observe(mask_, {frame_.width(), frame_.height()}, mosaic_.centre(), mosaic_T_frame);
  }
  const Mosaic& mosaic() const { return mosaic_; }

 private:
  Frame frame_;
  OcclusionMask mask_;
  Mosaic mosaic_;
};

retina::VesselMap finished(const Retina& retina)
{
  PublishedMap map;
  map.start(kPerCell);
  map.finish(retina.mosaic());
  return map.map();
}

std::size_t cellAt(const retina::VesselMap& map, double x_px, double y_px)
{
  const auto column = static_cast<int>(std::lround((x_px - map.origin_x) / map.px_per_cell));
  const auto row = static_cast<int>(std::lround((y_px - map.origin_y) / map.px_per_cell));
  return map.index(column, row);
}

std::ptrdiff_t claimed(const retina::VesselMap& map)
{
  return std::count_if(map.probability.begin(), map.probability.end(), [](std::uint8_t p) { return p >= 128; });
}

std::ptrdiff_t seenCells(const Retina& retina)
{
  const cv::Rect all = retina.mosaic().bounds();
  cv::Mat_<std::int16_t> mean;
  cv::Mat_<std::uint8_t> count;
  retina.mosaic().read(all, mean, count);
  return cv::countNonZero(count);
}

void expectSameMap(const retina::VesselMap& a, const retina::VesselMap& b)
{
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.origin_x, b.origin_x);
  EXPECT_EQ(a.origin_y, b.origin_y);
  EXPECT_EQ(a.probability, b.probability);
  EXPECT_EQ(a.calibre_px, b.calibre_px);
}

// Two straight vessels and a bent one.
double network(double x, double y)
{
  const double bent = y - 300.0 - 40.0 * std::sin(x / 90.0);
  return std::min({vessel(x - 200.0, 12.0, 0.25), vessel(0.8 * (x - 500.0) - 0.6 * (y - 100.0), 8.0, 0.2),
                   vessel(bent, 10.0, 0.22)});
}

class DrawnVessel : public testing::TestWithParam<int> {};

TEST_P(DrawnVessel, IsFoundInFullWidthWithItsCalibre)
{
  const int width = GetParam();
  // Contrast rises with calibre as on the photographs (docs/vessel_map.md).
  const double depth = 0.08 + 0.008 * width;
  const Retina retina([&](double x, double y) { return vessel(y - 300.3 - 0.2 * x, width * 1.02, depth); }, 3.0);
  const retina::VesselMap map = finished(retina);
  std::vector<double> across, calibre;
  int found = 0, places = 0;
  for (double x = 100.0; x < 700.0; x += 10.0, ++places) {
    const std::size_t middle = cellAt(map, x, 300.3 + 0.2 * x);
    if (map.probability[middle] < 128) continue;
    ++found;
    calibre.push_back(map.calibre_px[middle]);
    int cells = 0;
    for (double y = -40.0; y <= 40.0; y += kPerCell)
      cells += map.probability[cellAt(map, x, 300.3 + 0.2 * x + y)] >= 128;
    across.push_back(cells * kPerCell / 1.02);
  }
  ASSERT_GE(found, places * 95 / 100);
  const auto median = [](std::vector<double> v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  // Widths follow the labels of photographs, whose vessels have softer edges than a drawn band.
  constexpr double kOneCell_px = 2.0;
  EXPECT_NEAR(median(calibre), width, kOneCell_px);
  EXPECT_NEAR(median(across), width, kOneCell_px);
}

INSTANTIATE_TEST_SUITE_P(OfEachWidth, DrawnVessel, testing::Values(6, 8, 10, 12, 16, 20),
                         testing::PrintToStringParamName());

TEST(PublishedMap, ClaimsNothingOnNoise)
{
  const Retina retina([](double, double) { return 1.0; }, 6.0);
  EXPECT_EQ(claimed(finished(retina)), 0);
}

TEST(PublishedMap, ClaimsNothingOnTheEdgeOfTheDisc)
{
  const Retina retina(
      [](double x, double y) { return 1.0 + 0.5 / (1.0 + std::exp((std::hypot(x - 400.0, y - 300.0) - 170.0) / 6.0)); },
      3.0);
  EXPECT_LT(static_cast<double>(claimed(finished(retina))), 0.001 * static_cast<double>(seenCells(retina)));
}

TEST(PublishedMap, ClaimsNothingOnTheGhostOfABloom)
{
  const Retina retina(
      [](double x, double y) {
        return 1.0 + 0.4 * std::exp(-(std::pow((x - 300.0) / 40.0, 2) + std::pow((y - 250.0) / 25.0, 2))) -
               0.15 * std::exp(-(std::pow((x - 420.0) / 50.0, 2) + std::pow((y - 330.0) / 50.0, 2)));
      },
      3.0);
  EXPECT_LT(static_cast<double>(claimed(finished(retina))), 0.001 * static_cast<double>(seenCells(retina)));
}

TEST(PublishedMap, IsTheSameBySlicesOfAnySizeAndInOneGo)
{
  const Retina retina(network, 3.0);
  const retina::VesselMap whole = finished(retina);
  ASSERT_GT(claimed(whole), 2000);
  for (const int work : {1, 40, 1000}) {
    PublishedMapOptions options;
    options.slice_work = work;
    PublishedMap map(options);
    map.start(kPerCell);
    for (int slice = 0; slice < 20000 / work + 40; ++slice) map.slice(retina.mosaic());
    expectSameMap(map.map(), whole);
  }
}

TEST(PublishedMap, IsTheSameWhenTheMosaicChangedBetweenTheSlices)
{
  Retina retina(network, 3.0);
  PublishedMap map;
  map.start(kPerCell);
  for (int slice = 0; slice < 5; ++slice) map.slice(retina.mosaic());
  retina.show(picture(network, 3.0, 2));
  map.finish(retina.mosaic());
  expectSameMap(map.map(), finished(retina));
}

TEST(PublishedMap, KeepsWhatItFoundWhereItWasWhenItGrows)
{
  Retina retina(network, 3.0);
  PublishedMap map;
  map.start(kPerCell);
  map.finish(retina.mosaic());
  const retina::VesselMap before = map.map();
  map.observe(OcclusionMask(), {400, 304}, retina.mosaic().centre(), {-300.0, -200.0, 0.0, 1.0});
  const retina::VesselMap& after = map.map();
  EXPECT_GT(after.width, before.width);
  EXPECT_GT(after.height, before.height);
  for (int row = 0; row < before.height; ++row) {
    for (int column = 0; column < before.width; ++column) {
      const std::size_t then = before.index(column, row);
      const std::size_t now = cellAt(after, before.origin_x + column * kPerCell, before.origin_y + row * kPerCell);
      ASSERT_EQ(after.probability[now], before.probability[then]);
      ASSERT_EQ(after.calibre_px[now], before.calibre_px[then]);
    }
  }
}

TEST(PublishedMap, CountsTheViewsOfACell)
{
  const Retina retina(network, 3.0);
  PublishedMap map;
  map.start(kPerCell);
  for (int view = 0; view < 3; ++view) retina.countView(map);
  for (int view = 0; view < 260; ++view) retina.countView(map, {100.0, 0.0, 0.0, 1.0});
  EXPECT_EQ(map.map().seen[cellAt(map.map(), 100.0, 300.0)], 3);
  EXPECT_EQ(map.map().seen[cellAt(map.map(), 900.0, 300.0)], 255);
  EXPECT_EQ(map.map().seen[cellAt(map.map(), -20.0, 300.0)], 0);
}

TEST(PublishedMap, HasItsFirstCellWhereFrame0HasThatPixel)
{
  const Retina retina(network, 3.0);
  const retina::VesselMap map = finished(retina);
  // Pixel 0 of a halved frame covers full px 0 and 1: its centre is at 0.5.
  EXPECT_DOUBLE_EQ(std::remainder(map.origin_x - 0.5, MapVesselDetector::kBlock * kPerCell), 0.0);
  EXPECT_DOUBLE_EQ(std::remainder(map.origin_y - 0.5, MapVesselDetector::kBlock * kPerCell), 0.0);
}

TEST(PublishedMap, FollowsTheAnchor)
{
  const Retina retina(network, 3.0);
  PublishedMap map;
  map.start(kPerCell);
  map.finish(retina.mosaic());
  const double x = map.map().origin_x, y = map.map().origin_y;
  map.moveTo({0.25, -0.5, 0.0, 1.0}, retina.mosaic().centre());
  EXPECT_NEAR(map.map().origin_x, x + 0.5, 1e-9);
  EXPECT_NEAR(map.map().origin_y, y - 1.0, 1e-9);
}

TEST(PublishedMap, IsEmptyForAnEmptyMosaic)
{
  PublishedMap map;
  map.start(kPerCell);
  map.slice(Mosaic());
  map.finish(Mosaic());
  EXPECT_TRUE(map.map().empty());
}

TEST(PublishedMap, RestsWhenNothingChanged)
{
  const Retina retina(network, 3.0);
  PublishedMap map;
  map.start(kPerCell);
  map.finish(retina.mosaic());
  const std::uint64_t version = map.map().version;
  map.slice(retina.mosaic());
  map.finish(retina.mosaic());
  EXPECT_EQ(map.map().version, version);
}

TEST(PublishedMap, SaysThatItIsCutOffAndWorksOnWithinItsLimit)
{
  const Retina retina([](double, double) { return 1.0; }, 2.0);
  PublishedMap map;
  map.start(kPerCell);
  retina.countView(map);
  EXPECT_FALSE(map.isCutOff());
  const int first_width = map.map().width;
  for (const double far_px : {5000.0, 9000.0, 12000.0, -4000.0}) {
    retina.countView(map, {far_px, 0.0, 0.0, 1.0});
    EXPECT_LE(map.map().width, PublishedMap::kLargestSide) << far_px;
  }
  EXPECT_TRUE(map.isCutOff());
  EXPECT_EQ(map.map().width, PublishedMap::kLargestSide);
  EXPECT_GT(map.map().width, first_width) << "what there is room for is taken in";
  const std::size_t at = cellAt(map.map(), kWidth / 2.0, kHeight / 2.0);
  const int before = map.map().seen[at];
  retina.countView(map);
  EXPECT_EQ(map.map().seen[at], before + 1) << "not frozen";
}

}  // namespace
}  // namespace eyeslam::tracking
