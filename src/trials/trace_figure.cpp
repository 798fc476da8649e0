// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/trace_figure.h"

#include <fmt/format.h>

#include <algorithm>

#include "eyeslam/trials/aid_style.h"
#include "eyeslam/trials/figure_layout.h"
#include "eyeslam/trials/retina_panel.h"
#include "eyeslam/trials/svg_canvas.h"

namespace eyeslam::trials {

namespace {

constexpr double kPanelHeight_px = 390.0, kCloseUpHeight_px = 300.0;
constexpr double kTraceMargin = 150e-6;                         // m, of retina around what is drawn
constexpr double kLeastTracePanel = 0.8e-3, kCloseUp = 0.5e-3;  // m, widths of panels
constexpr double kFinest_px = 0.2;

Points tracesOf(const TrialRecord& trial)
{
  Points points;
  points.reserve(trial.tip.size());
  for (const TipSample& sample : trial.tip) points.emplace_back(sample.tip.head<2>());
  return points;
}

Box regionOfTraces(const std::vector<const TrialRecord*>& trials)
{
  Box region;
  for (const TrialRecord* trial : trials) {
    for (const Eigen::Vector2d& place : trial->path) region.extend(place);
    for (const TipSample& sample : trial->tip) region.extend(Eigen::Vector2d(sample.tip.head<2>()));
  }
  if (region.isEmpty()) return region;
  const Eigen::Vector2d margin(kTraceMargin, kTraceMargin);
  return {region.min() - margin, region.max() + margin};
}

// The middle of what is followed; of a place the tip when half of the time is over.
Eigen::Vector2d placeOfCloseUp(const TrialRecord& trial)
{
  if (trial.path.size() > 1) return trial.path[trial.path.size() / 2];
  return trial.tip.empty() ? Eigen::Vector2d(0.0, 0.0) : Eigen::Vector2d(trial.tip[trial.tip.size() / 2].tip.head<2>());
}

void drawTask(const TrialRecord& trial, const RetinaPanel& panel, SvgCanvas& canvas)
{
  if (trial.path.size() > 1) {
    canvas.path(simplified(panel.places(trial.path), kFinest_px), Paint::dashed("#000", 1.2, "6 4"));
  } else if (!trial.path.empty()) {
    const Eigen::Vector2d at = panel.place(trial.path.front());
    canvas.circle(at, 7.0, Paint::line("#fff", 3.0, 0.8));
    canvas.circle(at, 7.0, Paint::line("#000", 1.2));
  }
}

void drawPanel(const TrialRecord& trial, const RetinaBackground& background, const Box& plot, const Box& region,
               const std::string& title, SvgCanvas& canvas)
{
  RetinaPanel panel(canvas, plot, region);
  panel.begin(background);
  const double ink = 1e-6 * panel.pxPerMetre() > 0.5 ? 1.5 : 1.0;
  canvas.path(simplified(panel.places(tracesOf(trial)), kFinest_px),
              Paint::line(styleOf(trial.score.aid).colour, ink, 0.9));
  drawTask(trial, panel, canvas);
  panel.finish(title);
}

void drawPlaceOfCloseUp(const Box& plot, const Box& region, const Box& close_up, SvgCanvas& canvas)
{
  const RetinaPanel panel(canvas, plot, region);
  const Box marked(panel.place(close_up.min()), panel.place(close_up.max()));
  canvas.clip(plot);
  canvas.box(marked, Paint::line("#fff", 2.6, 0.8));
  canvas.box(marked, Paint::line("#000", 1.0));
  canvas.unclip();
}

void drawLegend(const std::vector<const TrialRecord*>& trials, double y, SvgCanvas& canvas)
{
  double x = 0.0;
  const auto add = [&](const std::string& words, const Paint& paint) {
    canvas.line({x, y - 4.0}, {x + 24.0, y - 4.0}, paint);
    canvas.text({x + 30.0, y}, words, {12.0});
    x += 30.0 + widthOf(words, 12.0) + 26.0;
  };
  for (const TrialRecord* trial : trials) {
    const AidStyle style = styleOf(trial->score.aid);
    add("tip, " + style.name, Paint::line(style.colour, 2.0));
  }
  add("what was to be followed", Paint::dashed("#000", 1.2, "6 4"));
  add("true edges of vessels", Paint::line("#8c2d2d", 1.0));
}

std::string titleOf(const TrialRecord& trial, char letter)
{
  std::string title = fmt::format("{}\u00a0 {}", letter, styleOf(trial.score.aid).name);
  if (trial.score.rms_um) title += fmt::format(": RMS {:.3g} \u00b5m", *trial.score.rms_um);
  return title;
}

}  // namespace

std::string traceFigure(const std::vector<const TrialRecord*>& trials, const std::string& name)
{
  const bool single = trials.size() == 1;
  const bool closer = trials.front()->task != "standoff";  // from above its error cannot be seen
  const auto columns = static_cast<double>(single && closer ? 2 : trials.size());
  const double width = (kFigureWidth - kPanelGap * (columns - 1.0)) / columns;
  const double below = kPanelHeight_px + 24.0 + kPanelGap + 14.0;
  const double bottom = single || !closer ? kPanelHeight_px + 24.0 : below + kCloseUpHeight_px;
  SvgCanvas canvas(kFigureWidth, bottom + 30.0, "way of the tip over the retina");
  const Box region = grownTo(regionOfTraces(trials), width / kPanelHeight_px, kLeastTracePanel);
  const double closer_height = single ? kPanelHeight_px : kCloseUpHeight_px;
  const Eigen::Vector2d middle = placeOfCloseUp(*trials.back());
  const Box close_up = grownTo({middle, middle}, width / closer_height, kCloseUp);
  const RetinaBackground background(trials.front()->retina, region, 0.0, name);
  if (!background.empty()) canvas.insert(background.definition());
  char letter = 'a';
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const double x = static_cast<double>(i) * (width + kPanelGap);
    const Box plot = boxAt(x, 24.0, width, kPanelHeight_px);
    drawPanel(*trials[i], background, plot, region, titleOf(*trials[i], letter++), canvas);
    if (closer) drawPlaceOfCloseUp(plot, region, close_up, canvas);
  }
  for (std::size_t i = 0; closer && i < trials.size(); ++i) {
    const double x = static_cast<double>(single ? 1 : i) * (width + kPanelGap);
    const Box plot = boxAt(x, single ? 24.0 : below, width, closer_height);
    drawPanel(*trials[i], background, plot, close_up, fmt::format("{}\u00a0 close-up", letter++), canvas);
  }
  drawLegend(trials, bottom + 22.0, canvas);
  return canvas.svg();
}

}  // namespace eyeslam::trials
