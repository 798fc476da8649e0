// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/recorded_view.h"

#include <algorithm>
#include <cmath>

namespace eyeslam::simulation {

RecordedView::RecordedView(const Eigen::Vector2d& image_centre_px, double um_per_px, double kept_s, double period_s)
    : image_centre_px_(image_centre_px),
      um_per_px_(um_per_px),
      period_s_(period_s),
      ring_(static_cast<std::size_t>(std::ceil(std::max(0.0, kept_s) / period_s)) + 2)
{}

void RecordedView::add(const RetinaPose& world_T_retina)
{
  ring_[added_++ % ring_.size()] = viewPose(world_T_retina, image_centre_px_, um_per_px_);
}

retina::Pose2 RecordedView::at(double t) const
{
  if (added_ == 0) return {};
  const std::size_t oldest = added_ > ring_.size() ? added_ - ring_.size() : 0;
  const double place = std::clamp(t / period_s_, static_cast<double>(oldest), static_cast<double>(added_ - 1));
  const auto before = static_cast<std::size_t>(place);
  const retina::Pose2& a = kept(before);
  const retina::Pose2& b = kept(std::min(before + 1, added_ - 1));
  const double part = place - static_cast<double>(before);
  return {a.x + part * (b.x - a.x), a.y + part * (b.y - a.y), a.theta + part * (b.theta - a.theta), 1.0};
}

std::array<double, 6> RecordedView::warpAt(double) const { return {}; }

}  // namespace eyeslam::simulation
