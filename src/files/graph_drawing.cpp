// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/graph_drawing.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "eyeslam/retina/units.h"

namespace eyeslam::files {
namespace {

using fixtures::CenterlinePoint;
using fixtures::Vessel;

const cv::Scalar kJunctionColour{255, 255, 255};
const cv::Scalar kEndColour{60, 60, 255};

/// Light colours around the circle, far apart for neighbouring ids.
cv::Scalar colourOf(int id)
{
  constexpr double kGoldenTurn = 0.61803398875;
  const double hue = std::fmod(kGoldenTurn * id, 1.0);
  const auto channel = [hue](double shift) { return 175.0 + 80.0 * std::cos(kTwoPi * (hue - shift)); };
  return {channel(0.0), channel(1.0 / 3.0), channel(2.0 / 3.0)};
}

cv::Point2d place(const Eigen::Vector2d& map_px, const PictureGeometry& geometry)
{
  return {(map_px.x() - geometry.origin_x) / geometry.px_per_cell,
          (map_px.y() - geometry.origin_y) / geometry.px_per_cell};
}

void drawVessel(VectorPicture& picture, const Vessel& vessel, const PictureGeometry& geometry, const GraphStyle& style)
{
  std::vector<cv::Point2d> line;
  line.reserve(vessel.points.size());
  for (const CenterlinePoint& point : vessel.points) line.push_back(place(point.position_px, geometry));
  picture.line(line, {colourOf(vessel.id), style.line_px});
  if (vessel.ends[0] == Vessel::kNoJunction) picture.disc(line.front(), style.end_px, {kEndColour});
  if (vessel.ends[1] == Vessel::kNoJunction) picture.disc(line.back(), style.end_px, {kEndColour});
}

// Beside the middle of the vessel, on the side to which its normal points.
void drawId(VectorPicture& picture, const Vessel& vessel, const PictureGeometry& geometry, const GraphStyle& style)
{
  const CenterlinePoint& middle = vessel.points[vessel.points.size() / 2];
  const Eigen::Vector2d normal(-middle.tangent.y(), middle.tangent.x());
  const cv::Point2d at = place(middle.position_px + (middle.radius_px + geometry.px_per_cell) * normal, geometry);
  picture.words(std::to_string(vessel.id), at, style.words_px, {colourOf(vessel.id)});
}

}  // namespace

cv::Mat dimMapPicture(const retina::VesselMap& map)
{
  if (map.empty()) return cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(0));
  constexpr double kDim = 0.33;
  cv::Mat_<std::uint8_t> cells(map.height, map.width);
  for (std::size_t i = 0; i < map.probability.size(); ++i) {
    cells.data[i] = static_cast<std::uint8_t>(kDim * map.probability[i]);
  }
  cv::Mat picture;
  cv::cvtColor(cells, picture, cv::COLOR_GRAY2BGR);
  return picture;
}

void drawGraph(VectorPicture& picture, const fixtures::VesselNetwork& network, const PictureGeometry& geometry,
               const GraphStyle& style)
{
  for (const Vessel& vessel : network.vessels) drawVessel(picture, vessel, geometry, style);
  for (const fixtures::Junction& junction : network.junctions) {
    picture.disc(place(junction.position_px, geometry), style.junction_px, {kJunctionColour});
  }
  if (style.words_px <= 0.0) return;
  for (const Vessel& vessel : network.vessels) {
    if (vessel.length_px() >= style.least_named_px) drawId(picture, vessel, geometry, style);
  }
}

}  // namespace eyeslam::files
