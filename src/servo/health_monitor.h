// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/reason.h"
#include "eyeslam/servo/refusal_watch.h"
#include "eyeslam/servo/servo_ears.h"
#include "eyeslam/servo/supervisor.h"

namespace eyeslam::servo {

struct HealthMonitorOptions {
  double state_silence_ms = 50.0;
  double operator_silence_ms = 200.0;
  double pose_silence_ms = 250.0;
  double most_refused = 3.0;
  double refusal_window_ms = 1000.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("state_silence_ms", self.state_silence_ms, Range{1, 1000}, "ms",
                  "without MICRON_STATE: Hold; source: contracts, 4");
    visitor.field("operator_silence_ms", self.operator_silence_ms, Range{1, 5000}, "ms",
                  "without OPERATOR: Hold; source: contracts, 4");
    visitor.field("pose_silence_ms", self.pose_silence_ms, Range{1, 5000}, "ms",
                  "without RETINA_POSE, vision itself is silent; source: contracts, 4, age of a frame");
    visitor.field("most_refused", self.most_refused, Range{0, 15}, "",
                  "messages that a channel may refuse for one reason within the window; source: a human's plugging and "
                  "restarting gives some, a forger's attempt many");
    visitor.field("refusal_window_ms", self.refusal_window_ms, Range{1, 60000}, "ms", "that window; source: as above");
  }
};

/// What the loop knows by itself of what it needs; none = as it should be.
struct LoopSigns {
  retina::Reason cycle = retina::Reason::none;         ///< an exception or an impossible value in the last cycle
  retina::Reason state = retina::Reason::none;         ///< why no state can be used
  retina::Reason retina = retina::Reason::none;        ///< why no pose can be used: no_pose, pose_stale, pose_jumped
  retina::Reason registration = retina::Reason::none;  ///< why nothing may be servoed by it
  retina::Reason fixture = retina::Reason::none;       ///< why the wanted one cannot be made
  retina::Reason commands = retina::Reason::none;      ///< why the manipulator obeys none of those that are sent
  retina::Reason plan = retina::Reason::none;          ///< why none is in force
};

/// Health from what was heard, anew in each cycle. Events (a restart, a rival) show for the cycle in which they came;
/// the supervisor remembers. Never throws, never allocates.
class HealthMonitor {
 public:
  HealthMonitor(const HealthMonitorOptions& options, const ServoEars& ears) : options_(options), ears_(ears) {}

  /// After the link was drained, in every cycle. @param monotonic  us, now
  const Health& judge(const LoopSigns& signs, std::int64_t monotonic) noexcept;
  /// A human re-armed: what was counted before is the past.
  void forget() noexcept;

 private:
  static constexpr std::size_t kSources = 9;  // seven channels and what two devices counted

  void count(std::int64_t monotonic) noexcept;
  retina::Reason clock() const noexcept;
  retina::Reason controller() const noexcept;
  retina::Reason rival() const noexcept;
  retina::Reason stateLink(const LoopSigns& signs, std::int64_t monotonic) const noexcept;
  retina::Reason messages(std::int64_t monotonic) const noexcept;
  retina::Reason retinaOf(const LoopSigns& signs, std::int64_t monotonic) const noexcept;

  /// What had been counted when it was looked at last.
  struct Seen {
    std::int64_t states_of_others = 0, states_not_finite = 0;
    std::int64_t commands_of_others = 0;
  };
  std::int64_t commandsOfOthers() noexcept;
  Seen seenNow() noexcept;

  HealthMonitorOptions options_;
  const ServoEars& ears_;
  std::array<RefusalWatch, kSources> watches_;
  std::array<std::int64_t, 2> last_accepted_{};  // of the two command channels
  std::int64_t rival_messages_ = 0;              // accepted on them from another session
  Seen before_, now_;
  Health health_;
};

}  // namespace eyeslam::servo
