// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/burn_figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "eyeslam/trials/aid_style.h"
#include "eyeslam/trials/figure_layout.h"
#include "eyeslam/trials/retina_panel.h"
#include "eyeslam/trials/svg_canvas.h"
#include "eyeslam/trials/svg_chart.h"

namespace eyeslam::trials {

namespace {

constexpr double kTallest_px = 560.0, kSinglePanel_px = 820.0;
constexpr double kBurnMargin = 200e-6, kLeastBurnPanel = 1.5e-3;  // m
constexpr double kUsualBurn = 100e-6;                             // m, where the plan does not say
constexpr double kFar_um = 60.0, kBound_um = 30.0;                // rings; issue 17: farther is a far pulse
constexpr const char* kMissedColour = "#cc79a7";

Box regionOfBurns(const std::vector<const TrialRecord*>& trials)
{
  Box region;
  for (const TrialRecord* trial : trials) {
    for (const PlannedTarget& target : trial->targets) region.extend(target.wanted);
    for (const PulseRecord& pulse : trial->pulses) region.extend(pulse.spot);
  }
  if (region.isEmpty()) return region;
  const Eigen::Vector2d margin(kBurnMargin, kBurnMargin);
  return {region.min() - margin, region.max() + margin};
}

double diameterOf(const TrialRecord& trial, int id)
{
  for (const PlannedTarget& target : trial.targets)
    if (target.id == id && target.burn > 0.0) return target.burn;
  return kUsualBurn;
}

/// Letters for the reasons of all trials of a figure.
std::map<std::string, char> lettersOf(const std::vector<const TrialRecord*>& trials)
{
  std::map<std::string, char> letters;
  for (const TrialRecord* trial : trials)
    for (const PlannedTarget& target : trial->targets)
      if (!target.reason.empty()) letters[target.reason] = 'a';
  char letter = 'a';
  for (auto& [reason, given] : letters) given = letter == 'z' ? letter : letter++;
  return letters;
}

void drawTarget(const PlannedTarget& target, const std::map<std::string, char>& letters, const RetinaPanel& panel,
                SvgCanvas& canvas)
{
  const Eigen::Vector2d at = panel.place(target.wanted);
  const double radius = std::max(2.0, 0.5 * target.burn * panel.pxPerMetre());
  const std::string tooltip = fmt::format("target {}: {} {}", target.id, target.fate, target.reason);
  const Paint ring = target.fate == "missed"    ? Paint::line(kMissedColour, 2.2)
                     : target.fate == "pending" ? Paint::dashed("#333", 1.2, "2 2")
                     : target.fate == "refused" ? Paint::line("#555", 1.0)
                                                : Paint::line("#111", 1.0);
  canvas.circle(at, radius, ring, tooltip);
  if (target.fate != "missed" && target.fate != "refused") return;
  const double arm = 0.7 * radius;
  canvas.line(at - Eigen::Vector2d(arm, arm), at + Eigen::Vector2d(arm, arm), ring);
  canvas.line(at - Eigen::Vector2d(arm, -arm), at + Eigen::Vector2d(arm, -arm), ring);
  const auto letter = letters.find(target.reason);
  if (letter == letters.end()) return;
  Lettering lettering{11.0};
  lettering.halo = true;
  canvas.text(at + Eigen::Vector2d(radius + 1.5, -0.4 * radius), std::string(1, letter->second), lettering);
}

void drawPulse(const TrialRecord& trial, const PulseRecord& pulse, const RetinaPanel& panel, SvgCanvas& canvas)
{
  const Eigen::Vector2d at = panel.place(pulse.spot);
  const double radius = std::max(2.0, 0.5 * diameterOf(trial, pulse.target) * panel.pxPerMetre());
  const std::string tooltip = fmt::format("burn of target {}: {:.1f} um off, {:.0f} um from the nearest vessel",
                                          pulse.target, 1e6 * pulse.placement, 1e6 * pulse.clearance);
  canvas.circle(at, radius, Paint::area(styleOf(trial.score.aid).colour, 0.55), tooltip);
  if (pulse.touched_calibre > 0.0) canvas.circle(at, radius, Paint::line("#000", 2.2), tooltip);
  if (pulse.far) canvas.line(panel.place(pulse.wanted), at, Paint::line("#000", 1.6));
}

void drawPanel(const TrialRecord& trial, const RetinaBackground& background, const Box& plot, const Box& region,
               char letter, const Eigen::Vector2d& reasons_at, SvgCanvas& canvas)
{
  RetinaPanel panel(canvas, plot, region);
  panel.begin(background);
  const std::map<std::string, char> letters = lettersOf({&trial});
  for (const PulseRecord& pulse : trial.pulses) drawPulse(trial, pulse, panel, canvas);
  for (const PlannedTarget& target : trial.targets) drawTarget(target, letters, panel, canvas);
  std::string title = fmt::format("{}\u00a0 {}", letter, styleOf(trial.score.aid).name);
  if (trial.score.placement_mean_um)
    title += fmt::format(": {:.3g} \u00b5m off on average", *trial.score.placement_mean_um);
  panel.finish(title);
  Eigen::Vector2d at = reasons_at;
  for (const auto& [reason, given] : letters) {
    const auto count = std::count_if(trial.targets.begin(), trial.targets.end(),
                                     [&r = reason](const PlannedTarget& target) { return target.reason == r; });
    canvas.text(at, fmt::format("{}\u00a0 {} ({})", given, reason, count), {11.5});
    at.y() += 15.0;
  }
}

/// Lays entries of a legend in a row, or below each other.
class Legend {
 public:
  Legend(SvgCanvas& canvas, const Eigen::Vector2d& at, double row_step) : canvas_(canvas), at_(at), row_step_(row_step)
  {}

