// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/specular_blooms.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "eyeslam/retina/units.h"
#include "eyeslam/simulation/random.h"

namespace eyeslam::simulation {

namespace {

constexpr double kGlowReach = 4.5;  // of the core's radius; beyond it the glow is below a grey level
constexpr double kGlowFading = 0.28, kCoreFading = 1.4;  // by squares of the core's radius
constexpr double kWhitens = 3.3;                         // of it; from here on the retina's own colour prevails

double fading(double t, double from_s, double to_s)
{
  return std::clamp(4.0 * std::min(t - from_s, to_s - t), 0.0, 1.0);
}

}  // namespace

SpecularBlooms::SpecularBlooms(const SpecularBloomsOptions& options, cv::Size view, double px_scale, double duration_s,
                               std::uint64_t seed)
{
  Random random(seed, 15);
  for (int i = 0; i < options.count; ++i) {
    Bloom bloom{};
    bloom.place = {view.width * random.uniform(0.2, 0.8), view.height * random.uniform(0.1, 0.9)};
    bloom.radius = random.uniform(options.smallest_px, options.largest_px) * px_scale;
    bloom.wander = options.wander_px * px_scale * random.uniform(0.4, 1.0);
    bloom.phase_x = random.uniform(0.0, kTwoPi);
    bloom.phase_y = random.uniform(0.0, kTwoPi);
    bloom.hz = random.uniform(0.08, 0.3);
    // Two in three stay; the others come and go with the tilt of the eye.
    const bool stays = random.chance(0.67);
    bloom.from_s = stays ? -1.0 : random.uniform(0.0, 0.7) * duration_s;
    bloom.to_s = stays ? duration_s + 1.0 : bloom.from_s + random.uniform(0.1, 0.5) * duration_s;
    blooms_.push_back(bloom);
  }
}

void SpecularBlooms::addTo(cv::Mat& picture, double t) const
{
  for (const Bloom& bloom : blooms_) {
    const double bright = fading(t, bloom.from_s, bloom.to_s);
    if (bright <= 0.0) continue;
    const cv::Point2d centre =
        bloom.place + bloom.wander * cv::Point2d(std::sin(kTwoPi * bloom.hz * t + bloom.phase_x),
                                                 std::sin(kTwoPi * 1.3 * bloom.hz * t + bloom.phase_y));
    addGlow(picture, centre, bloom.radius * (0.7 + 0.3 * bright), cv::Scalar::all(bright));
  }
}

bool SpecularBlooms::mayHide(cv::Point2d place, double within_px) const
{
  return std::any_of(blooms_.begin(), blooms_.end(), [&](const Bloom& bloom) {
    const double away = std::hypot(place.x - bloom.place.x, place.y - bloom.place.y);
    return away < std::sqrt(2.0) * bloom.wander + kWhitens * bloom.radius + within_px;
  });
}

void addGlow(cv::Mat& picture, cv::Point2d centre, double radius, const cv::Scalar& colour)
{
  const double reach = kGlowReach * radius;
  const cv::Rect area = cv::Rect(cv::Point(cvFloor(centre.x - reach), cvFloor(centre.y - reach)),
                                 cv::Point(cvCeil(centre.x + reach) + 1, cvCeil(centre.y + reach) + 1)) &
                        cv::Rect({0, 0}, picture.size());
  // Fitted to the rendered sequences: a glow that alone nearly saturates, and a core within it. Of a sum of squares, so
  // each is a product of what depends on x and what depends on y.
  const auto falls = [radius](double fading, double away) {
    return std::exp(-fading * away * away / (radius * radius));
  };
  std::vector<cv::Vec2d> across;
  across.reserve(static_cast<std::size_t>(std::max(area.width, 0)));
  for (int x = area.x; x < area.x + area.width; ++x) {
    across.emplace_back(1.03 * falls(kGlowFading, x - centre.x), 0.8 * falls(kCoreFading, x - centre.x));
  }
  for (int y = area.y; y < area.y + area.height; ++y) {
    const cv::Vec2d down(falls(kGlowFading, y - centre.y), falls(kCoreFading, y - centre.y));
    auto* pixel = picture.ptr<cv::Vec4f>(y) + area.x;
    for (const cv::Vec2d& part : across) {
      const double light = part[0] * down[0] + part[1] * down[1];
      for (int c = 0; c < 3; ++c) (*pixel)[c] += static_cast<float>(light * colour[c]);
      ++pixel;
    }
  }
}

}  // namespace eyeslam::simulation
