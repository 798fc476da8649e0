// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/vessel_drawing.h"

#include <algorithm>
#include <cmath>

namespace eyeslam::simulation {

namespace {

constexpr double kReflexFrom_px = 3.0;     // radius; thinner vessels show no line of light
constexpr double kHalfPixelSquare = 0.25;  // a pixel gathers light from half a px around its centre

// One piece of a vessel between two nodes, px.
struct Piece {
  Eigen::Vector2d from, to;
  double from_radius, to_radius;
};

void drawPiece(const Piece& piece, Vessel::Kind kind, double um_per_px, VesselPictures& pictures)
{
  cv::Mat_<float>& way = kind == Vessel::Kind::vein ? pictures.vein_um : pictures.artery_um;
  const double reflectance = kind == Vessel::Kind::vein ? 0.35 : 1.0;
  const double reach = std::max(piece.from_radius, piece.to_radius) + 1.5;
  const Eigen::Vector2d low = piece.from.cwiseMin(piece.to);
  const Eigen::Vector2d high = piece.from.cwiseMax(piece.to);
  const cv::Rect area = cv::Rect(cv::Point(cvFloor(low.x() - reach), cvFloor(low.y() - reach)),
                                 cv::Point(cvCeil(high.x() + reach) + 1, cvCeil(high.y() + reach) + 1)) &
                        cv::Rect({0, 0}, way.size());
  const Eigen::Vector2d along = piece.to - piece.from;
  const double length_square = std::max(along.squaredNorm(), 1e-9);
  for (int y = area.y; y < area.y + area.height; ++y) {
    for (int x = area.x; x < area.x + area.width; ++x) {
      const Eigen::Vector2d offset = Eigen::Vector2d(x, y) - piece.from;
      const double part = std::clamp(offset.dot(along) / length_square, 0.0, 1.0);
      const double radius = piece.from_radius + part * (piece.to_radius - piece.from_radius);
      const double square = (offset - part * along).squaredNorm();
      const double soft = radius * radius + kHalfPixelSquare;
      if (square >= soft) continue;
      const double chord = 2.0 * std::sqrt(soft - square) * radius / std::sqrt(soft);
      way(y, x) = std::max(way(y, x), static_cast<float>(chord * um_per_px));
      if (square <= std::max(radius * radius, kHalfPixelSquare)) {
        pictures.calibre_px(y, x) = std::max(pictures.calibre_px(y, x), static_cast<float>(2.0 * radius));
      }
      if (radius > kReflexFrom_px) {
        const double line = std::exp(-square / (2.0 * 0.045 * radius * radius));
        const double grown = std::min(1.0, (radius - kReflexFrom_px) / 3.0);
        pictures.reflex(y, x) = std::max(pictures.reflex(y, x), static_cast<float>(reflectance * grown * line));
      }
    }
  }
}

}  // namespace

VesselPictures drawVessels(const std::vector<Vessel>& vessels, cv::Size size, double um_per_px)
{
  VesselPictures pictures{cv::Mat_<float>(size, 0.0F), cv::Mat_<float>(size, 0.0F), cv::Mat_<float>(size, 0.0F),
                          cv::Mat_<float>(size, 0.0F)};
  for (const Vessel& vessel : vessels) {
    for (std::size_t i = 1; i < vessel.nodes.size(); ++i) {
      const VesselNode& a = vessel.nodes[i - 1];
      const VesselNode& b = vessel.nodes[i];
      drawPiece({a.place / um_per_px, b.place / um_per_px, a.radius / um_per_px, b.radius / um_per_px}, vessel.kind,
                um_per_px, pictures);
    }
  }
  return pictures;
}

}  // namespace eyeslam::simulation
