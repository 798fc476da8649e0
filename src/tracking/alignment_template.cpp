// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/alignment_template.h"

namespace eyeslam::tracking {

namespace {

constexpr float kBorder_px = 5.0F;  // so that a pixel stays inside while the pose moves by a little

}  // namespace

void AlignmentTemplate::clear()
{
  for (auto* field : {&x, &y, &value, &gx, &gy}) field->clear();
  cluster_begins.clear();
}

void AlignmentTemplate::reserve(std::size_t pixels)
{
  for (auto* field : {&x, &y, &value, &gx, &gy}) field->reserve(pixels);
  cluster_begins.reserve(pixels / 16 + 64);
}

void AlignmentTemplate::push(float px, float py, float pixel_value, float pixel_gx, float pixel_gy)
{
  x.push_back(px);
  y.push_back(py);
  value.push_back(pixel_value);
  gx.push_back(pixel_gx);
  gy.push_back(pixel_gy);
}

void collectTemplate(const Mosaic& mosaic, const Frame& frame, const OcclusionMask& mask,
                     const retina::Pose2& map_T_frame, AlignmentTemplate& pixels)
{
  pixels.clear();
  const cv::Rect box = viewBox({frame.width(), frame.height()}, map_T_frame, mosaic.centre());
  const Eigen::Matrix2f linear = map_T_frame.inverse().linear().cast<float>();
  const Eigen::Vector2f shift = (map_T_frame.translation() + mosaic.centre()).cast<float>();
  const Eigen::Vector2f frame_centre = frame.centre().cast<float>();
  const Eigen::Vector2f map_centre = mosaic.centre().cast<float>();
  const float right = static_cast<float>(frame.width() - 1) - kBorder_px;
  const float bottom = static_cast<float>(frame.height() - 1) - kBorder_px;
  const cv::Mat_<std::uint8_t>& hidden = mask.cells();
  for (int ty = floorDivide(box.y, Mosaic::kTile); ty <= floorDivide(box.br().y - 1, Mosaic::kTile); ++ty) {
    for (int tx = floorDivide(box.x, Mosaic::kTile); tx <= floorDivide(box.br().x - 1, Mosaic::kTile); ++tx) {
      const Mosaic::Tile* tile = mosaic.tiles().find(tx, ty);
      if (!tile) continue;
      const std::size_t begin = pixels.size();
      for (const Mosaic::TemplatePixel& pixel : tile->pixels) {
        if (!pixel.valid) continue;
        const Eigen::Vector2f p = linear * (Eigen::Vector2f(pixel.x, pixel.y) - shift) + frame_centre;
        if (!(p.x() >= kBorder_px && p.y() >= kBorder_px && p.x() <= right && p.y() <= bottom)) continue;
        if (hidden(static_cast<int>(p.y() + 0.5F) / Frame::kCell, static_cast<int>(p.x() + 0.5F) / Frame::kCell))
          continue;
        pixels.push(pixel.x - map_centre.x(), pixel.y - map_centre.y(), pixel.value, pixel.gx, pixel.gy);
      }
      if (pixels.size() > begin) pixels.cluster_begins.push_back(begin);
    }
  }
}

}  // namespace eyeslam::tracking
