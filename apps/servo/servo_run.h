// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "command_line/interruption.h"
#include "eyeslam/messaging/link.h"
#include "link/program_link.h"
#include "real_time/real_time_loop.h"
#include "servo/cycle_record.h"
#include "servo/servo_arguments.h"
#include "servo/servo_desk.h"
#include "servo/servo_exchanges.h"
#include "servo/servo_loop.h"

namespace eyeslam::apps {

/// `eyeslam-servo`: the loop's thread, and this one, which prepares, prints and waits for Ctrl-C.
class ServoRun {
 public:
  /// @throws UsageError, ConfigurationError, files::FileError
  explicit ServoRun(const ServoArguments& arguments);

  /// Until Ctrl-C, after which the tip is handed over to the controller. @throws what ended the loop
  void run();

 private:
  void resume();
  void keep(const messaging::PublishedRegistration& registration) const;
  void startLoop();
  void turn();
  void sayStatus();
  void handOver();
  void writeTiming() const;
  void say(const std::string& line) const;

  const ServoArguments& arguments_;
  const servo::ServoConfiguration options_;
  Interruption interruption_;     // before any thread
  messaging::Link loop_link_;     // messages of fixed size only
  messaging::Link patient_link_;  // maps and plans
  CycleRecord record_;
  ServoExchanges exchanges_;
  ServoDesk desk_;
  RunMark mark_;
  messaging::ServoStatus status_;
  std::string last_state_;
  std::optional<ServoLoop> loop_;
  std::optional<RealTimeLoop> thread_;  // last: it uses the others
};

}  // namespace eyeslam::apps
