// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/illumination.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "eyeslam/retina/smoothstep.h"
#include "eyeslam/retina/units.h"

namespace eyeslam::simulation {

namespace {

constexpr int kLightCell = 8;  // light is smooth: computed once per cell, interpolated between
constexpr double kSwitching_s = 0.02;

}  // namespace

Illumination::Illumination(const IlluminationOptions& options, cv::Size view, double px_scale, double duration_s,
                           std::uint64_t seed)
    : options_(options), view_(view), px_scale_(px_scale)
{
  Random random(seed, 12);
  const cv::Point2d centre((view.width - 1) / 2.0, (view.height - 1) / 2.0);
  const double reach = 0.12 * view.width;
  cone_centre_ = centre + cv::Point2d(random.uniform(-reach, reach), random.uniform(-reach, reach));
  phase_x_ = random.uniform(0.0, kTwoPi);
  phase_y_ = random.uniform(0.0, kTwoPi);
  const double offset = options.rim_offset_px * px_scale;
  rim_centre_ = centre + cv::Point2d(random.uniform(-offset, offset), random.uniform(-offset, offset));
  rim_radius_ = options.rim_radius_px * px_scale;
  drawField(options.rim_softness_px * px_scale);
  planBlackouts(duration_s, random);
}

void Illumination::drawField(double softness_px)
{
  field_ = cv::Mat_<float>(view_, 1.0F);
  if (!hasRim()) return;
  for (int y = 0; y < view_.height; ++y) {
    for (int x = 0; x < view_.width; ++x) {
      const double distance = std::hypot(x - rim_centre_.x, y - rim_centre_.y);
      field_(y, x) = static_cast<float>(retina::smoothstep((rim_radius_ - distance) / softness_px + 0.5));
    }
  }
}

// Spread over the video, never in its first second: a map must be able to begin.
void Illumination::planBlackouts(double duration_s, Random& random)
{
  const double share = (duration_s - 1.0) / std::max(1, options_.blackouts);
  for (int i = 0; i < options_.blackouts && share > 0.0; ++i) {
    const double length =
        std::min(random.uniform(options_.blackout_shortest_s, options_.blackout_longest_s), 0.6 * share);
    const double from = 1.0 + i * share + random.uniform(0.3, 1.0) * (0.85 * share - length);
    dark_.push_back({from, from + length});
  }
}

void Illumination::lightAt(double t, cv::Mat_<float>& light) const
{
  const double wander = options_.wander_px * px_scale_;
  const double x0 = cone_centre_.x + wander * std::sin(kTwoPi * 0.07 * t + phase_x_);
  const double y0 = cone_centre_.y + wander * std::sin(kTwoPi * 0.11 * t + phase_y_);
  const double sigma = options_.cone_px * px_scale_;
  cv::Mat_<float> cells((view_.height + kLightCell - 1) / kLightCell, (view_.width + kLightCell - 1) / kLightCell);
  // A product of what depends on x and what depends on y.
  const auto falls = [sigma](double away) { return std::exp(-away * away / (2.0 * sigma * sigma)); };
  std::vector<double> across;
  across.reserve(static_cast<std::size_t>(cells.cols));
  for (int column = 0; column < cells.cols; ++column) across.push_back(falls(kLightCell * (column + 0.5) - x0));
  for (int row = 0; row < cells.rows; ++row) {
    const double down = falls(kLightCell * (row + 0.5) - y0);
    for (int column = 0; column < cells.cols; ++column) {
      const double cone = across[static_cast<std::size_t>(column)] * down;
      cells(row, column) = static_cast<float>(options_.gain * (options_.floor + (1.0 - options_.floor) * cone));
    }
  }
  cv::resize(cells, light, view_, 0, 0, cv::INTER_LINEAR);
}

double Illumination::switchedOn(double t) const
{
  double on = 1.0;
  for (const Interval& dark : dark_) {
    const double out = std::min(retina::smoothstep((t - dark.from_s) / kSwitching_s),
                                retina::smoothstep((dark.to_s - t) / kSwitching_s));
    on = std::min(on, 1.0 - out);
  }
  return on;
}

}  // namespace eyeslam::simulation
