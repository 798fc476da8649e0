// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/frame_truths.h"

namespace eyeslam::trials {

namespace {

constexpr std::size_t kWaiting = 100;  // frames whose pose may still come

}  // namespace

FrameTruths::FrameTruths(const Eigen::Vector2d& image_centre_px, messaging::Link& link)
    : centre_px_(image_centre_px),
      truths_(link, [this](const truth_t& truth, const messaging::MessageHeader&) { take(truth); }),
      poses_(link, [this](const messaging::RetinaPose& pose, const messaging::MessageHeader&) { take(pose); })
{}

void FrameTruths::take(const truth_t& truth)
{
  m_per_px_ = 1e-6 * truth.um_per_px;
  if (truth.frame < 0 || (!frames_.empty() && frames_.back().number == truth.frame)) return;
  frames_.push_back({truth.frame, {truth.frame_x_px, truth.frame_y_px, truth.frame_theta, 1.0}});
  if (frames_.size() > kWaiting) frames_.pop_front();
}

void FrameTruths::take(const messaging::RetinaPose& pose)
{
  map_id_ = pose.map.id;
  if (!pose.motion.tracked) return;
  while (!frames_.empty() && frames_.front().number < pose.frame.frame) frames_.pop_front();
  if (frames_.empty() || frames_.front().number != pose.frame.frame) return;
  truth_ = frames_.front().pose;
  seen_ = pose.motion.map_T_frame;
}

std::optional<Eigen::Vector2d> FrameTruths::seenAt(const Eigen::Vector2d& place) const
{
  if (!truth_) return std::nullopt;
  const Eigen::Vector2d in_frame = truth_->inverse() * Eigen::Vector2d(place / m_per_px_ - centre_px_);
  return centre_px_ + *seen_ * in_frame;
}

}  // namespace eyeslam::trials
