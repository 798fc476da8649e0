// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/overlay.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "eyeslam/retina/units.h"
#include "eyeslam/tracking/sub_pixel.h"
#include "eyeslam/tracking/view_geometry.h"

namespace eyeslam::tracking {

namespace {

const cv::Scalar kGround(26, 22, 20), kGutter(12, 10, 9), kInk(236, 236, 236), kQuiet(170, 166, 160);
const cv::Scalar kPoint(120, 255, 120), kView(255, 255, 255), kTrail(80, 220, 255), kToolLine(255, 200, 60);
const cv::Scalar kGood(120, 220, 120), kBad(90, 90, 255);
constexpr int kPanelGap = 4;          // px between panels
constexpr int kStatus = 30;           // px of the line below
constexpr double kViewMargin = 0.04;  // of the seen area, around it

void line(cv::Mat& picture, cv::Point2d from, cv::Point2d to, const cv::Scalar& colour, int thickness = 1)
{
  cv::line(picture, inSubPixels(from), inSubPixels(to), colour, thickness, cv::LINE_AA, kSubPixelBits);
}

void ring(cv::Mat& picture, cv::Point2d centre, double radius, const cv::Scalar& colour, int thickness = 1)
{
  cv::circle(picture, inSubPixels(centre), cvRound(radius * (1 << kSubPixelBits)), colour, thickness, cv::LINE_AA,
             kSubPixelBits);
}

/// Text on a dark plate in the top left corner.
void label(cv::Mat& panel, const std::string& text)
{
  int baseline = 0;
  const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, 0.45, 1, &baseline);
  cv::Mat plate = panel(cv::Rect(0, 0, std::min(size.width + 16, panel.cols), std::min(24, panel.rows)));
  plate.convertTo(plate, -1, 0.35);
  cv::putText(panel, text, {8, 17}, cv::FONT_HERSHEY_SIMPLEX, 0.45, kInk, 1, cv::LINE_AA);
}

/// From the ground over amber at the threshold to pale cyan where a vessel is certain.
cv::Mat probabilityPalette()
{
  const cv::Vec3f ground(26.0F, 22.0F, 20.0F), unlikely(62.0F, 58.0F, 54.0F), likely(50.0F, 205.0F, 255.0F),
      certain(235.0F, 255.0F, 130.0F);
  cv::Mat palette(256, 1, CV_8UC3);
  for (int p = 0; p < 256; ++p) {
    const float low = static_cast<float>(p) / 127.0F, high = static_cast<float>(p - 128) / 127.0F;
    const cv::Vec3f colour = p < 128 ? ground + (unlikely - ground) * low : likely + (certain - likely) * high;
    palette.at<cv::Vec3b>(p) = cv::Vec3b(colour);
  }
  return palette;
}

void toColour(const cv::Mat& image, cv::Size size, cv::Mat& small)
{
  cv::resize(image, small, size, 0.0, 0.0, cv::INTER_AREA);
  if (small.depth() == CV_16U) small.convertTo(small, CV_8U, 1.0 / 257.0);
  if (small.channels() == 1) cv::cvtColor(small, small, cv::COLOR_GRAY2BGR);
}

int even(double length) { return 2 * std::max(1, cvRound(length / 2.0)); }

}  // namespace

Overlay::Overlay(const OverlayOptions& options) : options_(options), palette_(probabilityPalette()) {}

const cv::Mat& Overlay::draw(const OverlayScene& scene)
{
  if (frame_ != scene.frame.size()) layOut(scene.frame.size());
  follow(scene);
  toColour(scene.frame, panel_, small_);
  const auto panel = [this](int column, int row) {
    return canvas_(cv::Rect({column * (panel_.width + kPanelGap), row * (panel_.height + kPanelGap)}, panel_));
  };
  drawDetections(scene, panel(0, 0));
  drawMap(scene, panel(1, 0));
  drawReprojection(scene, panel(0, 1));
  drawMosaic(scene, panel(1, 1));
  writeStatus(scene, canvas_.rowRange(canvas_.rows - kStatus, canvas_.rows));
  return canvas_;
}

void Overlay::layOut(cv::Size frame)
{
  frame_ = frame;
  const double width =
      std::min<double>(options_.panel_width, std::max(frame.width / 2.0, std::min(frame.width, 320) * 1.0));
  panel_ = {even(width), even(width * frame.height / frame.width)};
  panel_per_px_ = static_cast<double>(panel_.width) / frame.width;
  canvas_.create(2 * panel_.height + kPanelGap + kStatus, 2 * panel_.width + kPanelGap, CV_8UC3);
  canvas_.setTo(kGutter);
  seen_ = {};
  trail_.clear();
}

