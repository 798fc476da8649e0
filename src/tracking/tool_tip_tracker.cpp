// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/tool_tip_tracker.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "eyeslam/retina/units.h"

namespace eyeslam::tracking {

namespace {

constexpr double kUnit_widths = 1.0 / 30.0;  // a step on the axis: a px of the usual shaft of 30 px
constexpr double kBack_widths = 2.5;         // the taper's thin end is lost in the cells, a bloom may lie beyond it
constexpr double kAhead_widths = 3.0;
constexpr double kAhead_px = 40.0;       // of thin instruments whole cells may miss the tip
constexpr double kBeside_widths = 0.25;  // clear of a tapered tip
constexpr double kProtruding = 6.0;      // steps
constexpr double kEndStride = 2.0;       // steps of the coarse look for the end
constexpr double kEndGap = 2.0;          // steps of retina that end the instrument
constexpr float kPure = 0.87F;           // blue of the red: nothing but steel; a bloom's flank is that only when white
constexpr double kPureLevel = 0.9;       // of saturation
constexpr double kSharp_units = 0.5;
constexpr double kBlind_units = 6.0;
// Without colour the axis is the bright line's, beside the shaft's middle, and the end may be that of the shine.
constexpr double kGreySigma_widths = 1.0;
constexpr double kContrastPower = 1.5;

constexpr double kSharpFall = 3.5;  // steps from three quarters of the steel's blue to one; a bloom's flank has more
constexpr double kGlowStep_widths = 0.5;  // rings on which a bloom's white is looked for
constexpr int kGlowRings = 3;
constexpr int kGlowDirections = 8;

// Samples about the rough end, in units.
constexpr int kBehind = 6;
constexpr int kAhead = 16;  // past the aiming beam
constexpr std::size_t index(int unit) { return static_cast<std::size_t>(unit + kBehind); }

}  // namespace

ToolTipTracker::ToolTipTracker(const ToolTipOptions& options)
    : options_(options),
      search_(options.grey_share, options.bright_share),
      edges_(options.grey_share, kPureLevel * options.saturated)
{}

const ToolTip& ToolTipTracker::update(const Frame& frame, const OcclusionMask& mask, const cv::Mat& image)
{
  tip_ = ToolTip();
  const std::optional<Shaft> shaft = search_.find(frame, mask);
  if (!shaft) return tip_;
  // Where there is no colour, the "red" makes the share of it the level that the brightness must exceed.
  const double light = mask.medianRed() * options_.bright_share / options_.grey_share;
  const TintSampler sampler(image, frame.white(), light);
  const std::optional<ShaftAxis> axis = findAxis(sampler, *shaft);
  if (!axis) return tip_;
  if (const std::optional<End> end = findEnd(sampler, *axis)) report(*axis, *end);
  if (frame.isGrey())
    tip_.covariance += kGreySigma_widths * kGreySigma_widths * axis->width * axis->width * Eigen::Matrix2d::Identity();
  return tip_;
}

std::optional<ShaftAxis> ToolTipTracker::findAxis(const TintSampler& image, const Shaft& shaft)
{
  ShaftAxis axis{shaft.end, shaft.direction, shaft.width, 0.0};
  std::optional<ShaftAxis> better = edges_.refine(image, axis, shaft.length);
  if (better) better = edges_.refine(image, *better, shaft.length);
  return better;
}

// The mean over three places: a single row of a thin tip is noise.
Tint ToolTipTracker::across(const TintSampler& image, const ShaftAxis& axis, double along) const
{
  const double side = std::max(1.0, kUnit_widths * axis.width);
  const Tint a = image(axis.at(along, -side)), b = image(axis.at(along)), c = image(axis.at(along, side));
  return {(a.blue + b.blue + c.blue) / 3.0F, (a.red + b.red + c.red) / 3.0F};
}

std::optional<ToolTipTracker::End> ToolTipTracker::findEnd(const TintSampler& image, const ShaftAxis& axis) const
{
  const auto share = static_cast<float>(options_.grey_share);
  const double step = kEndStride * std::max(1.0, kUnit_widths * axis.width);
  const float pure = image.hasColour() ? std::max(kPure, share) : share;  // brightness has one threshold only
  const double first = -kBack_widths * axis.width;
  double last = first - step, last_pure = last;
  bool bloom = false;  // between the last pure steel and here
  for (double along = first; along < kAhead_widths * axis.width + kAhead_px; along += step) {
    if (!image.contains(axis.at(along))) return std::nullopt;  // it ends outside the picture
    const Tint tint = across(image, axis, along);
    if (tint.blue > options_.saturated) bloom = true;
    if (tint.blue > pure * tint.red && tint.blue < kPureLevel * options_.saturated) {
      last_pure = along;
      bloom = false;
    }
    if (tint.excess(share) > 0.0F) last = along;
    if (last >= first && along > last + kEndGap * step) break;
  }
  if (last_pure < first) return std::nullopt;
  return bloom ? hiddenEnd(image, axis, last_pure, last) : seenEnd(image, axis, last);
}

// What a bloom's flank may add to the error of an end that is not sharp.
double ToolTipTracker::doubtInGlow(const TintSampler& image, const ShaftAxis& axis, double along) const
{
  for (int ring = 1; ring <= kGlowRings; ++ring) {
    const double radius = ring * kGlowStep_widths * axis.width;
    for (int i = 0; i < kGlowDirections; ++i) {
      const double angle = kTwoPi * i / kGlowDirections;
      const Eigen::Vector2d at = axis.at(along + radius * std::cos(angle), radius * std::sin(angle));
      if (image.contains(at) && image(at).blue > options_.saturated) return radius + kGlowStep_widths * axis.width;
    }
  }
  return 0.0;
}

// The end lies where the blue has fallen halfway to that of the retina ahead. Blue alone: an aiming beam adds red only.
ToolTipTracker::End ToolTipTracker::seenEnd(const TintSampler& image, const ShaftAxis& axis, double rough) const
{
  const double step = std::max(1.0, kUnit_widths * axis.width);
  std::array<float, kBehind + kAhead + 1> blue;
  for (int i = -kBehind; i <= kAhead; ++i) blue[index(i)] = across(image, axis, rough + i * step).blue;
  const float steel = (blue[index(-5)] + blue[index(-4)] + blue[index(-3)]) / 3.0F;
  const float retina = *std::min_element(blue.begin() + kBehind + 3, blue.end());
  const float half = (steel + retina) / 2.0F;
  const double contrast = 1.0 - retina / std::max(steel, 1.0F);
  const double sigma = kSharp_units * step / std::pow(std::max(contrast, 0.05), kContrastPower);
  for (int i = 1 - kBehind; i <= kAhead; ++i) {
    const float before = blue[index(i - 1)], now = blue[index(i)];
    if (before <= half || now > half) continue;
    const double along = rough + step * (i - 1.0 + (before - half) / (before - now));
    int above = i - 1, below = i;
    while (above > -kBehind && blue[index(above)] < (half + steel) / 2.0F) --above;
    while (below < kAhead && blue[index(below)] > (half + retina) / 2.0F) ++below;
    const double doubt = below - above > kSharpFall ? doubtInGlow(image, axis, along) : 0.0;
    return {along, sigma * sigma + doubt * doubt};
  }
  return {rough, kBlind_units * kBlind_units * step * step};
}

// A bloom's far side is round: steel that comes out of it reaches farther on the axis than beside it. Otherwise the end
// may lie anywhere between the last steel in sight and that far side.
ToolTipTracker::End ToolTipTracker::hiddenEnd(const TintSampler& image, const ShaftAxis& axis, double from,
                                              double to) const
{
  const auto share = static_cast<float>(options_.grey_share);
  const double step = std::max(1.0, kUnit_widths * axis.width);
  double beside = from;
  for (double along = from; along <= to; along += step) {
    for (const double side : {-kBeside_widths * axis.width, kBeside_widths * axis.width}) {
      if (image(axis.at(along, side)).excess(share) > 0.0F) beside = along;
    }
  }
  if (to - beside > kProtruding * step) return seenEnd(image, axis, to);
  const double reach = to - from;
  return {from + reach / 2.0, reach * reach / 12.0};
}

void ToolTipTracker::report(const ShaftAxis& axis, const End& end)
{
  const Eigen::Vector2d tip = axis.at(end.along);
  tip_.present = true;
  tip_.x_px = tip.x();
  tip_.y_px = tip.y();
  tip_.shaft_angle = std::atan2(axis.direction.y(), axis.direction.x());
  tip_.shaft_width_px = axis.width;
  tip_.covariance = end.variance * axis.direction * axis.direction.transpose() +
                    axis.variance * axis.normal() * axis.normal().transpose();
}

}  // namespace eyeslam::tracking
