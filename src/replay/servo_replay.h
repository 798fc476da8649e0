// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eyeslam/configuration/assignment.h"
#include "eyeslam/mark_t.hpp"
#include "eyeslam/replay/comparison.h"
#include "eyeslam/replay/goal_distances.h"
#include "eyeslam/replay/recomputed_part.h"
#include "eyeslam/replay/servo_timeline.h"

namespace eyeslam::replay {

/// Computes the servo of a log again, from what all others sent: that of a trial in lock step, which must send the same
/// bytes, or that of `eyeslam-servo` in a log of live programs, which cannot. Which of them it is, and its
/// configuration, stand in the log's MARKs. Memory does not grow with the log.
class ServoReplay final : public RecomputedPart {
 public:
  /// @param changes     over the recorded configuration, keys as it has them: "servo.cycle.lead_s=..." of a trial,
  ///                    "cycle.lead_s=..." of eyeslam-servo
  /// @param comparison  must outlive it
  ServoReplay(std::vector<configuration::Assignment> changes, Comparison& comparison);

  /// @throws ReplayError  a message of its channels is of another version's type
  void take(const SortedEvent& event) override;
  void finish() override;
  std::string about() const override { return about_; }
  std::string lacking() const override;

  const GoalDistances& goals() const { return goals_; }
  /// Of a live program: what it says is not expected to be the same.
  bool isLive() const { return live_; }

 private:
  void take(const mark_t& mark, std::int64_t utime);
  void beginTrial(const mark_t& mark, std::int64_t utime);
  void beginLive(const mark_t& mark, std::int64_t utime);
  void end();

  std::vector<configuration::Assignment> changes_;
  Comparison& comparison_;
  GoalDistances goals_;
  std::unique_ptr<ServoTimeline> timeline_;
  mark_t start_{};  // of what is computed
  std::string about_;
  std::int64_t part_ = 0;                // of the log, where several were joined
  std::optional<std::int64_t> stopped_;  // us since 1970, when the MARK said so
  bool bare_hand_ = false, live_ = false;
};

}  // namespace eyeslam::replay
