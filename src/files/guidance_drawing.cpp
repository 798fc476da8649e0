// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/guidance_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "eyeslam/files/graph_drawing.h"

namespace eyeslam::files {

namespace {

constexpr int kPanel_px = 640;
constexpr int kGap_px = 12;
constexpr int kCaption_px = 30;
constexpr double kDimmed = 0.72;  // of the retina's light, or thin lines drown in it
const cv::Scalar kGuidancePage{255, 255, 255};
const cv::Scalar kWritten{40, 40, 40};
const cv::Scalar kCentreline{255, 235, 160};
const cv::Scalar kNear{255, 255, 255};
const cv::Scalar kFar{255, 170, 60};

// A square of the page that shows a square of the map.
struct Panel {
  cv::Rect area;
  Eigen::Vector2d corner_px;  // of the map, under the area's corner
  double zoom;                // page px per map px

  cv::Point2d place(const Eigen::Vector2d& map_px) const
  {
    const Eigen::Vector2d from_corner = zoom * (map_px - corner_px);
    return {area.x + from_corner.x(), area.y + from_corner.y()};
  }
  std::vector<cv::Point2d> place(const std::vector<Eigen::Vector2d>& way) const
  {
    std::vector<cv::Point2d> placed;
    placed.reserve(way.size());
    for (const Eigen::Vector2d& point : way) placed.push_back(place(point));
    return placed;
  }
};

Panel panel(std::size_t number, const Eigen::Vector2d& middle_px, double width_px)
{
  const int column = static_cast<int>(number % 2);
  const int row = static_cast<int>(number / 2);
  const cv::Rect area(kGap_px + column * (kPanel_px + kGap_px), kGap_px + row * (kPanel_px + kCaption_px + kGap_px),
                      kPanel_px, kPanel_px);
  return {area, middle_px - Eigen::Vector2d::Constant(width_px / 2.0), kPanel_px / width_px};
}

void paintRetina(const GuidanceFigure& figure, const Panel& panel, cv::Mat& page)
{
  // page = zoom (origin + px_per_cell picture - corner)
  const double scale = panel.zoom * figure.geometry.px_per_cell;
  const Eigen::Vector2d offset =
      panel.zoom * (Eigen::Vector2d(figure.geometry.origin_x, figure.geometry.origin_y) - panel.corner_px);
  const cv::Matx23d area_T_picture(scale, 0.0, offset.x(), 0.0, scale, offset.y());
  cv::Mat shown;
  cv::warpAffine(figure.retina, shown, area_T_picture, panel.area.size(),
                 scale < 1.0 ? cv::INTER_AREA : cv::INTER_CUBIC, cv::BORDER_CONSTANT);
  shown.convertTo(page(panel.area), CV_8UC3, kDimmed);
}

// A round length that takes about a fifth of the panel.
void drawScaleBar(const Panel& panel, double um_per_px, VectorPicture& picture)
{
  const double um_per_page_px = um_per_px / panel.zoom;
  const double wished = 0.2 * kPanel_px * um_per_page_px;
  const double decade = std::pow(10.0, std::floor(std::log10(wished)));
  double length = decade;
  for (const double round : {2.0, 5.0}) {
    if (round * decade <= wished) length = round * decade;
  }
  const cv::Point2d right = cv::Point2d(panel.area.br()) - cv::Point2d(16.0, 16.0);
  const cv::Point2d left = right - cv::Point2d(length / um_per_page_px, 0.0);
  picture.line({left, right}, {cv::Scalar::all(0), 6.0, 0.6});
  picture.line({left, right}, {kWhite, 3.0, 1.0});
  const std::string text = length >= 1000.0 ? fmt::format("{:g} mm", length / 1000.0) : fmt::format("{:g} um", length);
  picture.words(text, left - cv::Point2d(0.0, 9.0), 11.0, {kWhite});
}

void caption(const Panel& panel, std::size_t number, const std::string& text, VectorPicture& picture)
{
  const cv::Point2d at(panel.area.x + 2.0, panel.area.br().y + 20.0);
  picture.words(fmt::format("({}) {}", static_cast<char>('a' + number), text), at, 11.5, {kWritten});
}

void drawVessels(const GuidanceFigure& figure, const Panel& panel, const Ink& ink, VectorPicture& picture)
{
  for (const fixtures::Vessel& vessel : figure.network.vessels) {
    std::vector<cv::Point2d> line;
    line.reserve(vessel.points.size());
    for (const fixtures::CenterlinePoint& point : vessel.points) line.push_back(panel.place(point.position_px));
    picture.line(std::move(line), ink);
  }
}

void drawOverview(const GuidanceFigure& figure, const Panel& panel, VectorPicture& picture)
{
  const Eigen::Vector2d page_corner =
      panel.corner_px - Eigen::Vector2d(panel.area.x, panel.area.y) / panel.zoom;  // of the map, under the page's
  GraphStyle style;
  style.line_px = 1.3;
  style.junction_px = 1.8;
  style.words_px = 0.0;
  drawGraph(picture, figure.network, {page_corner.x(), page_corner.y(), 1.0 / panel.zoom}, style);
  const Eigen::Vector2d corner = figure.window_middle_px - Eigen::Vector2d::Constant(figure.window_px / 2.0);
  const double width = panel.zoom * figure.window_px;
  picture.rectangle({panel.place(corner), cv::Size2d(width, width)}, {kWhite, 1.6, 1.0});
}

double spacingOf(const std::vector<FieldArrow>& field)
{
  double spacing = 1e9;
  for (std::size_t i = 1; i < field.size(); ++i) {
    spacing = std::min(spacing, (field[i].hand_px - field[i - 1].hand_px).norm());
  }
  return spacing;
}

void drawField(const GuidanceFigure& figure, const Panel& panel, VectorPicture& picture)
{
  constexpr double kShown = 0.82;  // of the way to the next hand: the arrows stay apart
  drawVessels(figure, panel, {kCentreline, 1.3, 1.0}, picture);
  const double spacing = spacingOf(figure.field);
  double farthest = 1e-9;
  for (const FieldArrow& arrow : figure.field) farthest = std::max(farthest, (arrow.goal_px - arrow.hand_px).norm());
  for (const FieldArrow& arrow : figure.field) {
    const Eigen::Vector2d way = arrow.goal_px - arrow.hand_px;
    const double length = way.norm();
    if (length * panel.zoom < 2.0) continue;
    const Eigen::Vector2d shown = way * std::min(1.0, kShown * spacing / length);
    const double far = length / farthest;
    picture.arrow(panel.place(arrow.hand_px), panel.place(arrow.hand_px + shown),
                  {kNear * (1.0 - far) + kFar * far, 1.1, 0.95});
  }
}

// What the retina's picture covers of the map, as a square around its middle.
Panel overview(const GuidanceFigure& figure)
{
  const Eigen::Vector2d size(figure.retina.cols * figure.geometry.px_per_cell,
                             figure.retina.rows * figure.geometry.px_per_cell);
  return panel(0, Eigen::Vector2d(figure.geometry.origin_x, figure.geometry.origin_y) + size / 2.0, size.maxCoeff());
}

}  // namespace

VectorPicture drawGuidance(const GuidanceFigure& figure)
{
  std::vector<Panel> panels{overview(figure)};
  panels.reserve(2 + figure.traces.size());
  for (std::size_t i = 1; i < 2 + figure.traces.size(); ++i) {
    panels.push_back(panel(i, figure.window_middle_px, figure.window_px));
  }
  const int rows = static_cast<int>((panels.size() + 1) / 2);
  cv::Mat page(kGap_px + rows * (kPanel_px + kCaption_px + kGap_px), 2 * kPanel_px + 3 * kGap_px, CV_8UC3,
               kGuidancePage);
  for (const Panel& each : panels) paintRetina(figure, each, page);
  VectorPicture picture(page);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    picture.clipTo(panels[i].area);
    if (i == 0) drawOverview(figure, panels[i], picture);
    if (i == 1) drawField(figure, panels[i], picture);
    if (i >= 2) picture.line(panels[i].place(figure.traces[i - 2].points_px), {figure.traces[i - 2].colour, 1.1, 1.0});
    drawScaleBar(panels[i], figure.um_per_px, picture);
    picture.clipTo({});
    const std::string texts[] = {"vessel map and graph", figure.field_caption};
    caption(panels[i], i, i < 2 ? texts[i] : figure.traces[i - 2].caption, picture);
  }
  return picture;
}

}  // namespace eyeslam::files
