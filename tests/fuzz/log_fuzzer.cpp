// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a log: every byte is an event's or is counted as skipped, and the reading ends.
#include <cstdlib>

#include "eyeslam/files/log_reader.h"
#include "temporary_file.h"

using namespace eyeslam;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  const fuzz::TemporaryFile file(bytes, size);
  files::LogReader log(file.path());
  std::size_t taken = 0;
  while (const auto event = log.next()) {
    if (event->channel.empty() || event->channel.size() > files::kLongestChannel) std::abort();
    taken += files::kLogHeaderBytes + event->channel.size() + event->size;
  }
  if (taken + static_cast<std::size_t>(log.damage().skipped_bytes) != size) std::abort();
  return 0;
}
