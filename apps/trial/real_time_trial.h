// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "command_line/child_program.h"
#include "command_line/scratch_folder.h"
#include "eyeslam/files/log_event.h"
#include "eyeslam/messaging/event_tap.h"
#include "eyeslam/messaging/link.h"
#include "eyeslam/trials/trial_world.h"
#include "real_time/catch_up.h"
#include "real_time/frame_feed.h"
#include "real_time/real_time_loop.h"

namespace eyeslam::apps {

/// One trial in real time: surgeon, eye, Micron, laser, camera and the human at the console in this program, at 1 kHz;
/// eyeslam-track and eyeslam-servo beside it as the programs that they are. Between them is nothing but LCM at an
/// address of the trial's own, which does not leave this computer, and the camera's frames in shared memory.
class RealTimeTrial {
 public:
  using Each = std::function<void(const files::LogEvent&)>;

  /// @param setting, scene  must outlive it
  /// @param video  file for the pictures that the tracker saw; empty: none
  /// @param each   hears every message as a logger would, on the thread that calls `run`
  /// @throws std::invalid_argument  the scenario has a fault that a camera in real time has not
  RealTimeTrial(const trials::TrialSetting& setting, const trials::TrialName& name, const trials::TrialScene& scene,
                std::string video, Each each);

  /// @param goesOn  is told the time since the start, s, every so often; false ends the trial
  /// @return whether it was run to its end
  /// @throws std::runtime_error  a program beside it could not be started, or has ended
  bool run(const std::function<bool(double)>& goesOn);

 private:
  void startPrograms();
  void waitForPrograms();
  void startWorld();
  bool cycle(const CycleStart& start);
  void hear(int timeout_ms);
  bool programsRun();
  void checkPrograms();
  void endPrograms();

  const trials::TrialSetting& setting_;
  const trials::TrialName name_;
  const trials::TrialScene& scene_;
  std::string video_;
  std::string url_, shm_;
  ScratchFolder scratch_;
  messaging::Link logger_;
  std::set<std::string> started_;  // programs whose MARK START has come
  messaging::EventTap tap_;
  messaging::Link link_;  // of the world's thread
  std::optional<FrameFeed> feed_;
  std::optional<ChildProgram> tracker_, servo_;
  std::optional<trials::TrialWorld> world_;
  std::atomic<double> time_s_{0.0};
  CatchUp catch_up_;
  std::optional<RealTimeLoop> loop_;  // last: it uses the others
};

}  // namespace eyeslam::apps
