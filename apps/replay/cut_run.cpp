// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/cut_run.h"

#include <fmt/format.h>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/log_writer.h"
#include "replay/log_pass.h"

namespace eyeslam::apps {

void cutLog(const ReplayArguments& arguments)
{
  replay::LogSelection selection = selectionOf(arguments);
  LogPass pass(arguments, "cutting");
  files::LogWriter part(arguments.out);
  while (const auto event = pass.next()) {
    const files::LogEvent& e = event->event;
    if (selection.takes(*event)) part.append(e.channel, e.data, e.size, e.utime);
  }
  pass.end();
  if (part.events() == 0)
    throw files::FileError(fmt::format("{}: no event in this part; nothing written", arguments.log));
  part.finish();
  if (!arguments.quiet) fmt::print("{}: {} of {} events\n", arguments.out, part.events(), pass.log().reader().events());
  if (pass.interrupted()) {
    fmt::print(stderr, "eyeslam-replay: interrupted; {} holds what was found until then\n", arguments.out);
  }
}

}  // namespace eyeslam::apps
