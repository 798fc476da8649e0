// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/frame_shutter.h"

#include <algorithm>
#include <cmath>

namespace eyeslam::simulation {

namespace {

constexpr std::uint64_t kPicture = 90;  // stream of the seed
constexpr double kSlack_s = 3e-3;       // kept before and after an exposure

}  // namespace

FrameShutter::FrameShutter(const EyeCameraOptions& options, std::uint64_t seed, double period_s)
    : size_(options.width, options.height),
      fps_(options.fps),
      exposure_(exposureTime(options)),
      period_s_(period_s),
      m_per_px_(umPerPx(options, seed) * 1e-6),
      drift_(options.drift_um * 1e-6),
      drift_kept_(std::exp(-period_s / options.drift_s)),
      random_(seed, kPicture),
      view_({imageCentre(options).x, imageCentre(options).y}, m_per_px_ * 1e6, exposure_ + kSlack_s, period_s)
{}

void FrameShutter::wander()
{
  const double fresh = drift_ * std::sqrt(1.0 - drift_kept_ * drift_kept_);
  const double x = random_.normal();
  picture_ = drift_kept_ * picture_ + fresh * Eigen::Vector2d(x, random_.normal());
}

void FrameShutter::expose(const SceneNow& scene)
{
  if (++periods_ > 0) wander();
  t_s_ = static_cast<double>(periods_) * period_s_;
  RetinaPose seen = scene.world_T_retina;
  seen.shift.head<2>() += picture_;
  view_.add(seen);
  if (t_s_ < middle() - exposure_ / 2.0 && sum_.count == 0.0) return;
  const Eigen::Vector3d picture(picture_.x(), picture_.y(), 0.0);
  sum_.tip += scene.tip + picture;
  sum_.spot += scene.spot + picture;
  sum_.shaft += scene.shaft;
  sum_.aiming += scene.aiming ? 1.0 : 0.0;
  sum_.emitting += scene.emitting ? 1.0 : 0.0;
  sum_.count += 1.0;
}

cv::Point2d FrameShutter::pixel(const Eigen::Vector3d& world) const
{
  return {world.x() / m_per_px_, world.y() / m_per_px_};
}

ToolInView FrameShutter::toolInView() const
{
  ToolInView seen;
  seen.tool.tip = pixel(sum_.tip / sum_.count);
  seen.tool.shaft_angle = std::atan2(-sum_.shaft.y(), -sum_.shaft.x());
  seen.tool.present = cv::Rect2d(0.0, 0.0, size_.width - 1, size_.height - 1).contains(seen.tool.tip);
  seen.spot = pixel(sum_.spot / sum_.count);
  seen.aiming = sum_.aiming / sum_.count;
  seen.flash = sum_.emitting / sum_.count;
  return seen;
}

std::optional<FrameDue> FrameShutter::due()
{
  // Half a nanosecond: the sums of periods and frames meet.
  if (sum_.count == 0.0 || t_s_ < middle() + exposure_ / 2.0 - 5e-10) return std::nullopt;
  FrameDue due{frame_, middle(), 0, exposure_, view_, toolInView(), {}, false};
  sum_ = {};
  ++frame_;
  return due;
}

}  // namespace eyeslam::simulation
