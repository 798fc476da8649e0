// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "eyeslam/burn_plan_t.hpp"
#include "eyeslam/fixtures/burn_plan.h"
#include "eyeslam/laser_command_t.hpp"
#include "eyeslam/messaging/laser_messages.h"
#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/trials/trial_scene.h"

namespace eyeslam::trials {

/// The manual operation that automated burns are compared with: a model fitted to nothing (loop study, 1). The bare
/// hand goes from target to target with the aiming beam on, and fires once the error that the eye saw a reaction ago
/// was small: its mean over a moment, for an eye follows the spot's middle, not each of its trembles. What is burnt
/// stands in BURN_PLAN and LASER_COMMAND as the servo's would.
class ManualLaser {
 public:
  /// Plans on the true vessels, as he sees them. @param scene, link  must outlive it
  ManualLaser(const TrialSetting& setting, const TrialScene& scene, messaging::Link& link);

  /// One millisecond. @param spot  where the beam meets the retina, retina frame, m
  void step(const Eigen::Vector2d& spot, const messaging::ReceiveTime& now);
  /// Where he aims now, retina frame, m.
  Eigen::Vector2d target() const;
  bool done() const { return current_ >= order_.size(); }

 private:
  bool decides(const Eigen::Vector2d& spot);
  void publishPlan(std::int64_t utime);
  Eigen::Vector2d placeOf(std::size_t index) const;

  LaserTaskOptions options_;
  std::size_t reaction_;  // ms
  double m_per_px_;
  burn_plan_t plan_{};
  std::vector<std::size_t> order_;  // targets that may be burnt
  std::size_t current_ = 0;
  std::deque<Eigen::Vector2d> errors_;  // m, seen at the present target, the newest last
  std::optional<int> until_fire_;       // ms
  int firing_ = 0;                      // ms left
  std::int64_t pulse_ = 0, periods_ = 0;
  bool changed_ = true;
  messaging::Publisher<laser_command_t> commands_;
  messaging::Publisher<burn_plan_t> plans_;
};

}  // namespace eyeslam::trials