void Overlay::follow(const OverlayScene& scene)
{
  if (!scene.result.tracked && !seen_.empty()) return;
  for (const cv::Point2d corner : viewOutline(scene.result.map_T_frame, frame_)) {
    seen_ = seen_.empty() ? cv::Rect2d(corner, cv::Size2d(1.0, 1.0)) : seen_ | cv::Rect2d(corner, cv::Size2d(1.0, 1.0));
  }
  const cv::Matx23d map_T_image = mapFromImage(scene.result.map_T_frame, frame_);
  trail_.push_back(transformed(map_T_image, {(frame_.width - 1) / 2.0, (frame_.height - 1) / 2.0}));
  const auto longest = static_cast<std::size_t>(options_.trail_frames);
  if (trail_.size() > longest) trail_.erase(trail_.begin());
}

// Map and mosaic are shown alike: all that was seen so far fits into the panel.
cv::Matx23d Overlay::panelFromMap() const
{
  const double scale = std::min(panel_.width / seen_.width, panel_.height / seen_.height) * (1.0 - 2.0 * kViewMargin);
  const cv::Point2d middle = (seen_.tl() + seen_.br()) / 2.0;
  return {scale, 0.0,   (panel_.width - 1) / 2.0 - scale * middle.x,
          0.0,   scale, (panel_.height - 1) / 2.0 - scale * middle.y};
}

void Overlay::drawDetections(const OverlayScene& scene, cv::Mat panel) const
{
  small_.copyTo(panel);
  for (const cv::Point2f point : scene.points) {
    ring(panel, cv::Point2d(point) * panel_per_px_, 1.2, kPoint, -1);
  }
  label(panel, fmt::format("Vessel points ({})", scene.points.size()));
}

void Overlay::drawMap(const OverlayScene& scene, cv::Mat panel)
{
  panel.setTo(kGround);
  if (!scene.map.empty()) {
    const retina::VesselMap& map = scene.map;
    grid_.create(map.height, map.width, CV_8U);
    std::copy(map.probability.begin(), map.probability.end(), grid_.data);
    const cv::Matx23d cells(map.px_per_cell, 0.0, map.origin_x, 0.0, map.px_per_cell, map.origin_y);
    cv::warpAffine(grid_, warped_, chain(panelFromMap(), cells), panel_, cv::INTER_AREA);
    cv::applyColorMap(warped_, colours_, palette_);
    colours_.copyTo(panel);
  }
  drawOutline(scene, panel);
  label(panel, "Vessel map and view");
}

void Overlay::drawReprojection(const OverlayScene& scene, cv::Mat panel)
{
  small_.convertTo(panel, -1, 0.7);
  if (!scene.map.empty() && scene.result.tracked) {
    const retina::VesselMap& map = scene.map;
    const cv::Matx23d cells(map.px_per_cell, 0.0, map.origin_x, 0.0, map.px_per_cell, map.origin_y);
    const cv::Matx23d shrink(panel_per_px_, 0.0, (panel_per_px_ - 1.0) / 2.0, 0.0, panel_per_px_,
                             (panel_per_px_ - 1.0) / 2.0);
    const cv::Matx23d image_T_cell = chain(inverse(mapFromImage(scene.result.map_T_frame, frame_)), cells);
    cv::warpAffine(grid_, warped_, chain(shrink, image_T_cell), panel_, cv::INTER_LINEAR);
    cv::applyColorMap(warped_, colours_, palette_);
    cv::addWeighted(panel, 0.2, colours_, 0.8, 0.0, colours_);
    colours_.copyTo(panel, warped_ >= 128);
  }
  drawInstrument(scene.tip, panel);
  drawSpot(scene.spot, panel);
  label(panel, scene.tip.present ? "Map in the frame, instrument" : "Map in the frame");
}

