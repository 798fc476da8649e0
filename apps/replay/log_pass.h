// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "command_line/interruption.h"
#include "command_line/progress.h"
#include "eyeslam/replay/sorted_log.h"
#include "replay/replay_arguments.h"

namespace eyeslam::apps {

/// What is read must not be replaced by what is written. @throws UsageError  an output is the log or its video
void requireOthers(const ReplayArguments& arguments);

/// One pass over a log from its beginning, with progress; Ctrl-C ends it between two events.
class LogPass {
 public:
  /// @param doing  for the progress bar
  /// @throws files::FileError; UsageError: what is to be written is what is read
  LogPass(const ReplayArguments& arguments, const std::string& doing);

  /// The next event; none at the end or when it was interrupted.
  std::optional<replay::SortedEvent> next();
  /// The same for what cannot do without any message of ours. @throws files::FileError one is of another version
  std::optional<replay::SortedEvent> nextOfToday();

  const replay::SortedLog& log() const { return log_; }
  Interruption& interruption() { return interruption_; }
  void showProgress();
  bool interrupted() const { return interrupted_; }
  /// Ends the pass.
  void interrupt() { interrupted_ = true; }

  /// @throws files::FileError when no event was found: it is no log
  void requireEvents() const;
  /// The same, and one line to stderr where anything of the log was skipped: for all that do not show its damage
  /// anyway.
  void end() const;

 private:
  static constexpr std::int64_t kTurn = 256;  // events between looks at signals and clocks

  Interruption interruption_;  // before any thread
  std::string path_;
  replay::SortedLog log_;
  Progress progress_;  // MB
  std::int64_t events_ = 0;
  bool interrupted_ = false;
};

}  // namespace eyeslam::apps
