// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "eyeslam/burn_plan_t.hpp"
#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/retina/reason.h"
#include "eyeslam/servo/preparation.h"

namespace eyeslam::servo {

/// What has become of a target; the numbers are burn_target_t's.
enum class Fate : std::int16_t { pending = 0, done = 1, missed = 2, refused = 3 };

struct TargetRecord {
  Fate fate = Fate::pending;
  retina::Reason reason = retina::Reason::none;  ///< why missed or refused
  double emitted_s = 0.0;                        ///< as the laser said
  int attempts = 0;                              ///< pulses asked for
};

/// What was burnt: of each target of the plan in force, and every place of this run of the program, so that another
/// plan does not burn there again. Never throws, never allocates but in `describe`.
class BurnLedger {
 public:
  static constexpr std::size_t kMostPlaces = 8192;

  /// Whether these records are the plan's of that hash.
  bool isOf(const messaging::Hash& hash) const noexcept { return open_ && hash_ == hash; }
  /// Starts a plan: its targets are what the message says they are, which is how a plan goes on after a restart.
  void open(const ProposedPlan& proposed) noexcept;

  std::size_t size() const noexcept { return count_; }
  const TargetRecord& at(std::size_t index) const noexcept { return records_[index]; }
  /// A pulse is asked for.
  void countAttempt(std::size_t index) noexcept;
  void record(std::size_t index, Fate fate, retina::Reason reason, double emitted_s) noexcept;

  /// A place (map px) is burnt; it is remembered for this run.
  void remember(std::int64_t map_id, const Eigen::Vector2d& place_px) noexcept;
  /// Whether a burn lies within this distance.
  bool isBurnt(std::int64_t map_id, const Eigen::Vector2d& place_px, double within_px) const noexcept;
  bool isFull() const noexcept { return places_ == kMostPlaces; }

  std::size_t count(Fate fate) const noexcept;
  /// Grows with every change.
  std::int64_t changes() const noexcept { return changes_; }

  /// The plan as it is in force: records, and what the newest map refuses. Allocates where `message` has less room than
  /// the plan has targets. @return false where the records are another plan's
  bool describe(const Preparation& preparation, burn_plan_t& message) const;

 private:
  struct Place {
    std::int64_t map_id = 0;
    Eigen::Vector2d place_px = Eigen::Vector2d::Zero();
  };

  bool open_ = false;
  messaging::Hash hash_{};
  std::array<TargetRecord, messaging::kMostTargets> records_{};
  std::size_t count_ = 0;
  std::array<Place, kMostPlaces> burnt_{};
  std::size_t places_ = 0;
  std::int64_t changes_ = 0;
};

}  // namespace eyeslam::servo
