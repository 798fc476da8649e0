// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a log, sorted, surveyed and written as tables: no event is left out.
#include <cstdlib>

#include "eyeslam/replay/log_survey.h"
#include "eyeslam/replay/message_tables.h"
#include "temporary_file.h"

using namespace eyeslam;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  const fuzz::TemporaryFile file(bytes, size);
  replay::SortedLog log(file.path());
  replay::LogSurveyor surveyor;
  replay::MessageTables tables([](const std::string&) { return "/dev/null"; });
  std::int64_t events = 0;
  while (const auto event = log.next()) {
    surveyor.add(*event);
    tables.add(*event);
    ++events;
  }
  tables.finish();
  if (surveyor.survey(log).events != events || log.reader().events() != events) std::abort();
  return 0;
}
