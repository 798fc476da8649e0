// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/mosaic_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace eyeslam::tracking {

namespace {

constexpr std::uint16_t kMostSamples = 200;  // of a cell's running mean
constexpr double kSmooth_cells = 4.0;        // vessels must not show in the colours: the contrast has them
// How much of the green contrast the other channels show; source: rendered and photographed fundi, vessel against
// background.
constexpr float kBlueShare = 0.8F, kRedShare = 0.45F;

}  // namespace

void MosaicPicture::observe(const Frame& frame, const OcclusionMask& mask, const Eigen::Vector2d& mosaic_centre,
                            const retina::Pose2& mosaic_T_frame)
{
  const cv::Mat_<std::uint8_t>& hidden = mask.cells();
  constexpr double kHalf = (Frame::kCell - 1) / 2.0;
  for (int y = 0; y < hidden.rows; ++y) {
    for (int x = 0; x < hidden.cols; ++x) {
      if (hidden(y, x) != OcclusionMask::kVisible) continue;
      const Eigen::Vector2d p(x * Frame::kCell + kHalf, y * Frame::kCell + kHalf);
      const Eigen::Vector2d m = mosaic_T_frame * (p - frame.centre()) + mosaic_centre;
      if (!(m.cwiseAbs().maxCoeff() < Mosaic::kReach)) continue;
      const int cx = static_cast<int>(std::floor(m.x() / Frame::kCell)),
                cy = static_cast<int>(std::floor(m.y() / Frame::kCell));
      const int tx = floorDivide(cx, kTile), ty = floorDivide(cy, kTile);
      Tile& tile = tiles_.at(tx, ty);
      const auto at = static_cast<std::size_t>((cy - ty * kTile) * kTile + cx - tx * kTile);
      std::uint16_t& count = tile.count[at];
      if (count < kMostSamples) ++count;
      const cv::Vec3f colour(frame.cellBlue()(y, x), static_cast<float>(frame.cellGreen()(y, x)) / 4.0F,
                             frame.cellRed()(y, x));
      tile.colour[at] += (colour - tile.colour[at]) / static_cast<float>(count);
    }
  }
}

cv::Mat_<cv::Vec3f> MosaicPicture::smoothColours(const cv::Rect& cells) const
{
  cv::Mat_<cv::Vec3f> colour(cells.size(), cv::Vec3f());
  cv::Mat_<float> known(cells.size(), 0.0F);
  for (int y = 0; y < cells.height; ++y) {
    for (int x = 0; x < cells.width; ++x) {
      const int cx = cells.x + x, cy = cells.y + y;
      const int tx = floorDivide(cx, kTile), ty = floorDivide(cy, kTile);
      const Tile* tile = tiles_.find(tx, ty);
      if (!tile) continue;
      const auto at = static_cast<std::size_t>((cy - ty * kTile) * kTile + cx - tx * kTile);
      if (tile->count[at] == 0) continue;
      colour(y, x) = tile->colour[at];
      known(y, x) = 1.0F;
    }
  }
  cv::GaussianBlur(colour, colour, {}, kSmooth_cells);
  cv::GaussianBlur(known, known, {}, kSmooth_cells);
  for (int y = 0; y < cells.height; ++y) {
    for (int x = 0; x < cells.width; ++x) colour(y, x) /= std::max(known(y, x), 1e-3F);
  }
  return colour;
}

cv::Mat MosaicPicture::draw(const Mosaic& mosaic, cv::Point& corner) const
{
  cv::Mat_<std::int16_t> mean;
  cv::Mat_<std::uint8_t> count;
  const cv::Rect all = mosaic.bounds();
  mosaic.read(all, mean, count);
  const cv::Rect seen = cv::boundingRect(count);
  corner = all.tl() + seen.tl();
  if (seen.empty()) return {};
  // A margin of whole cells, so that the colours can be interpolated to every pixel.
  const int x0 = floorDivide(corner.x, Frame::kCell) - 1, y0 = floorDivide(corner.y, Frame::kCell) - 1;
  const cv::Rect cells(x0, y0, seen.width / Frame::kCell + 4, seen.height / Frame::kCell + 4);
  cv::Mat colours;
  cv::resize(smoothColours(cells), colours, cells.size() * Frame::kCell, 0.0, 0.0, cv::INTER_LINEAR);
  const cv::Point offset = corner - cells.tl() * Frame::kCell;

  cv::Mat picture(seen.size(), CV_8UC3, cv::Scalar::all(0));
  for (int y = 0; y < seen.height; ++y) {
    const cv::Vec3f* colour = colours.ptr<cv::Vec3f>(y + offset.y) + offset.x;
    for (int x = 0; x < seen.width; ++x) {
      const cv::Point at = seen.tl() + cv::Point(x, y);
      if (count(at) == 0) continue;
      const float contrast = static_cast<float>(mean(at)) / Frame::kContrastUnit;
      const cv::Vec3f gain(1.0F + kBlueShare * contrast, 1.0F + contrast, 1.0F + kRedShare * contrast);
      picture.at<cv::Vec3b>(y, x) =
          cv::Vec3b(cv::saturate_cast<uchar>(colour[x][0] * gain[0]), cv::saturate_cast<uchar>(colour[x][1] * gain[1]),
                    cv::saturate_cast<uchar>(colour[x][2] * gain[2]));
    }
  }
  return picture;
}

}  // namespace eyeslam::tracking
