// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/instrument.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/smoothstep.h"
#include "eyeslam/retina/units.h"

namespace eyeslam::simulation {

namespace {

constexpr double kBluntTip = 0.14;  // half width at the very end, of the shaft's half width
constexpr double kMoving_s = 0.8;   // how long the way in or out takes
constexpr std::size_t kBrushed = 256;

// Light over a cylinder: `across` from -1 to 1. A broad specular line beside the middle, edges a little darker.
double metal(double across)
{
  const double line = (across + 0.2) / 0.36;
  return 0.31 + 0.35 * std::exp(-line * line) - 0.06 * across * across + 0.03 * across;
}

}  // namespace

double Instrument::Wave::at(double t) const { return amplitude * std::sin(kTwoPi * hz * t + phase); }

Instrument::Instrument(const InstrumentOptions& options, cv::Size view, double px_scale, double duration_s,
                       std::uint64_t seed)
    : options_(options), view_(view), px_scale_(px_scale)
{
  Random random(seed, 13);
  width_px_ = random.uniform(options.narrowest_px, options.widest_px) * px_scale;
  const bool from_right = random.chance(0.5);
  angle_ = random.uniform(-0.55, 0.35) + (from_right ? kPi : 0.0);
  place_ = {view.width * random.uniform(0.42, 0.62), view.height * random.uniform(0.35, 0.6)};
  shadow_offset_ = cv::Point2d(random.uniform(-0.25, 0.25), random.uniform(0.35, 0.6)) * width_px_;
  for (std::vector<Wave>* axis : {&x_, &y_}) {
    for (const double hz : {0.13, 0.31, 0.7}) {
      const double amplitude = options.wander_px * px_scale * 0.1 / hz * random.uniform(0.5, 1.0);
      axis->push_back({amplitude, hz * random.uniform(0.8, 1.2), random.uniform(0.0, kTwoPi)});
    }
    // The hand's tremor, 8-12 Hz (facts, C).
    axis->push_back({0.6 * px_scale, random.uniform(8.0, 12.0), random.uniform(0.0, kTwoPi)});
  }
  turn_.push_back({random.uniform(0.08, 0.16), random.uniform(0.08, 0.2), random.uniform(0.0, kTwoPi)});
  for (std::size_t i = 0; i < kBrushed; ++i) brushed_.push_back(static_cast<float>(random.normal()));
  planVisits(duration_s, random);
}

void Instrument::planVisits(double duration_s, Random& random)
{
  const double total = options_.present_fraction * duration_s;
  if (total <= 0.0) return;
  if (options_.present_fraction > 0.9) {
    visits_.push_back({-10.0, duration_s + 10.0});
    return;
  }
  // One visit in six seconds, each in its share of the video.
  const int count = std::max(1, static_cast<int>(duration_s / 6.0));
  const double share = duration_s / count;
  const double length = total / count;
  for (int i = 0; i < count; ++i) {
    const double from = i * share + random.uniform(0.0, 1.0) * (share - length);
    visits_.push_back({from, from + length});
  }
}

double Instrument::retreat(double t) const
{
  double out = 1.0;
  for (const Visit& visit : visits_) {
    out = std::min(
        out, retina::smoothstep((visit.from_s - t) / kMoving_s) + retina::smoothstep((t - visit.to_s) / kMoving_s));
  }
  return std::min(out, 1.0);
}

InstrumentPose Instrument::at(double t) const
{
  InstrumentPose pose;
  pose.shaft_width = width_px_;
  pose.shaft_angle = angle_;
  for (const Wave& wave : turn_) pose.shaft_angle += wave.at(t);
  cv::Point2d tip = place_;
  for (const Wave& wave : x_) tip.x += wave.at(t);
  for (const Wave& wave : y_) tip.y += wave.at(t);
  // As far back as takes every part of it out of the picture.
  const double away = retreat(t) * (1.2 * std::hypot(view_.width, view_.height) + 2.0 * width_px_);
  pose.tip = tip - away * cv::Point2d(std::cos(pose.shaft_angle), std::sin(pose.shaft_angle));
  pose.present = pose.tip.x >= 0 && pose.tip.y >= 0 && pose.tip.x <= view_.width - 1 && pose.tip.y <= view_.height - 1;
  return pose;
}

cv::Rect Instrument::reach(const InstrumentPose& pose, double margin) const
{
  const double half = 0.5 * pose.shaft_width + margin;
  const double far = 2.0 * (view_.width + view_.height);
  const double end_x = pose.tip.x - far * std::cos(pose.shaft_angle);
  const double end_y = pose.tip.y - far * std::sin(pose.shaft_angle);
  const cv::Point low(cvFloor(std::min(pose.tip.x, end_x) - half), cvFloor(std::min(pose.tip.y, end_y) - half));
  const cv::Point high(cvCeil(std::max(pose.tip.x, end_x) + half), cvCeil(std::max(pose.tip.y, end_y) + half));
  return cv::Rect(low, high) & cv::Rect({0, 0}, view_);
}

// Of a row, the columns that are no farther from the outline than `margin`, and a few more.
cv::Range Instrument::columnsNear(const InstrumentPose& pose, double margin, int y, const cv::Rect& area) const
{
  constexpr double kFlat = 1e-3;  // a row along which, or across which, the shaft lies does not bound it
  const double c = std::cos(pose.shaft_angle), s = std::sin(pose.shaft_angle), dy = y - pose.tip.y;
  double low = area.x, high = area.x + area.width - 1;
  if (std::abs(s) > kFlat) {
    const double reach = (0.5 * pose.shaft_width + margin) / std::abs(s), middle = pose.tip.x + dy * c / s;
    low = std::max(low, middle - reach - 1.0);
    high = std::min(high, middle + reach + 1.0);
  }
  if (std::abs(c) > kFlat) {
    const double ahead = pose.tip.x + (margin - dy * s) / c;
    c > 0.0 ? high = std::min(high, ahead + 1.0) : low = std::max(low, ahead - 1.0);
  }
  return low > high ? cv::Range(0, 0)
                    : cv::Range(cvFloor(low), cvCeil(high) + 1) & cv::Range(area.x, area.x + area.width);
}

// Signed distance to the outline, negative inside; px. Beside the taper it is measured across, near enough.
double Instrument::distanceOutside(double behind, double aside, double width) const
{
  const double taper = options_.taper_widths * width;
  const double part = std::clamp(behind / taper, 0.0, 1.0);
  // The taper bulges a little, as ground tips do.
  const double half = 0.5 * width * (kBluntTip + (1.0 - kBluntTip) * part * (1.35 - 0.35 * part));
  return std::max(std::abs(aside) - half, -behind);
}

int Instrument::draw(const InstrumentPose& pose, const cv::Mat_<float>& field, cv::Mat& picture) const
{
  const double c = std::cos(pose.shaft_angle);
  const double s = std::sin(pose.shaft_angle);
  const double soft = options_.softness_px * px_scale_;
  const cv::Rect area = reach(pose, 2.0 * soft);
  int covered = 0;
  for (int y = area.y; y < area.y + area.height; ++y) {
    const cv::Range columns = columnsNear(pose, soft, y, area);
    for (int x = columns.start; x < columns.end; ++x) {
      const double behind = -((x - pose.tip.x) * c + (y - pose.tip.y) * s);
      const double aside = -(x - pose.tip.x) * s + (y - pose.tip.y) * c;
      const double outside = distanceOutside(behind, aside, pose.shaft_width);
      if (outside > soft) continue;
      const double alpha = retina::smoothstep(0.5 - 0.5 * outside / soft);
      const double half = 0.5 * pose.shaft_width *
                          std::max(kBluntTip, std::min(1.0, behind / (options_.taper_widths * pose.shaft_width)));
      const double place = std::max(0.0, behind) * 4.0 / pose.shaft_width;
      const std::size_t cell = static_cast<std::size_t>(place);
      const double part = place - std::floor(place);
      const double grain = (1.0 - part) * brushed_[cell % kBrushed] + part * brushed_[(cell + 1) % kBrushed];
      const double grey = metal(std::clamp(aside / half, -1.0, 1.0)) * (1.0 + 0.06 * grain);
      auto& pixel = picture.at<cv::Vec4f>(y, x);
      const cv::Vec4f colour(static_cast<float>(0.94 * grey), static_cast<float>(0.99 * grey), static_cast<float>(grey),
                             0.0F);
      pixel += static_cast<float>(alpha) * (colour - pixel);
      if (alpha >= 0.5 && field(y, x) > 0.5F) ++covered;
    }
  }
  return covered;
}

void Instrument::castShadow(const InstrumentPose& pose, cv::Mat_<float>& light) const
{
  InstrumentPose shadow = pose;
  shadow.tip += shadow_offset_;
  const double c = std::cos(pose.shaft_angle);
  const double s = std::sin(pose.shaft_angle);
  const double soft = 0.35 * pose.shaft_width + 2.0 * px_scale_;
  const cv::Rect area = reach(shadow, soft);
  for (int y = area.y; y < area.y + area.height; ++y) {
    const cv::Range columns = columnsNear(shadow, soft, y, area);
    for (int x = columns.start; x < columns.end; ++x) {
      const double behind = -((x - shadow.tip.x) * c + (y - shadow.tip.y) * s);
      const double aside = -(x - shadow.tip.x) * s + (y - shadow.tip.y) * c;
      const double outside = distanceOutside(behind, aside, pose.shaft_width);
      if (outside > soft) continue;
      light(y, x) *= static_cast<float>(1.0 - options_.shadow_depth * retina::smoothstep(0.5 - 0.5 * outside / soft));
    }
  }
}

}  // namespace eyeslam::simulation
