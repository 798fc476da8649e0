// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sched.h>

#include <string>

namespace eyeslam::apps {

/// SCHED_FIFO priority of a 1 kHz loop; the thread that receives its messages runs one below.
constexpr int kLoopPriority = 80;

/// Keeps all memory of the process, now and later, in RAM. Only where there is no limit: under one, each later
/// allocation might fail. @return empty, or why not, in one line
std::string lockMemory();

/// Puts the calling thread, and all that it starts from then on, under SCHED_FIFO.
/// @return empty, or why not, in one line
std::string scheduleInRealTime(int priority);

/// The calling thread's timers wake it as soon as they can instead of within 50 us; without effect under SCHED_FIFO,
/// which does so anyhow.
void sharpenTimers();

/// While it lives, the calling thread runs under SCHED_FIFO where that is allowed: for threads that others start, such
/// as LCM's receiver at the first subscription, which takes over its creator's class.
class RealTimeSection {
 public:
  explicit RealTimeSection(int priority);
  ~RealTimeSection();
  RealTimeSection(const RealTimeSection&) = delete;
  RealTimeSection& operator=(const RealTimeSection&) = delete;

  /// Empty, or why it is not in force.
  const std::string& refusal() const { return refusal_; }

 private:
  int policy_ = SCHED_OTHER;
  sched_param parameters_{};
  std::string refusal_;
};

}  // namespace eyeslam::apps
