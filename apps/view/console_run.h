// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command_line/interruption.h"
#include "link/program_link.h"
#include "view/line_reader.h"
#include "view/operator_console.h"
#include "view/view_arguments.h"

namespace eyeslam::apps {

/// `eyeslam-view --console`: lines of standard input until they end, `quit`, or Ctrl-C; then Standby.
class ConsoleRun {
 public:
  /// @throws UsageError
  explicit ConsoleRun(const ViewArguments& arguments);

  /// @throws CommandError  a line of a pipe or file could not be obeyed, or what it awaits did not come
  void run();

 private:
  void obeyLines();
  void obey(const std::string& line);
  void turn(bool reads);
  void endInStandby();

  Interruption interruption_;  // before any thread
  bool terminal_;
  LineReader lines_;
  messaging::Link link_;
  RunMark mark_;
  OperatorConsole console_;
  long line_ = 0;
};

}  // namespace eyeslam::apps
