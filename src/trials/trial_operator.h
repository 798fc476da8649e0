// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "eyeslam/burn_plan_t.hpp"
#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/map_assembler.h"
#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/messaging/subscription.h"
#include "eyeslam/trials/frame_truths.h"
#include "eyeslam/trials/trial_scene.h"

namespace eyeslam::trials {

/// The human at the console, by messages alone: calibrates, points at what he sees, plans burns on the map, approves,
/// arms, and re-arms after a hold. What he points at is where he sees it, so the retina's truth is his eyes.
///
///   TrialOperator human(setting, scene, link);
///   each millisecond, after the link was drained: human.step(t_s, now);
class TrialOperator {
 public:
  /// @param scene, link  must outlive it
  TrialOperator(const TrialSetting& setting, const TrialScene& scene, messaging::Link& link);

  /// @param t_s  since the start of the trial
  void step(double t_s, const messaging::ReceiveTime& now);

  /// What counts has been asked for: the aid, or the plan.
  bool asked() const { return asked_s_.has_value(); }
  double askedAt() const { return *asked_s_; }
  /// No target of the plan in force waits any more.
  bool planDone() const;
  /// Whether what he says arrives.
  void setLinked(bool linked) { linked_ = linked; }

 private:
  enum class Phase { ready, calibrates, waits, guided };

  messaging::OperatorWish wish() const;
  void goOn(double t_s, std::int64_t utime);
  void choose(double t_s, std::int64_t utime);
  bool point(const Eigen::Vector2d& place);
  bool plan(std::int64_t utime);
  void rearm(double t_s);

  const TrialSetting& setting_;
  const TrialScene& scene_;
  FrameTruths truths_;
  messaging::MapAssembler maps_;
  messaging::Subscription<vessel_map_t> tiles_;
  messaging::Subscription<registration_t> registrations_;
  messaging::Subscription<servo_status_t> statuses_;
  messaging::Subscription<burn_plan_t> heard_plans_;
  messaging::Publisher<operator_t> wishes_;
  messaging::Publisher<burn_plan_t> plans_;
  Phase phase_ = Phase::ready;
  std::int64_t periods_ = 0;
  double ready_until_s_ = 1.0;  // then a map is there
  double calibrates_from_s_ = 0.0, waits_from_s_ = 0.0;
  std::optional<double> asked_s_, held_s_;
  std::int64_t rearmed_ = 0;
  messaging::WantedFixture fixture_;
  burn_plan_t plan_{}, in_force_{};
  bool linked_ = true;
};

}  // namespace eyeslam::trials
