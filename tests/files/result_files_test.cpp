// SPDX-License-Identifier: GPL-3.0-or-later
// The files of contracts, section 3, against values set by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/map_files.h"
#include "eyeslam/files/pixel_size.h"
#include "eyeslam/files/trajectory_file.h"
#include "support/temporary_folder.h"

namespace eyeslam::files {
namespace {

nlohmann::json readJson(const std::string& path) { return nlohmann::json::parse(std::ifstream(path)); }

TEST(TrajectoryFile, WritesDegreesAndPixels)
{
  TrajectoryRow row;
  row.frame = 12;
  row.t = 0.4;
  row.result.tracked = true;
  row.result.map_T_frame = {1.5, -2.25, M_PI / 6.0, 1.01};
  row.result.covariance.diagonal() << 0.04, 0.09, std::pow(M_PI / 180.0, 2);
  row.result.points = 250;
  row.result.score = 0.5;
  row.cpu_ms = 0.75;
  row.map_cpu_ms = 2.0;
  EXPECT_EQ(trajectoryLine(row),
            "12,0.400000,1,1.50000,-2.25000,30.000000,1.010000,0.20000,0.30000,1.000000,250,0.5000,,0.7500,2.0000");
}

TEST(TrajectoryFile, NamesTheReasonOfAFrameNotTracked)
{
  TrajectoryRow row;
  row.result.reason = retina::Reason::blackout;
  EXPECT_THAT(trajectoryLine(row), ::testing::HasSubstr(",blackout,"));
}

TEST(TrajectoryFile, HasAsManyFieldsAsItsHeader)
{
  const std::string header = trajectoryHeader();
  const std::string line = trajectoryLine({});
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(line.begin(), line.end(), ','));
}

TEST(TrajectoryFile, SaysThatADiskIsFull)
{
  TrajectoryFile file("/dev/full", "out/trajectory.csv");
  try {
    file.close();
    FAIL();
  } catch (const FileError& error) {
    EXPECT_STREQ(error.what(), "out/trajectory.csv: cannot be written: No space left on device");
  }
}

retina::VesselMap smallMap()
{
  retina::VesselMap map;
  map.width = 3;
  map.height = 2;
  map.origin_x = -10.5;
  map.origin_y = 4.0;
  map.px_per_cell = 2.0;
  map.probability = {0, 127, 128, 255, 10, 20};
  map.calibre_px = {0, 0, 7, 9, 0, 0};
  map.seen = {0, 1, 2, 3, 4, 255};
  return map;
}

class MapFiles : public ::testing::Test {
 protected:
  void write(const retina::VesselMap& map, const PixelSize& pixel_size)
  {
    OutputFolder folder(out_, {});
    writeMap(folder, map, 42, pixel_size);
    folder.publish();
  }
  cv::Mat picture(const std::string& name) { return cv::imread(out_ + "/map/" + name, cv::IMREAD_UNCHANGED); }

  support::TemporaryFolder temporary_;
  std::string out_ = temporary_.path("out");
};

TEST_F(MapFiles, HoldTheCellsAndWhereTheyLie)
{
  write(smallMap(), {4.5, "test"});
  const cv::Mat cells = picture("map_000042.png");
  ASSERT_EQ(cells.size(), cv::Size(3, 2));
  EXPECT_EQ(cells.at<std::uint8_t>(0, 2), 128);
  EXPECT_EQ(cells.at<std::uint8_t>(1, 0), 255);
  EXPECT_EQ(picture("seen_000042.png").at<std::uint8_t>(1, 2), 255);
  const nlohmann::json expected = {{"origin_x", -10.5}, {"origin_y", 4.0}, {"px_per_cell", 2.0}, {"um_per_px", 4.5}};
  EXPECT_EQ(readJson(out_ + "/map/map_000042.json"), expected);
}

TEST_F(MapFiles, OfAnEmptyMapAreOneCellNeverSeen)
{
  write({}, {std::nullopt, "unknown"});
  ASSERT_EQ(picture("map_000042.png").size(), cv::Size(1, 1));
  EXPECT_EQ(picture("map_000042.png").at<std::uint8_t>(0, 0), 0);
  EXPECT_EQ(picture("seen_000042.png").at<std::uint8_t>(0, 0), 0);
  EXPECT_TRUE(readJson(out_ + "/map/map_000042.json").at("um_per_px").is_null());
}

TEST(VesselsCsv, ListsTheCellsFromTheThresholdOn)
{
  EXPECT_EQ(vesselsCsv(smallMap()),
            "x_px,y_px,probability,calibre_px\n-6.500,4.000,0.5020,7.00\n-10.500,6.000,1.0000,9.00\n");
}

class MetaJson : public ::testing::Test {
 protected:
  PixelSize sizeWith(const std::string& meta)
  {
    std::ofstream(folder_.path("meta.json")) << meta;
    return pixelSizeOf(folder_.path("video.mp4"), std::nullopt);
  }
  support::TemporaryFolder folder_;
};

TEST_F(MetaJson, GivesThePixelSize)
{
  EXPECT_EQ(sizeWith(R"({"um_per_px": 5.25})").um_per_px, 5.25);
  EXPECT_EQ(pixelSizeOf(folder_.path(""), std::nullopt).um_per_px, 5.25);  // an image folder
  EXPECT_EQ(pixelSizeOf(folder_.path("im*.png"), std::nullopt).source, folder_.path("meta.json"));
}

TEST_F(MetaJson, YieldsToTheCommandLine)
{
  sizeWith(R"({"um_per_px": 5.25})");
  EXPECT_EQ(pixelSizeOf(folder_.path("video.mp4"), 3.0).um_per_px, 3.0);
}

TEST_F(MetaJson, LeavesUnknownWhatItDoesNotSay)
{
  EXPECT_FALSE(pixelSizeOf(folder_.path("video.mp4"), std::nullopt).um_per_px);
  EXPECT_FALSE(sizeWith("{}").um_per_px);
  EXPECT_FALSE(sizeWith(R"({"um_per_px": null})").um_per_px);
}

TEST_F(MetaJson, IsRefusedWithAValueThatIsNoSize)
{
  for (const char* meta : {R"({"um_per_px": 0})", R"({"um_per_px": -1})", R"({"um_per_px": "5"})", "{"}) {
    EXPECT_THROW(sizeWith(meta), FileError) << meta;
  }
}

}  // namespace
}  // namespace eyeslam::files
