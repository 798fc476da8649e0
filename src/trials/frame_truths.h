// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>

#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/messaging/subscription.h"
#include "eyeslam/messaging/truth_messages.h"
#include "eyeslam/retina/pose2.h"

namespace eyeslam::trials {

/// Where a place of the retina is seen in the tracker's map: what anyone who looks at the picture can point at. Goes
/// through the newest frame that the tracker knows, by that frame's true pose.
class FrameTruths {
 public:
  /// @param image_centre_px  of a frame; @param link  must outlive it
  FrameTruths(const Eigen::Vector2d& image_centre_px, messaging::Link& link);

  /// @param place  retina frame, m
  /// @return map px; none while the tracker has seen nothing
  std::optional<Eigen::Vector2d> seenAt(const Eigen::Vector2d& place) const;
  /// The newest map that poses speak of; 0 before the first.
  std::int64_t mapId() const { return map_id_; }

 private:
  struct Frame {
    std::int64_t number = -1;
    retina::Pose2 pose;
  };
  void take(const truth_t& truth);
  void take(const messaging::RetinaPose& pose);

  Eigen::Vector2d centre_px_;
  double m_per_px_ = 0.0;
  std::deque<Frame> frames_;  // the newest, whose poses have not all come
  std::optional<retina::Pose2> truth_, seen_;
  std::int64_t map_id_ = 0;
  messaging::Subscription<truth_t> truths_;
  messaging::Subscription<retina_pose_t> poses_;
};

}  // namespace eyeslam::trials
