// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "eyeslam/files/frame_ring.h"
#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/messaging/subscription.h"
#include "eyeslam/simulation/hardware.h"
#include "real_time/real_time_loop.h"

namespace eyeslam::apps {

/// A command as the manipulator got it.
struct CommandArrival {
  std::int64_t sent = 0;         ///< us since 1970
  std::int64_t utime_image = 0;  ///< 0: none
};

/// Hand, eye and manipulator of the simulation at 1 kHz, without a camera, and a human who wants Ready.
class BenchManipulator {
 public:
  BenchManipulator(const std::string& url, const simulation::HardwareOptions& options, std::size_t expected);

  bool isReady() const { return ready_; }
  /// From now on commands are recorded.
  void record() { records_ = true; }
  void end();

  // After the end.
  const std::vector<CommandArrival>& commands() const { return arrivals_; }
  std::int64_t lost() const { return commands_.lost(); }

 private:
  bool step(const CycleStart& start);

  messaging::Link link_;
  messaging::Subscription<servo_status_t> statuses_;
  messaging::Subscription<micron_command_t> commands_;  // each one, besides what the hardware hears
  messaging::Publisher<operator_t> wishes_;
  simulation::Hardware hardware_;
  std::vector<CommandArrival> arrivals_;
  std::int64_t steps_ = 0;
  std::int64_t left_out_ = 0;
  std::atomic<bool> ready_{false};
  std::atomic<bool> records_{false};
  RealTimeLoop thread_;  // last: it uses the others
};

/// Nothing but a timer, under the same scheduling: what this computer gives to anybody.
class BareLoop {
 public:
  explicit BareLoop(std::size_t expected);

  struct Start {
    std::int64_t utime = 0;
    float lateness_us = 0.0F;
  };
  void record() { records_ = true; }
  void end();
  /// After the end.
  const std::vector<Start>& starts() const { return starts_; }

 private:
  std::vector<Start> starts_;
  std::atomic<bool> records_{false};
  RealTimeLoop thread_;
};

/// Frames that were rendered before, forwards and backwards without end, as a camera's driver would give them.
class FramePlayer {
 public:
  FramePlayer(const std::string& name, const simulation::HardwareOptions& options, int frames);
  double exposure() const { return exposure_; }

 private:
  bool step(const CycleStart& start);

  double exposure_;  // s
  std::vector<cv::Mat> frames_;
  files::FrameRingWriter ring_;
  std::int64_t number_ = 0;
  RealTimeLoop thread_;
};

}  // namespace eyeslam::apps
