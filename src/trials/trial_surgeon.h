// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/messaging/subscription.h"
#include "eyeslam/simulation/hardware.h"
#include "eyeslam/simulation/traced_path.h"
#include "eyeslam/trials/trial_scene.h"

namespace eyeslam::trials {

/// What the surgeon means to do at an instant: waits at the beginning of the path until the aid that was asked for is
/// on, then follows the path. Over an automated laser's pattern he keeps the null; a manual laser he aims himself.
class TrialSurgeon {
 public:
  /// @param scene, link  must outlive it; whoever owns the link drains it
  TrialSurgeon(const TrialSetting& setting, const TrialScene& scene, messaging::Link& link);

  /// @param t_s  since the start of the trial
  simulation::SurgeonTask task(double t_s);
  /// Where a manual laser is to go, retina's surface; and how far its spot is from the tip.
  void aimAt(const Eigen::Vector2d& target, const Eigen::Vector2d& spot_from_tip);

 private:
  bool isAided() const;

  const TrialSetting& setting_;
  const TrialScene& scene_;
  std::optional<simulation::TracedPath> path_;
  std::optional<double> began_s_;
  std::optional<Eigen::Vector3d> aim_;
  messaging::Subscription<operator_t> wishes_;
  messaging::Subscription<servo_status_t> statuses_;
};

}  // namespace eyeslam::trials
