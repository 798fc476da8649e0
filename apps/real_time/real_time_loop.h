// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <thread>

namespace eyeslam::apps {

/// What a cycle of a loop knows of time; the clocks are read once, at its start.
struct CycleStart {
  std::int64_t monotonic = 0;  ///< us
  std::int64_t utime = 0;      ///< us since 1970
  double lateness = 0.0;       ///< s after the cycle was due
  double computation = 0.0;    ///< s of CPU that the cycle before took; 0 in the first
  std::int64_t left_out = 0;   ///< cycles since the start that could not begin in time
};

struct RealTimeLoopSetting {
  std::int64_t period_us = 1000;
  int priority = 0;  ///< of SCHED_FIFO, where allowed; 0: an ordinary thread
};

/// A thread that is woken by an absolute timer alone, so that its rate is the clock's, and calls `cycle` each time.
///
///   RealTimeLoop loop({1000, kLoopPriority}, [&](const CycleStart& start) { servo.cycle(start); return !over(); });
///   ...
///   loop.askToEnd();
///   loop.join();
class RealTimeLoop {
 public:
  /// @return whether there shall be another cycle
  using Cycle = std::function<bool(const CycleStart&)>;

  RealTimeLoop(const RealTimeLoopSetting& setting, Cycle cycle);
  /// Ends after the cycle that is under way.
  ~RealTimeLoop();
  RealTimeLoop(const RealTimeLoop&) = delete;
  RealTimeLoop& operator=(const RealTimeLoop&) = delete;

  /// No cycle starts any more.
  void askToEnd() { asked_to_end_ = true; }
  /// Whether it has ended: asked to, by its cycle, or by an exception of it.
  bool ended() const { return ended_; }
  /// Waits for the end. @throws what ended it, if that was an exception
  void join();

 private:
  void run() noexcept;
  void cycles();

  RealTimeLoopSetting setting_;
  Cycle cycle_;
  std::atomic<bool> asked_to_end_{false};
  std::atomic<bool> ended_{false};
  std::exception_ptr failure_;  // written before ended_, read after join
  std::thread thread_;          // last: it uses the others
};

}  // namespace eyeslam::apps
