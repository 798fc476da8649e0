// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/plan_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "eyeslam/fixtures/burn_order.h"
#include "eyeslam/retina/reason.h"
#include "eyeslam/retina/units.h"

namespace eyeslam::files {
namespace {

using fixtures::BurnPlan;
using fixtures::BurnTarget;
using fixtures::validTargets;

constexpr double kWidth_px = 1500.0;  // of the figure
constexpr int kLegend_px = 96;
constexpr double kWord_px = 17.0;      // height of a capital
constexpr double kLeastBurn_px = 3.0;  // diameter that can still be seen
const cv::Scalar kRetina(92, 118, 168), kVessel(46, 40, 112), kUnseen(104, 104, 104);
const cv::Scalar kBlack(0, 0, 0), kPaper(255, 255, 255), kWords(40, 36, 32);
const cv::Scalar kZone(60, 220, 250), kWay(230, 200, 60), kTile(250, 235, 200);

std::vector<cv::Point2d> circle(cv::Point2d centre, double radius_px, int corners = 72)
{
  std::vector<cv::Point2d> points;
  for (int i = 0; i <= corners; ++i) {
    const double angle = kTwoPi * i / corners;
    points.push_back(centre + radius_px * cv::Point2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

// The first of 1, 2 and 5 times a power of ten that is a fifth of the figure or less.
double barLength_um(double width_um)
{
  double length = std::pow(10.0, std::floor(std::log10(width_um / 5.0)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * length <= width_um / 5.0) return factor * length;
  }
  return length;
}

// As OpenCV's font has it; SVG's is a little narrower.
double widthOf(const std::string& text, double height_px)
{
  int baseline = 0;
  return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, height_px / 21.0, 1, &baseline).width;
}

class PlanDrawing {
 public:
  PlanDrawing(const BurnPlan& plan, const PlanBackground& background)
      : plan_(plan),
        geometry_(background.geometry),
        scale_(kWidth_px / (background.picture.cols * background.geometry.px_per_cell)),
        retina_({}, cv::Size(cvRound(kWidth_px), cvRound(background.picture.rows * geometry_.px_per_cell * scale_))),
        figure_(canvas(background.picture))
  {
    figure_.clipTo(retina_);
  }

  void zones();
  void tiles();
  void way();
  void burns();
  void labels();
  void scaleBar();
  void legend(const PlanDrawingOptions& options);
  VectorPicture take() { return std::move(figure_); }

 private:
  cv::Mat canvas(const cv::Mat& picture) const;
  cv::Point2d place(const Eigen::Vector2d& map_px) const;
  double px(double um) const { return um / plan_.um_per_px * scale_; }
  void burn(cv::Point2d at, double diameter_um, bool valid);
  void zone(std::vector<cv::Point2d> border);
  void landmark(const std::string& field, const std::string& text, double radius_um, const std::string& name);
  bool hasZones() const;
  void legendEntry(const std::string& text);
  std::string refusals() const;

  struct Label {
    std::string text;
    cv::Point2d middle;
    double height_px;
    cv::Scalar colour;
  };

  const BurnPlan& plan_;
  PictureGeometry geometry_;
  double scale_;     // figure px per map px
  cv::Rect retina_;  // the part of the figure above the legend
  VectorPicture figure_;
  cv::Point2d next_entry_;
  std::vector<Label> labels_;  // drawn last, above all burns
};

// The retina scaled to the figure's width, the legend's paper below.
cv::Mat PlanDrawing::canvas(const cv::Mat& picture) const
{
  cv::Mat canvas(retina_.height + kLegend_px, retina_.width, CV_8UC3, kPaper);
  cv::resize(picture, canvas(retina_), retina_.size(), 0.0, 0.0, scale_ > 1.0 ? cv::INTER_CUBIC : cv::INTER_AREA);
  return canvas;
}

// Of a map place; a pixel's centre has whole coordinates in both.
cv::Point2d PlanDrawing::place(const Eigen::Vector2d& map_px) const
{
  const double corner = 0.5 * geometry_.px_per_cell;
  return {(map_px.x() - geometry_.origin_x + corner) * scale_ - 0.5,
          (map_px.y() - geometry_.origin_y + corner) * scale_ - 0.5};
}

void PlanDrawing::zone(std::vector<cv::Point2d> border)
{
  figure_.line(border, {kBlack, 3.6, 0.55});
  figure_.line(std::move(border), {kZone, 2.0, 1.0});
}

void PlanDrawing::landmark(const std::string& field, const std::string& text, double radius_um, const std::string& name)
{
  for (const Eigen::Vector2d& centre : fixtures::placesIn(field, text)) {
    zone(circle(place(centre), px(radius_um)));
    labels_.push_back({name, place(centre) - cv::Point2d(0.0, px(radius_um)), kWord_px, kZone});
  }
}

bool PlanDrawing::hasZones() const
{
  const fixtures::BurnKeepOutOptions& zones = plan_.prescription.keep_out;
  return !(zones.fovea_px + zones.disc_px + zones.circles_px + zones.polygons_px).empty();
}

void PlanDrawing::zones()
{
  const fixtures::BurnKeepOutOptions& zones = plan_.prescription.keep_out;
  landmark("keep_out.fovea_px", zones.fovea_px, zones.fovea_um, "fovea");
  landmark("keep_out.disc_px", zones.disc_px, zones.disc_diameter_um / 2.0 + zones.disc_um, "disc");
  const std::vector<double> circles = fixtures::numbersIn("keep_out.circles_px", zones.circles_px);
  for (std::size_t i = 2; i < circles.size(); i += 3) {
    zone(circle(place({circles[i - 2], circles[i - 1]}), circles[i] * scale_));
  }
  for (const auto& corners : fixtures::polygonsIn("keep_out.polygons_px", zones.polygons_px)) {
    std::vector<cv::Point2d> border;
    std::transform(corners.begin(), corners.end(), std::back_inserter(border),
                   [this](const Eigen::Vector2d& corner) { return place(corner); });
    border.push_back(border.front());
    zone(std::move(border));
  }
}

// One tile is the whole plan and says nothing.
void PlanDrawing::tiles()
{
  const std::vector<fixtures::PlanTile> tiles = fixtures::travelOf(plan_).tiles;
  for (std::size_t i = 0; i < tiles.size() && tiles.size() > 1; ++i) {
    const cv::Point2d at = place(tiles[i].centre_px);
    figure_.line(circle(at, px(plan_.prescription.order.reach_um / 2.0)), {kTile, 1.6, 0.75});
    labels_.push_back({std::to_string(i + 1), at, 1.4 * kWord_px, kTile});
  }
}

void PlanDrawing::way()
{
  std::vector<cv::Point2d> way;
  for (const Eigen::Vector2d& start : fixtures::placesIn("order.start_px", plan_.prescription.order.start_px)) {
    way.push_back(place(start));
  }
  for (const BurnTarget& target : plan_.targets) {
    if (target.valid()) way.push_back(place(target.position_px));
  }
  if (way.empty()) return;
  const cv::Point2d first = way.front();
  figure_.line(std::move(way), {kWay, 1.8, 0.9});
  figure_.line(circle(first, px(plan_.prescription.burn_um()) / 2.0 + 7.0), {kWay, 2.4, 1.0});
}

void PlanDrawing::burn(cv::Point2d at, double diameter_um, bool valid)
{
  const double radius = std::max(px(diameter_um), kLeastBurn_px) / 2.0;
  figure_.disc(at, radius + 1.1, {valid ? kBlack : kWhite, 1.0, 0.7});
  figure_.disc(at, radius, {valid ? kWhite : kBlack});
}

// The allowed ones above.
void PlanDrawing::burns()
{
  for (const bool valid : {false, true}) {
    for (const BurnTarget& target : plan_.targets) {
      if (target.valid() == valid) burn(place(target.position_px), target.burn_um, valid);
    }
  }
}

// On a dark ground of their own, for they lie over white burns as well as over black ones.
void PlanDrawing::labels()
{
  for (const Label& label : labels_) {
    const double width = widthOf(label.text, label.height_px), half = 0.8 * label.height_px;
    const cv::Point2d left = label.middle - cv::Point2d(width / 2.0, 0.0);
    figure_.line({left, left + cv::Point2d(width, 0.0)}, {kWords, 2.0 * half, 0.5});
    figure_.words(label.text, left + cv::Point2d(0.0, label.height_px / 2.0), label.height_px, {label.colour});
  }
}

// At the right of the legend, where no burn lies behind it.
void PlanDrawing::scaleBar()
{
  const double um = barLength_um(retina_.width / scale_ * plan_.um_per_px);
  const cv::Point2d right(retina_.width - 28.0, retina_.height + 68.0), left = right - cv::Point2d(px(um), 0.0);
  const std::string text = um >= 1000.0 ? fmt::format("{} mm", um / 1000.0) : fmt::format("{} um", um);
  figure_.line({left, right}, {kWords, 5.0});
  figure_.words(text, left - cv::Point2d(widthOf(text, kWord_px) + 14.0, -0.5 * kWord_px), kWord_px, {kWords});
}

void PlanDrawing::legendEntry(const std::string& text)
{
  figure_.words(text, next_entry_ + cv::Point2d(0.0, 0.5 * kWord_px), kWord_px, {kWords});
  next_entry_.x += widthOf(text, kWord_px) + 64.0;
}

std::string PlanDrawing::refusals() const
{
  std::map<retina::Reason, int> refused;
  for (const BurnTarget& target : plan_.targets) ++refused[target.reason];
  refused.erase(retina::Reason::none);
  std::string text = std::to_string(plan_.targets.size() - validTargets(plan_)) + " refused";
  for (const auto& [reason, count] : refused) {
    std::string why(retina::word(reason));
    std::replace(why.begin(), why.end(), '_', ' ');
    text += fmt::format("{} {} {}", reason == refused.begin()->first ? ":" : ",", count, why);
  }
  return text;
}

void PlanDrawing::legend(const PlanDrawingOptions& options)
{
  figure_.clipTo({});
  next_entry_ = {44.0, retina_.height + 28.0};
  const auto dot = [this](const cv::Scalar& colour, const std::string& text) {
    figure_.disc(next_entry_ - cv::Point2d(18.0, 0.0), 9.0, {kBlack});
    figure_.disc(next_entry_ - cv::Point2d(18.0, 0.0), 7.5, {colour});
    legendEntry(text);
  };
  dot(kWhite, fmt::format("{} valid", validTargets(plan_)));
  dot(kBlack, refusals());
  next_entry_ = {44.0, retina_.height + 68.0};
  legendEntry(fmt::format("burn {:.0f} um, margin {:.0f} um", plan_.prescription.burn_um(),
                          plan_.prescription.safety.margin_um));
  const auto stroke = [this](const cv::Scalar& colour, const std::string& text) {
    figure_.line({next_entry_ - cv::Point2d(34.0, 0.0), next_entry_ - cv::Point2d(10.0, 0.0)}, {kBlack, 5.0});
    figure_.line({next_entry_ - cv::Point2d(34.0, 0.0), next_entry_ - cv::Point2d(10.0, 0.0)}, {colour, 3.0});
    legendEntry(text);
  };
  if (hasZones()) stroke(kZone, "keep-out");
  if (fixtures::travelOf(plan_).tiles.size() > 1) stroke(kTile, "placement of the workspace");
  if (options.travel) stroke(kWay, "travel");
}

// What was seen at all, with a border; the whole map where that is nothing.
cv::Rect seenPart(const retina::VesselMap& map)
{
  constexpr int kBorder = 8;
  const cv::Rect whole(0, 0, map.width, map.height);
  const cv::Mat seen = cv::Mat(map.seen, false).reshape(1, map.height);
  const cv::Rect part = cv::boundingRect(seen);
  if (part.empty()) return whole;
  return cv::Rect(part.x - kBorder, part.y - kBorder, part.width + 2 * kBorder, part.height + 2 * kBorder) & whole;
}

}  // namespace

PlanBackground mapBackground(const retina::VesselMap& map, int vessel_probability, int seen_frames)
{
  cv::Mat picture(map.height, map.width, CV_8UC3);
  const auto colourOf = [&](std::size_t cell) -> const cv::Scalar& {
    if (map.probability[cell] >= vessel_probability) return kVessel;
    return map.seen[cell] >= seen_frames ? kRetina : kUnseen;
  };
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const cv::Scalar& colour = colourOf(map.index(column, row));
      picture.at<cv::Vec3b>(row, column) = {static_cast<uchar>(colour[0]), static_cast<uchar>(colour[1]),
                                            static_cast<uchar>(colour[2])};
    }
  }
  const cv::Rect shown = seenPart(map);
  return {picture(shown).clone(),
          {map.origin_x + shown.x * map.px_per_cell, map.origin_y + shown.y * map.px_per_cell, map.px_per_cell}};
}

VectorPicture drawPlan(const fixtures::BurnPlan& plan, const PlanBackground& background,
                       const PlanDrawingOptions& options)
{
  PlanDrawing drawing(plan, background);
  drawing.tiles();
  drawing.zones();
  if (options.travel) drawing.way();
  drawing.burns();
  drawing.labels();
  drawing.legend(options);
  drawing.scaleBar();
  return drawing.take();
}

}  // namespace eyeslam::files
