// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/alignment_template.h"

namespace eyeslam::tracking {

namespace {

constexpr float kBorder_px = 5.0F;  // so that a pixel stays inside while the pose moves by a little

// Tells which map pixels a frame at a given pose shows.
class Visibility {
 public:
  Visibility(const MaskedContrast& frame, const retina::Pose2& map_T_frame)
      : frame_(frame),
        linear_(map_T_frame.inverse().linear().cast<float>()),
        shift_(map_T_frame.translation().cast<float>()),
        centre_(frame.centre().cast<float>()),
        right_(static_cast<float>(frame.width() - 1) - kBorder_px),
        bottom_(static_cast<float>(frame.height() - 1) - kBorder_px)
  {}

  // x, y: centred map px.
  bool operator()(float x, float y) const
  {
    const Eigen::Vector2f p = linear_ * (Eigen::Vector2f(x, y) - shift_) + centre_;
    if (!(p.x() >= kBorder_px && p.y() >= kBorder_px && p.x() <= right_ && p.y() <= bottom_)) return false;
    return frame_.isVisible(static_cast<int>(p.x() + 0.5F), static_cast<int>(p.y() + 0.5F));
  }

 private:
  const MaskedContrast& frame_;
  Eigen::Matrix2f linear_;
  Eigen::Vector2f shift_, centre_;
  float right_, bottom_;
};

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

void collectTemplate(const Mosaic& mosaic, const MaskedContrast& frame, const retina::Pose2& map_T_frame,
                     AlignmentTemplate& pixels)
{
  pixels.clear();
  const Visibility visible(frame, map_T_frame);
  const cv::Rect box = viewBox(frame.size(), map_T_frame, mosaic.centre());
  const Eigen::Vector2f centre = mosaic.centre().cast<float>();
  for (int ty = floorDivide(box.y, Mosaic::kTile); ty <= floorDivide(box.br().y - 1, Mosaic::kTile); ++ty) {
    for (int tx = floorDivide(box.x, Mosaic::kTile); tx <= floorDivide(box.br().x - 1, Mosaic::kTile); ++tx) {
      const Mosaic::Tile* tile = mosaic.tiles().find(tx, ty);
      if (!tile) continue;
      const std::size_t begin = pixels.size();
      for (const Mosaic::TemplatePixel& pixel : tile->pixels) {
        const float x = pixel.x - centre.x(), y = pixel.y - centre.y();
        if (pixel.valid && visible(x, y)) pixels.push(x, y, pixel.value, pixel.gx, pixel.gy);
      }
      if (pixels.size() > begin) pixels.cluster_begins.push_back(begin);
    }
  }
}

void selectVisible(const AlignmentTemplate& pixels, const MaskedContrast& frame, const retina::Pose2& map_T_frame,
                   AlignmentTemplate& visible_pixels)
{
  visible_pixels.clear();
  const Visibility visible(frame, map_T_frame);
  for (std::size_t c = 0; c < pixels.cluster_begins.size(); ++c) {
    const std::size_t begin = visible_pixels.size();
    for (std::size_t i = pixels.cluster_begins[c]; i < pixels.clusterEnd(c); ++i) {
      if (!visible(pixels.x[i], pixels.y[i])) continue;
      visible_pixels.push(pixels.x[i], pixels.y[i], pixels.value[i], pixels.gx[i], pixels.gy[i]);
    }
    if (visible_pixels.size() > begin) visible_pixels.cluster_begins.push_back(begin);
  }
}

}  // namespace eyeslam::tracking
