// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/messaging/subscription.h"
#include "eyeslam/simulation/hardware.h"
#include "real_time/catch_up.h"
#include "real_time/frame_feed.h"
#include "real_time/real_time_loop.h"
#include "sim/live_task.h"
#include "sim/tip_errors.h"

namespace eyeslam::apps {

/// A fault, and when it comes.
struct TimedFault {
  simulation::HardwareFault fault;
  double t_s = 0.0;
};
/// "WHAT@SECONDS" @throws UsageError
TimedFault timedFault(const std::string& text);

/// What the simulator's own 1 kHz thread does: the world goes on by as many milliseconds as have passed, whoever was
/// late.
class LiveWorld {
 public:
  struct Setting {
    simulation::HardwareOptions hardware;
    LiveTask task;
    std::vector<TimedFault> faults;
    double duration_s = 0.0;  ///< 0: without end
    bool foot_switch = false;
    std::uint64_t seed = 1;
  };
  /// The tip's error while the hand was alone, and while the servo guided it to a point, along a vessel or to targets.
  struct Scores {
    TipErrors alone;
    TipErrors guided;
  };

  LiveWorld(const Setting& setting, messaging::Link& link, FrameFeed& feed);

  /// @return whether there shall be another cycle
  bool cycle(const CycleStart& start);

  // After the thread has ended.
  const Scores& scores() const { return scores_; }
  const simulation::Hardware& hardware() const { return hardware_; }

 private:
  simulation::SurgeonTask surgeonTask(double t_s) const;
  void step(const messaging::ReceiveTime& now);
  void injectFaults();
  void judge();
  bool isGuided() const;

  Setting setting_;
  messaging::Link& link_;
  FrameFeed& feed_;
  messaging::Subscription<servo_status_t> statuses_;
  messaging::Subscription<operator_t> wishes_;
  simulation::Hardware hardware_;
  std::size_t faults_done_ = 0;
  std::int64_t steps_ = 0;
  std::int64_t guided_since_ = -1;  // step; -1: it is not
  std::int64_t alone_since_ = 0;
  CatchUp catch_up_;
  Scores scores_;
};

}  // namespace eyeslam::apps
