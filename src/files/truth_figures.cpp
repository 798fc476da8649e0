// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/truth_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "eyeslam/files/chart.h"

namespace eyeslam::files {
namespace {

const cv::Size kFigure(1600, 1000);
const cv::Scalar kPage(255, 255, 255), kTruthInk(50, 46, 42), kTrue(176, 172, 168), kEstimate(190, 90, 20);
const cv::Scalar kError(60, 60, 205), kAll(150, 110, 30), kWide(190, 150, 60), kWidest(215, 190, 130),
    kFalse(60, 60, 205);
constexpr int kHead = 56;         // px of the headline
constexpr std::size_t kMaps = 4;  // pictures of the map

// The paper's Fig. 6 as its text gives it: 50 % after 30 frames, 75 % after 60, false positives under 10 % after 5 s.
const std::vector<double> kPaperCoverage_s = {1.0, 2.0}, kPaperCoverage = {50.0, 75.0};
const std::vector<double> kPaperFalse_s = {5.0}, kPaperFalse = {10.0};

cv::Mat blank(const std::string& headline)
{
  cv::Mat figure(kFigure, CV_8UC3, kPage);
  writeText(figure, headline, {30, 36}, 0.7, kTruthInk);
  return figure;
}

std::vector<double> times(const Truth& truth)
{
  std::vector<double> t_s;
  for (const TruthPose& pose : truth.poses) t_s.push_back(pose.t_s);
  return t_s;
}

void shadeHidden(Chart& chart, const Truth& truth)
{
  const double frame_s = truth.fps > 0.0 ? 1.0 / truth.fps : 0.0;
  for (const TruthPose& pose : truth.poses) {
    if (!pose.visible) chart.shade(pose.t_s - frame_s / 2.0, pose.t_s + frame_s / 2.0);
  }
}

/// One row of the pose figure.
struct Component {
  std::string title;
  std::string unit;
  double TruthPose::*truth;
  double EstimatedPose::*estimate;
  double PoseError::*error;
  double factor;      // full-resolution values times this are shown
  double least_span;  // of the axes
};

const std::array<Component, 3>& components()
{
  static const std::array<Component, 3> kComponents = {{
      {"x", "half-resolution px", &TruthPose::x_px, &EstimatedPose::x_px, &PoseError::x_px, 0.5, 0.2},
      {"y", "half-resolution px", &TruthPose::y_px, &EstimatedPose::y_px, &PoseError::y_px, 0.5, 0.2},
      {"theta", "deg", &TruthPose::theta_deg, &EstimatedPose::theta_deg, &PoseError::theta_deg, 1.0, 0.05},
  }};
  return kComponents;
}

void drawComponent(cv::Mat& figure, int row, const Truth& truth, const std::vector<EstimatedPose>& estimate)
{
  const Component& part = components()[static_cast<std::size_t>(row)];
  const std::vector<double> t_s = times(truth);
  std::vector<double> is, found, off;
  for (std::size_t i = 0; i < truth.poses.size(); ++i) {
    const double gap = std::numeric_limits<double>::quiet_NaN();
    const bool counts = truth.poses[i].visible;
    is.push_back(part.factor * truth.poses[i].*part.truth);
    found.push_back(estimate[i].tracked ? part.factor * estimate[i].*part.estimate : gap);
    off.push_back(counts ? poseError(truth.poses[i], estimate[i]).*part.error : gap);
  }
  const Interval span = {t_s.front(), std::max(t_s.back(), t_s.front() + 1e-3)};
  const int height = (kFigure.height - kHead) / 3, top = kHead + row * height, width = kFigure.width / 2;
  Chart pose(figure, {0, top, width, height}, span, Interval{is[0], is[0]}.holding(is).holding(found).padded(1.0));
  shadeHidden(pose, truth);
  pose.axes(part.title + " (" + part.unit + ")", "s");
  pose.curve(t_s, is, kTrue, 5);
  pose.curve(t_s, found, kEstimate, 1);
  pose.legend({{"truth", kTrue}, {"EyeSLAM", kEstimate}});
  Chart error(figure, {width, top, width, height}, span, Interval{0.0, 0.0}.holding(off).padded(part.least_span));
  shadeHidden(error, truth);
  error.axes("error of " + part.title + " (" + part.unit + ")", "s");
  error.curve({span.from, span.to}, {0.0, 0.0}, kTrue, 1);
  error.curve(t_s, off, kError, 1);
}

/// The curves of the map figure, in percent.
void drawCurves(cv::Mat& figure, cv::Rect area, const Truth& truth, const std::vector<JudgedMap>& maps)
{
  std::vector<double> t_s, all, wide, widest, wrong;
  for (const JudgedMap& map : maps) {
    t_s.push_back(truth.poses.at(static_cast<std::size_t>(map.score.frame)).t_s);
    all.push_back(100.0 * map.score.coverage);
    wide.push_back(100.0 * map.score.coverage_from_6_px);
    widest.push_back(100.0 * map.score.coverage_from_10_px);
    wrong.push_back(100.0 * map.score.false_positive);
  }
  Chart chart(figure, area, {0.0, std::max(1.0, 1.03 * t_s.back())}, {0.0, 105.0});
  shadeHidden(chart, truth);
  chart.axes("percent", "s");
  chart.squares(kPaperCoverage_s, kPaperCoverage, kTrue);
  chart.squares(kPaperFalse_s, kPaperFalse, kTrue);
  const std::array<std::pair<const std::vector<double>*, cv::Scalar>, 4> curves = {
      {{&widest, kWidest}, {&wide, kWide}, {&all, kAll}, {&wrong, kFalse}}};
  for (const auto& [values, colour] : curves) {
    if (values == &widest && *std::max_element(widest.begin(), widest.end()) <= 0.0) continue;  // no such vessel
    chart.curve(t_s, *values, colour, 2);
    chart.dots(t_s, *values, colour);
  }
  chart.legend({{"vessels covered: all", kAll},
                {"from 6 px", kWide},
                {"from 10 px", kWidest},
                {"false positives", kFalse},
                {"squares: the paper (human retina)", kTrue}});
}

cv::Mat colouredVerdicts(const cv::Mat_<std::uint8_t>& verdicts)
{
  static const std::array<cv::Vec3b, 5> kColours = {cv::Vec3b(255, 255, 255), cv::Vec3b(243, 241, 239),
                                                    cv::Vec3b(70, 150, 40), cv::Vec3b(60, 60, 225),
                                                    cv::Vec3b(235, 170, 90)};
  cv::Mat picture(verdicts.size(), CV_8UC3);
  for (int row = 0; row < verdicts.rows; ++row) {
    for (int column = 0; column < verdicts.cols; ++column) {
      const std::size_t verdict = std::min<std::size_t>(verdicts(row, column), kColours.size() - 1);
      picture.at<cv::Vec3b>(row, column) = kColours[verdict];
    }
  }
  return picture;
}

void drawMap(cv::Mat& figure, cv::Rect area, const Truth& truth, const JudgedMap& map, cv::Rect seen)
{
  const cv::Mat picture = colouredVerdicts(map.verdicts)(seen);
  const double scale = std::min(static_cast<double>(area.width) / seen.width, (area.height - 30.0) / seen.height);
  cv::Mat small;
  cv::resize(picture, small, {std::max(1, cvRound(seen.width * scale)), std::max(1, cvRound(seen.height * scale))}, 0.0,
             0.0, cv::INTER_AREA);
  const cv::Rect place(area.x + (area.width - small.cols) / 2, area.y + 30, small.cols, small.rows);
  small.copyTo(figure(place));
  cv::rectangle(figure, place, cv::Scalar(200, 196, 192));
  const double t_s = truth.poses.at(static_cast<std::size_t>(map.score.frame)).t_s;
  writeText(figure,
            fmt::format("{:.2f} s: {:.0f} % covered, {:.0f} % false", t_s, 100.0 * map.score.coverage,
                        100.0 * map.score.false_positive),
            {place.x, area.y + 20}, 0.5, kTruthInk);
}

/// The first that shows anything (frame 0's map is empty), the last, and between them evenly by their number.
std::vector<std::size_t> chosen(const std::vector<JudgedMap>& maps)
{
  std::size_t first = 0;
  while (first + 1 < maps.size() && maps[first].score.coverage <= 0.0) ++first;
  std::vector<std::size_t> picks;
  const std::size_t steps = maps.size() - 1 - first, most = std::min(steps + 1, kMaps);
  for (std::size_t i = 0; i < most; ++i) picks.push_back(most == 1 ? maps.size() - 1 : first + i * steps / (most - 1));
  return picks;
}

void writeKey(cv::Mat& figure, int y)
{
  const std::array<std::pair<const char*, cv::Scalar>, 3> entries = {{{"vessel found", cv::Scalar(70, 150, 40)},
                                                                      {"false", cv::Scalar(60, 60, 225)},
                                                                      {"missed", cv::Scalar(235, 170, 90)}}};
  int x = 66;
  for (const auto& [name, colour] : entries) {
    cv::rectangle(figure, cv::Rect(x, y - 12, 16, 14), colour, cv::FILLED);
    writeText(figure, name, {x + 24, y}, 0.5, kTruthInk);
    x += 60 + textWidth(name, 0.5);
  }
}

}  // namespace

cv::Mat poseFigure(const std::string& name, const Truth& truth, const std::vector<EstimatedPose>& estimate)
{
  const PoseScore score = scorePoses(truth.poses, estimate);
  cv::Mat figure = blank(fmt::format("{}: RMS {:.3f} px, {:.4f} deg; {:.1f} % of {} visible frames under 5 px", name,
                                     score.rms_px, score.rms_deg, 100.0 * score.under_5_px, score.visible));
  if (score.visible < score.frames) writeText(figure, "shaded: retina hidden", {1380, 36}, 0.5, kTruthInk);
  for (int row = 0; row < 3; ++row) drawComponent(figure, row, truth, estimate);
  return figure;
}

cv::Mat mapFigure(const std::string& name, const Truth& truth, const std::vector<JudgedMap>& maps)
{
  if (maps.empty()) throw std::invalid_argument("a figure of the map needs at least one scored map");
  const MapScore& last = maps.back().score;
  cv::Mat figure = blank(
      fmt::format("{}: map at frame {} covers {:.1f} % of the vessels seen (from 6 px {:.1f} %), {:.1f} % false", name,
                  last.frame, 100.0 * last.coverage, 100.0 * last.coverage_from_6_px, 100.0 * last.false_positive));
  const int middle = kHead + (kFigure.height - kHead) * 3 / 5;
  drawCurves(figure, {0, kHead, kFigure.width, middle - kHead}, truth, maps);
  writeKey(figure, middle + 24);
  // All maps are shown in the frame of what the last one had seen.
  const cv::Rect seen = cv::boundingRect(maps.back().verdicts != 0);
  const std::vector<std::size_t> picks = chosen(maps);
  const int width = (kFigure.width - 66) / static_cast<int>(picks.size());
  for (std::size_t i = 0; i < picks.size(); ++i) {
    const cv::Rect area(66 + static_cast<int>(i) * width, middle + 34, width - 18, kFigure.height - middle - 50);
    if (!seen.empty()) drawMap(figure, area, truth, maps[picks[i]], seen);
  }
  return figure;
}

}  // namespace eyeslam::files
