// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/laser_burns.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/smoothstep.h"
#include "eyeslam/simulation/specular_blooms.h"

namespace eyeslam::simulation {

namespace {

// Coagulated retina under white light, BGR.
const cv::Vec4f kCoagulated(0.55F, 0.64F, 0.92F, 0.0F);

}  // namespace

LaserBurns::LaserBurns(const LaserBurnsOptions& options, double px_scale) : options_(options), px_scale_(px_scale) {}

bool LaserBurns::fires(int frame) const
{
  return hasLaser() && frame >= options_.first_frame && (frame - options_.first_frame) % options_.every_frames == 0;
}

double LaserBurns::flash(int frame) const
{
  if (!hasLaser() || frame < options_.first_frame) return 0.0;
  return (frame - options_.first_frame) % options_.every_frames < options_.flash_frames ? 1.0 : 0.0;
}

void LaserBurns::burn(cv::Mat& canvas, cv::Point2d place) const
{
  const double radius = options_.burn_px * px_scale_;
  const cv::Rect area = cv::Rect(cv::Point(cvFloor(place.x - 2 * radius), cvFloor(place.y - 2 * radius)),
                                 cv::Point(cvCeil(place.x + 2 * radius) + 1, cvCeil(place.y + 2 * radius) + 1)) &
                        cv::Rect({0, 0}, canvas.size());
  for (int y = area.y; y < area.y + area.height; ++y) {
    for (int x = area.x; x < area.x + area.width; ++x) {
      const double distance = std::hypot(x - place.x, y - place.y) / radius;
      const auto part = static_cast<float>(options_.whiteness * retina::smoothstep(1.25 * (1.3 - distance)));
      auto& pixel = canvas.at<cv::Vec4f>(y, x);
      pixel += part * (kCoagulated - pixel);
    }
  }
}

void LaserBurns::addSpot(cv::Mat& picture, cv::Point2d place, int frame) const
{
  if (!hasLaser()) return;
  const double pulse = flash(frame);
  addLight(picture, place, 1.0 - pulse, pulse);
}

void LaserBurns::addLight(cv::Mat& picture, cv::Point2d place, double aiming, double flash) const
{
  const double radius = options_.aiming_px * px_scale_;
  if (flash > 0.0) addGlow(picture, place, 1.4 * radius, flash * cv::Scalar(0.8, 1.0, 0.9));
  if (aiming > 0.0) addGlow(picture, place, radius, aiming * cv::Scalar(0.08, 0.06, 0.25));
}

}  // namespace eyeslam::simulation
