// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "eyeslam/replay/comparison.h"
#include "eyeslam/replay/goal_distances.h"
#include "eyeslam/replay/kept_message.h"

namespace eyeslam::replay {

/// Pairs what the servo says in a cycle with what was recorded of the same cycle, channel by channel, in order.
class CyclePairs {
 public:
  /// @param comparison, goals  must outlive it
  CyclePairs(Comparison& comparison, GoalDistances& goals) : comparison_(comparison), goals_(goals) {}

  void record(KeptMessage message) { recorded_.push_back(std::move(message)); }
  void recompute(const files::LogEvent& event);
  /// The cycle is over: what is left was not recomputed.
  void settle();

 private:
  Comparison& comparison_;
  GoalDistances& goals_;
  std::vector<KeptMessage> recorded_;
};

}  // namespace eyeslam::replay
