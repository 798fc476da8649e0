// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/map_files.h"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

namespace eyeslam::files {
namespace {

// A view of the cells, or one empty cell: a picture has at least one pixel.
cv::Mat picture(const retina::VesselMap& map, const std::vector<std::uint8_t>& cells)
{
  if (map.empty()) return cv::Mat::zeros(1, 1, CV_8UC1);
  return cv::Mat(cells, false).reshape(1, map.height);
}

}  // namespace

std::string geometryJson(const PictureGeometry& geometry, const PixelSize& pixel_size)
{
  nlohmann::ordered_json json;
  json["origin_x"] = geometry.origin_x;
  json["origin_y"] = geometry.origin_y;
  json["px_per_cell"] = geometry.px_per_cell;
  json["um_per_px"] = nullptr;
  if (pixel_size.um_per_px) json["um_per_px"] = *pixel_size.um_per_px;
  return json.dump(2) + "\n";
}

void writeMap(const OutputFolder& folder, const retina::VesselMap& map, std::int64_t frame, const PixelSize& pixel_size)
{
  const std::string name = fmt::format("map/map_{:06}", frame);
  folder.writePng(name + ".png", picture(map, map.probability));
  folder.write(name + ".json", geometryJson({map.origin_x, map.origin_y, map.px_per_cell}, pixel_size));
  folder.writePng(fmt::format("map/seen_{:06}.png", frame), picture(map, map.seen));
}

std::string vesselsCsv(const retina::VesselMap& map)
{
  std::string text = "x_px,y_px,probability,calibre_px\n";
  for (const retina::MapPoint& point : retina::vesselPoints(map)) {
    fmt::format_to(std::back_inserter(text), "{:.3f},{:.3f},{:.4f},{:.2f}\n", point.x_px, point.y_px, point.probability,
                   point.calibre_px);
  }
  return text;
}

void writeMosaic(const OutputFolder& folder, const cv::Mat& picture, const PictureGeometry& geometry,
                 const PixelSize& pixel_size)
{
  folder.writePng("mosaic.png", picture.empty() ? cv::Mat::zeros(1, 1, CV_8UC3) : picture);
  folder.write("mosaic.json", geometryJson(geometry, pixel_size));
}

}  // namespace eyeslam::files
