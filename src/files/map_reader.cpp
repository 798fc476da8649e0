// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/map_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>
#include <vector>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/image_damage.h"
#include "eyeslam/files/json_fields.h"
#include "eyeslam/files/whole_file.h"

namespace eyeslam::files {
namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t kLeastVessel = 128;  // contracts, section 3

cv::Mat pictureOf(const std::string& path, int type)
{
  const auto bytes = readWholeFile(path);
  const std::string damage = damageIn(bytes);
  if (!damage.empty()) throw FileError(path + ": " + damage);
  cv::Mat picture = cv::imdecode(bytes, type == CV_8UC1 ? cv::IMREAD_UNCHANGED : cv::IMREAD_COLOR);
  if (picture.empty()) throw FileError(path + ": is no picture");
  if (picture.type() != type) throw FileError(path + ": is no grey picture of 8 bit");
  return picture;
}

/// A picture's place, and um_per_px or 0.
std::pair<PictureGeometry, double> geometryOf(const std::string& path)
{
  const JsonFields json = JsonFields::parse(readWholeText(path), path);
  json.allowOnly({"origin_x", "origin_y", "px_per_cell", "um_per_px"});
  const PictureGeometry geometry{json.number("origin_x", -kFarthest_px, kFarthest_px),
                                 json.number("origin_y", -kFarthest_px, kFarthest_px),
                                 json.number("px_per_cell", 1e-3, 100.0)};
  return {geometry, json.isNull("um_per_px") ? 0.0 : json.number("um_per_px", 1e-3, 1e4)};
}

/// The number in "map_000123.png", or nothing.
std::optional<std::int64_t> frameIn(const std::string& name)
{
  constexpr std::string_view kHead = "map_", kTail = ".png";
  if (name.size() <= kHead.size() + kTail.size() || name.compare(0, kHead.size(), kHead) != 0 ||
      name.compare(name.size() - kTail.size(), kTail.size(), kTail) != 0) {
    return std::nullopt;
  }
  std::int64_t frame = 0;
  const char* const end = name.data() + name.size() - kTail.size();
  const auto [rest, error] = std::from_chars(name.data() + kHead.size(), end, frame);
  return error == std::errc() && rest == end && frame >= 0 ? std::optional(frame) : std::nullopt;
}

std::vector<std::int64_t> framesIn(const std::string& folder)
{
  const fs::path maps = fs::path(folder) / "map";
  std::error_code error;
  std::vector<std::int64_t> frames;
  for (const fs::directory_entry& entry : fs::directory_iterator(maps, error)) {
    if (const auto frame = frameIn(entry.path().filename().string())) frames.push_back(*frame);
  }
  if (frames.empty()) {
    throw FileError(fmt::format("{}: has no map/map_FFFFFF.png; a folder that eyeslam-track wrote is wanted", folder));
  }
  std::sort(frames.begin(), frames.end());
  return frames;
}

std::vector<std::uint8_t> cellsOf(const cv::Mat& picture)
{
  const cv::Mat whole = picture.isContinuous() ? picture : picture.clone();
  return {whole.data, whole.data + whole.total()};
}

// Twice the distance from the middle of a cell to the vessel's edge.
void fillCalibre(retina::VesselMap& map)
{
  const cv::Mat vessels = cv::Mat(map.height, map.width, CV_8UC1, map.probability.data()) >= kLeastVessel;
  map.calibre_px.assign(map.probability.size(), 0);
  if (cv::countNonZero(vessels) == 0) return;
  cv::Mat_<float> distance;
  cv::distanceTransform(vessels, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  for (int i = 0; i < static_cast<int>(map.probability.size()); ++i) {
    if (vessels.data[i] == 0) continue;
    const double calibre_px = (2.0 * distance(i) - 1.0) * map.px_per_cell;
    map.calibre_px[static_cast<std::size_t>(i)] = cv::saturate_cast<std::uint8_t>(std::max(calibre_px, 1.0));
  }
}

/// The lines of vessels.csv, laid on the cells of a map.
class VesselsReader {
 public:
  VesselsReader(const std::string& path, retina::VesselMap& map) : path_(path), map_(map) {}

  void read()
  {
    const std::string text = readWholeText(path_);
    std::string_view rest = text;
    if (nextLine(rest) != "x_px,y_px,probability,calibre_px") fail("has another head than eyeslam-track writes");
    map_.calibre_px.assign(map_.probability.size(), 0);
    while (!rest.empty()) readLine(nextLine(rest));
    const auto vessels = std::count_if(map_.probability.begin(), map_.probability.end(),
                                       [](std::uint8_t probability) { return probability >= kLeastVessel; });
    if (vessels != row_)
      fail(fmt::format("has {} rows, the map {} vessel cells: it speaks of another map", row_, vessels));
  }

 private:
  static std::string_view nextLine(std::string_view& rest)
  {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return line;
  }

  [[noreturn]] void fail(const std::string& what) const { throw FileError(path_ + ": " + what); }

  double numberIn(std::string_view& line) const
  {
    const std::size_t end = std::min(line.find(','), line.size());
    double value = 0.0;
    const auto [rest, error] = std::from_chars(line.data(), line.data() + end, value);
    if (error != std::errc() || rest != line.data() + end || !std::isfinite(value)) {
      fail(fmt::format("row {}: '{}' is not a number", row_, line.substr(0, end)));
    }
    line.remove_prefix(std::min(end + 1, line.size()));
    return value;
  }

  void readLine(std::string_view line)
  {
    ++row_;
    const double x_px = numberIn(line), y_px = numberIn(line), probability = numberIn(line);
    const double calibre_px = numberIn(line);
    const double column = (x_px - map_.origin_x) / map_.px_per_cell, row = (y_px - map_.origin_y) / map_.px_per_cell;
    constexpr double kRounded = 0.01;  // cells: three decimals of a px
    const bool on_cell = std::abs(column - std::round(column)) < kRounded && std::abs(row - std::round(row)) < kRounded;
    if (!on_cell || column < -0.5 || row < -0.5 || column > map_.width - 0.5 || row > map_.height - 0.5) {
      fail(fmt::format("row {}: x_px, y_px is no cell of the map: it speaks of another map", row_));
    }
    const std::size_t cell = map_.index(static_cast<int>(std::round(column)), static_cast<int>(std::round(row)));
    if (std::abs(map_.probability[cell] / 255.0 - probability) > 1e-3) {
      fail(fmt::format("row {}: probability is not the map's: it speaks of another map", row_));
    }
    map_.calibre_px[cell] = cv::saturate_cast<std::uint8_t>(calibre_px);
  }

  std::string path_;
  retina::VesselMap& map_;
  std::int64_t row_ = 0;
};

/// The hash of the video that a run was made from, or empty.
std::string trackOf(const std::string& folder)
{
  const std::string path = (fs::path(folder) / "run.json").string();
  std::error_code error;
  if (!fs::exists(path, error)) return {};
  const JsonFields input = JsonFields::parse(readWholeText(path), path).object("input");
  if (input.isNull("sha256")) return {};  // a camera
  std::string hash = input.text("sha256");
  if (hash.size() == 64 && hash.find_first_not_of("0123456789abcdef") == std::string::npos) return hash;
  throw FileError(path + ": input.sha256: is no SHA-256, 64 hexadecimal digits");
}

}  // namespace

RecordedMap readMap(const std::string& folder, std::optional<std::int64_t> frame)
{
  const std::vector<std::int64_t> frames = framesIn(folder);
  RecordedMap recorded;
  recorded.frame = frame.value_or(frames.back());
  const std::string name = (fs::path(folder) / fmt::format("map/map_{:06}", recorded.frame)).string();
  const std::string seen_path = (fs::path(folder) / fmt::format("map/seen_{:06}.png", recorded.frame)).string();
  recorded.path = name + ".png";
  recorded.track = trackOf(folder);
  const cv::Mat cells = pictureOf(recorded.path, CV_8UC1);
  const cv::Mat seen = pictureOf(seen_path, CV_8UC1);
  if (seen.size() != cells.size()) {
    throw FileError(
        fmt::format("{}: is {} x {} cells, the map {} x {}", seen_path, seen.cols, seen.rows, cells.cols, cells.rows));
  }
  retina::VesselMap& map = recorded.map;
  const auto [geometry, um_per_px] = geometryOf(name + ".json");
  map.width = cells.cols;
  map.height = cells.rows;
  map.origin_x = geometry.origin_x;
  map.origin_y = geometry.origin_y;
  map.px_per_cell = geometry.px_per_cell;
  map.um_per_px = um_per_px;
  map.probability = cellsOf(cells);
  map.seen = cellsOf(seen);
  const std::string vessels = (fs::path(folder) / "vessels.csv").string();
  std::error_code error;
  if (recorded.frame == frames.back() && fs::exists(vessels, error)) {
    VesselsReader(vessels, map).read();
  } else {
    fillCalibre(map);
  }
  return recorded;
}

std::optional<RecordedMosaic> readMosaic(const std::string& folder)
{
  const std::string path = (fs::path(folder) / "mosaic.png").string();
  std::error_code error;
  if (!fs::exists(path, error)) return std::nullopt;
  return RecordedMosaic{pictureOf(path, CV_8UC3), geometryOf((fs::path(folder) / "mosaic.json").string()).first};
}

RecordedMosaic readPlacedPicture(const std::string& path)
{
  RecordedMosaic placed{pictureOf(path, CV_8UC3), {}};
  const std::string place = fs::path(path).replace_extension(".json").string();
  std::error_code error;
  if (fs::exists(place, error)) placed.geometry = geometryOf(place).first;
  return placed;
}

}  // namespace eyeslam::files
