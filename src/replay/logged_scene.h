// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "eyeslam/burn_plan_t.hpp"
#include "eyeslam/laser_state_t.hpp"
#include "eyeslam/messaging/map_assembler.h"
#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/replay/sorted_log.h"

namespace eyeslam::replay {

/// What a log has said so far of everything that can be drawn over a frame: the newest message of each kind, and the
/// manipulator's states of the last while, for a frame is older than they are.
class LoggedScene {
 public:
  void take(const SortedEvent& event);

  const std::optional<messaging::RetinaPose>& pose() const { return pose_; }
  const std::optional<messaging::InstrumentSight>& sight() const { return sight_; }
  const retina::VesselMap& map() const { return maps_.map(); }
  /// The last valid one.
  const std::optional<messaging::PublishedRegistration>& registration() const { return registration_; }
  const std::optional<messaging::OperatorWish>& wish() const { return wish_; }
  const std::optional<messaging::ServoStatus>& status() const { return status_; }
  /// In force, else the last one proposed; null where there is none.
  const burn_plan_t* plan() const { return in_force_ ? &*in_force_ : proposed_ ? &*proposed_ : nullptr; }
  bool emitting() const { return emitting_; }
  /// The manipulator's state nearest to a time, us since 1970; null before the first.
  const messaging::MicronState* stateAt(std::int64_t utime) const;
  /// Full-resolution um per px of the map; 0 = unknown.
  double umPerPx() const;

 private:
  struct State {
    std::int64_t utime = 0;
    messaging::MicronState state;
  };

  template <class Message, class Value>
  static bool read(const files::LogEvent& event, std::optional<Value>& value);
  void takeState(const files::LogEvent& event);
  void takePlan(const files::LogEvent& event);

  std::optional<messaging::RetinaPose> pose_;
  std::optional<messaging::InstrumentSight> sight_;
  std::optional<messaging::PublishedRegistration> registration_;
  std::optional<messaging::OperatorWish> wish_;
  std::optional<messaging::ServoStatus> status_;
  std::optional<burn_plan_t> in_force_, proposed_;
  messaging::MapAssembler maps_;
  std::deque<State> states_;
  bool emitting_ = false;
};

}  // namespace eyeslam::replay