  void ring(const std::string& words, const Paint& paint)
  {
    canvas_.circle(glyph(), 7.0, paint);
    finish(words);
  }
  void crossed(const std::string& words, const Paint& paint)
  {
    const Eigen::Vector2d centre = glyph();
    canvas_.line(centre - Eigen::Vector2d(5, 5), centre + Eigen::Vector2d(5, 5), paint);
    canvas_.line(centre - Eigen::Vector2d(5, -5), centre + Eigen::Vector2d(5, -5), paint);
    ring(words, paint);
  }
  void line(const std::string& words, const Paint& paint)
  {
    canvas_.line(glyph() - Eigen::Vector2d(8, 0), glyph() + Eigen::Vector2d(8, 0), paint);
    finish(words);
  }

 private:
  Eigen::Vector2d glyph() const { return at_ + Eigen::Vector2d(8.0, -4.0); }
  void finish(const std::string& words)
  {
    canvas_.text(at_ + Eigen::Vector2d(21.0, 0.0), words, {12.0});
    at_ += row_step_ > 0.0 ? Eigen::Vector2d(0.0, row_step_) : Eigen::Vector2d(21.0 + widthOf(words, 12.0) + 18.0, 0.0);
  }

  SvgCanvas& canvas_;
  Eigen::Vector2d at_;
  double row_step_;
};

void drawLegend(const std::vector<const TrialRecord*>& trials, double margin, Legend legend)
{
  legend.ring("target", Paint::line("#111", 1.0));
  for (const TrialRecord* trial : trials)
    legend.ring("burn, " + styleOf(trial->score.aid).name, Paint::area(styleOf(trial->score.aid).colour, 0.55));
  legend.ring("touches a true vessel", Paint::line("#000", 2.2));
  legend.crossed("refused", Paint::line("#555", 1.0));
  legend.crossed("missed", Paint::line(kMissedColour, 2.2));
  legend.ring("not reached", Paint::dashed("#333", 1.2, "2 2"));
  legend.line("far off its target", Paint::line("#000", 1.6));
  if (margin > 0.0)
    legend.line(fmt::format("{:.0f} \u00b5m from vessels", 1e6 * margin), Paint::dashed("#222", 1.0, "4 3"));
}

std::vector<Eigen::Vector2d> offsetsOf(const std::vector<const TrialRecord*>& trials)
{
  std::vector<Eigen::Vector2d> offsets;
  for (const TrialRecord* trial : trials)
    for (const PulseRecord& pulse : trial->pulses) offsets.emplace_back(1e6 * (pulse.spot - pulse.wanted));
  return offsets;
}

void drawOffsets(const std::vector<Eigen::Vector2d>& offsets, const std::string& aid, const Box& plot, double range,
                 SvgCanvas& canvas)
{
  const AidStyle style = styleOf(aid);
  SvgChart chart(canvas, plot, {"x from the target (\u00b5m)", -range, range},
                 {"y from the target, up (\u00b5m)", -range, range});
  chart.title(fmt::format("{}, {} burns", style.name, offsets.size()));
  chart.axes();
  const double px = chart.place(1.0, 0.0).x() - chart.place(0.0, 0.0).x();
  canvas.clip(plot);
  for (const double ring : {kBound_um, kFar_um, 2.0 * kFar_um, 4.0 * kFar_um})
    if (ring < range) chart.dot(0.0, 0.0, ring * px, ring == kFar_um ? Paint::line("#333", 1.2) : Paint::line("#aaa"));
  // The image's y points down.
  for (const Eigen::Vector2d& offset : offsets) chart.dot(offset.x(), -offset.y(), 2.6, Paint::area(style.colour, 0.6));
  canvas.unclip();
}

}  // namespace

std::string burnFigure(const std::vector<const TrialRecord*>& trials, double margin, const std::string& name)
{
  const bool single = trials.size() == 1;
  const auto columns = static_cast<double>(trials.size());
  const double width = single ? kSinglePanel_px : (kFigureWidth - kPanelGap * (columns - 1.0)) / columns;
  Box region = regionOfBurns(trials);
  const double shape = region.isEmpty() ? 1.4 : region.sizes().x() / region.sizes().y();
  const double height = std::min(kTallest_px, width / std::max(shape, 0.8));
  region = grownTo(region, width / height, kLeastBurnPanel);
  std::size_t reasons = 0;
  for (const TrialRecord* trial : trials) reasons = std::max(reasons, lettersOf({trial}).size());
  const double bottom = 24.0 + height;
  const double legend = bottom + 15.0 * static_cast<double>(reasons) + 34.0;
  SvgCanvas canvas(kFigureWidth, single ? bottom + 10.0 : legend + 10.0, "burns over the retina");
  const RetinaBackground background(trials.front()->retina, region, margin, name);
  if (!background.empty()) canvas.insert(background.definition());
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const Box plot = boxAt(static_cast<double>(i) * (width + kPanelGap), 24.0, width, height);
    const Eigen::Vector2d reasons_at =
        single ? Eigen::Vector2d(width + kPanelGap, 250.0) : Eigen::Vector2d(plot.min().x(), bottom + 18.0);
    drawPanel(*trials[i], background, plot, region, static_cast<char>('a' + static_cast<char>(i)), reasons_at, canvas);
  }
  drawLegend(trials, margin,
             single ? Legend(canvas, {width + kPanelGap, 40.0}, 22.0) : Legend(canvas, {0.0, legend}, 0.0));
  return canvas.svg();
}

std::string placementFigure(const std::vector<std::vector<const TrialRecord*>>& aids)
{
  constexpr double kSide = 320.0, kLeft = 64.0;
  SvgCanvas canvas(kFigureWidth, kSide + 84.0, "burns as seen from their targets");
  double range = 1.25 * kFar_um;
  std::vector<std::vector<Eigen::Vector2d>> offsets;
  for (const auto& trials : aids) {
    offsets.push_back(offsetsOf(trials));
    for (const Eigen::Vector2d& offset : offsets.back()) range = std::max(range, 1.08 * offset.norm());
  }
  for (std::size_t i = 0; i < aids.size() && i < 2; ++i) {
    if (aids[i].empty()) continue;
    const Box plot = boxAt(kLeft + static_cast<double>(i) * (kSide + 2.0 * kLeft), 30.0, kSide, kSide);
    drawOffsets(offsets[i], aids[i].front()->score.aid, plot, range, canvas);
  }
  return canvas.svg();
}

}  // namespace eyeslam::trials
