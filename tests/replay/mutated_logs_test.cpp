// SPDX-License-Identifier: GPL-3.0-or-later
// Ten thousand logs broken at random: each is read to its end, with a report, and nothing that is there is left out.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>

#include "eyeslam/replay/log_survey.h"
#include "eyeslam/replay/message_tables.h"
#include "support/sanitized.h"
#include "support/written_log.h"

namespace eyeslam::replay {
namespace {

using support::headed;
using support::kLogStart;

std::string wholeLog()
{
  support::WrittenLog log;
  burn_plan_t plan = headed<burn_plan_t>(kLogStart, 0);
  plan.targets = 2;
  plan.target.resize(2);
  vessel_map_t tile = headed<vessel_map_t>(kLogStart, 0);
  tile.cells = 20;
  tile.probability.resize(20);
  tile.calibre_px.resize(20);
  tile.seen.resize(20);
  mark_t mark = headed<mark_t>(kLogStart, 0);
  mark.configuration = "aid: hard\n";
  for (int i = 0; i < 12; ++i) {
    const std::int64_t utime = kLogStart + 1000 * i;
    log.add(headed<micron_state_t>(utime, i), utime);
    log.add(headed<laser_command_t>(utime, i), utime);
    if (i % 6 == 0) log.add(mark, utime);
    if (i % 6 == 1) log.add(plan, utime);
    if (i % 6 == 2) log.add(tile, utime);
    if (i % 6 == 3) log.add("SOMEBODYS", {1, 2, 3}, utime);
  }
  const support::Bytes bytes = files::readWholeFile(log.finish());
  return {bytes.begin(), bytes.end()};
}

// What happens to files: bytes change, blocks go, come twice, or move; the end is missing.
std::string mutated(std::string bytes, std::mt19937& random)
{
  const auto place = [&random, &bytes] { return random() % bytes.size(); };
  const int changes = 1 + static_cast<int>(random() % 8);
  for (int i = 0; i < changes && bytes.size() > 1; ++i) {
    const std::size_t at = place(), size = std::min<std::size_t>(random() % 600, bytes.size() - at);
    switch (random() % 6) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
        break;
      case 1:
        bytes[at] = static_cast<char>(random());
        break;
      case 2:
        std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), std::min<std::size_t>(size, 8),
                    random() % 2 == 0 ? '\0' : '\xFF');
        break;
      case 3:
        bytes.erase(at, size);
        break;
      case 4:
        bytes.insert(place(), bytes.substr(at, size));
        break;
      default:
        if (random() % 4 == 0) bytes.resize(at + 1);
        break;
    }
  }
  return bytes;
}

TEST(MutatedLogs, AreAllReadToTheirEndWithAReport)
{
  const std::string whole = wholeLog();
  const support::TemporaryFolder folder;
  const std::string path = folder.path("mutated.lcm");
  std::mt19937 random(1);
  const int cases = support::cases(10'000);
  for (int i = 0; i < cases; ++i) {
    std::filesystem::remove(path);  // written over, file systems would wait for the disk
    std::ofstream(path, std::ios::binary) << mutated(whole, random);
    SortedLog log(path);
    LogSurveyor surveyor;
    MessageTables tables([](const std::string&) { return "/dev/null"; });
    std::int64_t events = 0;
    while (const auto event = log.next()) {
      surveyor.add(*event);
      tables.add(*event);
      ++events;
    }
    tables.finish();
    const LogSurvey survey = surveyor.survey(log);
    std::int64_t on_channels = 0;
    for (const ChannelFindings& channel : survey.channels) on_channels += channel.events;
    ASSERT_EQ(events, log.reader().events()) << "case " << i;
    ASSERT_EQ(on_channels, events) << "case " << i;
  }
}

}  // namespace
}  // namespace eyeslam::replay
