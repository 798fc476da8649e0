// SPDX-License-Identifier: GPL-3.0-or-later
// Maps as eyeslam-track writes them come back whole, and not at all when one of their files is wrong.
#include "eyeslam/files/map_reader.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/whole_file.h"
#include "eyeslam/retina/map_hash.h"
#include "support/planning_maps.h"
#include "support/temporary_folder.h"

namespace eyeslam::files {
namespace {

namespace fs = std::filesystem;

class MapReader : public ::testing::Test {
 protected:
  MapReader()
  {
    support::drawVessel(map_, {10.0, 0.0}, {30.0, 40.0}, 2.0, 200);
    for (std::size_t i = 0; i < map_.probability.size(); ++i) {
      if (map_.probability[i] >= 128) map_.calibre_px[i] = 9;
      map_.seen[i] = static_cast<std::uint8_t>(i % 256);
    }
    map_.origin_x = -255.50541835446813;
    write(map_, 7);
    write(map_, 120);
  }

  void write(const retina::VesselMap& map, std::int64_t frame)
  {
    OutputFolder folder(folder_.path("track"), {});
    const fs::path old = fs::path(folder_.path("track")) / "map";
    if (fs::exists(old)) fs::copy(old, folder.staged("map"), fs::copy_options::recursive);
    writeMap(folder, map, frame, {map.um_per_px, "test"});
    folder.write("vessels.csv", vesselsCsv(map));
    writeMosaic(folder, cv::Mat(20, 30, CV_8UC3, cv::Scalar(1, 2, 3)), {4.5, 5.5, 2.0}, {std::nullopt, "unknown"});
    folder.write("run.json", R"({"input": {"name": "a.mp4", "files": 1, "sha256": ")" + std::string(64, 'c') + "\"}}");
    folder.publish();
  }

  std::string path(const std::string& name) const { return folder_.path("track/" + name); }

  void expectRefused(const std::string& name, const std::string& part, const std::string& content)
  {
    const auto kept = readWholeFile(path(name));
    writeWholeFile(path(name), content);
    try {
      readMap(folder_.path("track"));
      ADD_FAILURE() << name << " " << part;
    } catch (const FileError& error) {
      EXPECT_THAT(error.what(), ::testing::StartsWith(path(name)));
      EXPECT_THAT(error.what(), ::testing::HasSubstr(part));
    }
    writeWholeFile(path(name), kept.data(), kept.size());
  }

  std::string textOf(const std::string& name) const
  {
    const auto bytes = readWholeFile(path(name));
    return {bytes.begin(), bytes.end()};
  }