void Overlay::drawMosaic(const OverlayScene& scene, cv::Mat panel)
{
  panel.setTo(kGround);
  if (!scene.mosaic.empty()) {
    const double step = scene.mosaic_px_per_pixel;
    const cv::Matx23d map_T_mosaic(step, 0.0, scene.mosaic_origin.x, 0.0, step, scene.mosaic_origin.y);
    cv::warpAffine(scene.mosaic, panel, chain(panelFromMap(), map_T_mosaic), panel_, cv::INTER_LINEAR,
                   cv::BORDER_TRANSPARENT);
    cv::inRange(panel, cv::Scalar(), cv::Scalar(), unseen_);  // the mosaic is black where nothing was seen
    panel.setTo(kGround, unseen_);
  }
  const cv::Matx23d panel_T_map = panelFromMap();
  for (std::size_t i = 1; i < trail_.size(); ++i) {
    const double age = static_cast<double>(i) / static_cast<double>(trail_.size());
    line(panel, transformed(panel_T_map, trail_[i - 1]), transformed(panel_T_map, trail_[i]),
         kTrail * (0.35 + 0.65 * age), 2);
  }
  drawOutline(scene, panel);
  if (!trail_.empty()) ring(panel, transformed(panel_T_map, trail_.back()), 3.0, kView, -1);
  label(panel, "Mosaic and path of the view");
}

void Overlay::drawInstrument(const ToolTip& tip, cv::Mat& panel) const
{
  if (!tip.present) return;
  const cv::Point2d at = cv::Point2d(tip.x_px, tip.y_px) * panel_per_px_;
  const cv::Point2d along(std::cos(tip.shaft_angle), std::sin(tip.shaft_angle));
  const cv::Point2d across(-along.y, along.x);
  const double half = tip.shaft_width_px * panel_per_px_ / 2.0;
  for (const double side : {-half, half}) {
    line(panel, at - 4.0 * half * along + side * across, at - 40.0 * half * along + side * across, kToolLine);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spread(tip.covariance);
  const double turn = std::atan2(spread.eigenvectors()(1, 1), spread.eigenvectors()(0, 1)) * 180.0 / kPi;
  const auto radius = [&](int i) {
    return std::max(5.0, 3.0 * panel_per_px_ * std::sqrt(std::max(0.0, spread.eigenvalues()(i))));
  };
  cv::ellipse(panel,
              {cv::Point2f(at),
               {static_cast<float>(2.0 * radius(1)), static_cast<float>(2.0 * radius(0))},
               static_cast<float>(turn)},
              kToolLine, 1, cv::LINE_AA);
  ring(panel, at, 1.2, kView, -1);
}

// A cross that leaves the spot itself free.
void Overlay::drawSpot(const AimingSpot& spot, cv::Mat& panel) const
{
  if (!spot.present) return;
  const cv::Point2d at = cv::Point2d(spot.x_px, spot.y_px) * panel_per_px_;
  for (const cv::Point2d& arm : {cv::Point2d(1, 0), cv::Point2d(-1, 0), cv::Point2d(0, 1), cv::Point2d(0, -1)}) {
    line(panel, at + 4.0 * arm, at + 10.0 * arm, kPoint);
  }
}

void Overlay::drawOutline(const OverlayScene& scene, cv::Mat& panel) const
{
  const std::array<cv::Point2d, 4> corners = viewOutline(scene.result.map_T_frame, frame_);
  const cv::Matx23d panel_T_map = panelFromMap();
  const cv::Scalar colour = scene.result.tracked ? kView : kBad;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    line(panel, transformed(panel_T_map, corners[i]), transformed(panel_T_map, corners[(i + 1) % 4]), colour);
  }
}

void Overlay::writeStatus(const OverlayScene& scene, cv::Mat strip) const
{
  const TrackResult& result = scene.result;
  strip.setTo(kGutter);
  const std::string state = result.tracked ? "tracked" : fmt::format("lost: {}", retina::word(result.reason));
  const std::string place =
      fmt::format("frame {}   {:.2f} s   x {:+.1f}  y {:+.1f} px   turn {:+.2f} deg", result.frame, scene.time_s,
                  result.map_T_frame.x, result.map_T_frame.y, result.map_T_frame.theta * 180.0 / kPi);
  const double size = std::min(0.45, 0.45 * strip.cols / 560.0);
  cv::circle(strip, {14, kStatus / 2}, 4, result.tracked ? kGood : kBad, -1, cv::LINE_AA);
  cv::putText(strip, state, {26, 20}, cv::FONT_HERSHEY_SIMPLEX, size, result.tracked ? kInk : kBad, 1, cv::LINE_AA);
  int baseline = 0;
  const int width = cv::getTextSize(place, cv::FONT_HERSHEY_SIMPLEX, size, 1, &baseline).width;
  cv::putText(strip, place, {strip.cols - width - 10, 20}, cv::FONT_HERSHEY_SIMPLEX, size, kQuiet, 1, cv::LINE_AA);
}

}  // namespace eyeslam::tracking
