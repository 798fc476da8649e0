// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "command_line/interruption.h"
#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/messaging/subscription.h"
#include "real_time/frame_feed.h"
#include "real_time/real_time_loop.h"
#include "sim/live_world.h"
#include "sim/sim_arguments.h"

namespace eyeslam::apps {

/// `eyeslam-sim --live`: eye, hand, Micron and laser at 1 kHz, the camera beside them, until the duration is over or
/// Ctrl-C; then what the trial reached against the truth.
class LiveRun {
 public:
  /// @throws UsageError, files::FileError
  explicit LiveRun(const SimArguments& arguments);

  void run();

 private:
  void watch();
  void sayController();
  void sayWhereTheTaskIs();
  void sayScores() const;

  const SimArguments& arguments_;
  Interruption interruption_;  // before any thread
  LiveWorld::Setting setting_;
  double um_per_px_;
  FrameFeed feed_;
  messaging::Link link_;          // of the world's thread
  messaging::Link patient_link_;  // of this one: the map's poses come with frames, and printing takes its time
  RunMark mark_;
  messaging::Subscription<retina_pose_t> poses_;
  messaging::Subscription<micron_state_t> states_;
  std::string last_controller_;
  std::optional<LiveWorld> world_;
  std::int64_t place_of_map_ = 0;  // whose place was told
};

}  // namespace eyeslam::apps