  support::TemporaryFolder folder_;
  retina::VesselMap map_ = support::emptyMap(50, 40);
};

TEST_F(MapReader, ReadsTheNewestMapWithItsHash)
{
  const RecordedMap recorded = readMap(folder_.path("track"));
  EXPECT_EQ(recorded.frame, 120);
  EXPECT_EQ(retina::hashOf(recorded.map), retina::hashOf(map_));
  EXPECT_EQ(recorded.map.calibre_px, map_.calibre_px);
  EXPECT_EQ(recorded.map.um_per_px, 5.0);
  EXPECT_EQ(recorded.track, std::string(64, 'c'));
}

TEST_F(MapReader, MeasuresTheCalibreOfAnOlderMap)
{
  const RecordedMap recorded = readMap(folder_.path("track"), 7);
  EXPECT_EQ(recorded.frame, 7);
  // A vessel of half width 2 cells of 2 px: about 8 px in its middle.
  EXPECT_NEAR(recorded.map.calibre_px[map_.index(20, 20)], 8.0, 2.0);
  EXPECT_EQ(recorded.map.calibre_px[map_.index(45, 5)], 0);
}

TEST_F(MapReader, ReadsTheMosaicWhereThereIsOne)
{
  const auto mosaic = readMosaic(folder_.path("track"));
  ASSERT_TRUE(mosaic.has_value());
  EXPECT_EQ(mosaic->picture.size(), cv::Size(30, 20));
  EXPECT_EQ(mosaic->geometry.origin_x, 4.5);
  fs::remove(path("mosaic.png"));
  EXPECT_FALSE(readMosaic(folder_.path("track")).has_value());
}

TEST_F(MapReader, NamesTheFileAndTheFieldThatAreWrong)
{
  const std::string geometry = "map/map_000120.json", cells = "map/map_000120.png", seen = "map/seen_000120.png";
  expectRefused(geometry, "origin_x: is missing", R"({"origin_y": 1, "px_per_cell": 2, "um_per_px": null})");
  expectRefused(geometry, "px_per_cell", R"({"origin_x": 1, "origin_y": 1, "px_per_cell": -2, "um_per_px": null})");
  expectRefused(geometry, "um_per_px", R"({"origin_x": 1, "origin_y": 1, "px_per_cell": 2, "um_per_px": "5"})");
  expectRefused(geometry, "is no JSON", textOf(geometry).substr(0, 30));
  expectRefused(cells, "", textOf(cells).substr(0, 100));
  expectRefused(cells, "", "no picture");
  expectRefused(cells, "grey", textOf("mosaic.png"));
  expectRefused(seen, "", textOf(seen).substr(0, textOf(seen).size() - 20));
  expectRefused("vessels.csv", "row 1", "x_px,y_px,probability,calibre_px\n1e5,3,0.7,9\n");
  expectRefused("vessels.csv", "another map", "x_px,y_px,probability,calibre_px\n");
  expectRefused("vessels.csv", "row 1", "x_px,y_px,probability,calibre_px\nx,3,0.7,9\n");
  expectRefused("vessels.csv", "head", "frame,x\n");
  expectRefused("run.json", "input", "{}");
}

TEST_F(MapReader, NamesASeenPictureOfAnotherMap)
{
  retina::VesselMap other = support::emptyMap(51, 40);
  write(other, 300);
  fs::copy(path("map/seen_000300.png"), path("map/seen_000120.png"), fs::copy_options::overwrite_existing);
  fs::remove(path("map/map_000300.png"));
  EXPECT_THROW(readMap(folder_.path("track")), FileError);
}

TEST_F(MapReader, SaysThatAFolderHasNoMap)
{
  EXPECT_THROW(readMap(folder_.path("nowhere")), FileError);
  EXPECT_THROW(readMap(folder_.path("track"), 8), FileError);
}

TEST(MapHash, IsThatOfTheDocumentedBytes)
{
  // sha256 of struct.pack("<iiddd", 2, 1, 0.5, -1.25, 2.0) + bytes([0, 255]) + bytes([3, 4]), by Python's hashlib.
  retina::VesselMap map;
  map.width = 2;
  map.height = 1;
  map.origin_x = 0.5;
  map.origin_y = -1.25;
  map.px_per_cell = 2.0;
  map.probability = {0, 255};
  map.seen = {3, 4};
  EXPECT_EQ(retina::hashOf(map), "75060b755b6dd17487a887bc00cb38e7d2053cf664260b55881130a8726615e2");
}

TEST(MapHash, ChangesWithEveryCellAndEveryNumberOfTheGeometry)
{
  const retina::VesselMap map = support::emptyMap(8, 6);
  const auto changes = [&map](const std::function<void(retina::VesselMap&)>& change) {
    retina::VesselMap other = map;
    change(other);
    return retina::hashOf(other) != retina::hashOf(map);
  };
  EXPECT_TRUE(changes([](auto& m) { m.probability[47] = 1; }));
  EXPECT_TRUE(changes([](auto& m) { m.seen[0] = 101; }));
  EXPECT_TRUE(changes([](auto& m) { m.origin_x = std::nextafter(m.origin_x, 10.0); }));
  EXPECT_TRUE(changes([](auto& m) { m.origin_y = 0.0; }));
  EXPECT_TRUE(changes([](auto& m) { m.px_per_cell = 1.0; }));
  EXPECT_TRUE(changes([](auto& m) { std::swap(m.width, m.height); }));
  EXPECT_FALSE(changes([](auto& m) { m.um_per_px = 6.0; })) << "a plan says its scale itself";
  EXPECT_FALSE(changes([](auto& m) { m.version = 9; }));
}

}  // namespace
}  // namespace eyeslam::files
