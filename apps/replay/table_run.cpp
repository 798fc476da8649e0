// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/table_run.h"

#include <fmt/format.h>

#include <stdexcept>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/output_folder.h"
#include "eyeslam/replay/log_survey.h"
#include "eyeslam/replay/message_tables.h"
#include "replay/log_pass.h"
#include "replay/survey_text.h"

namespace eyeslam::apps {
namespace {

void report(const replay::TableCounts& counts)
{
  std::string text = counts.file.empty() ? fmt::format("  {:<24} no table", counts.channel)
                                         : fmt::format("  {:<24} {} rows", counts.file, counts.rows);
  const auto leftOut = [&text](std::int64_t messages, const char* why) {
    if (messages > 0) text += fmt::format(", {} left out: {}", messages, why);
  };
  leftOut(counts.changed_type, "another type");
  leftOut(counts.undecodable, "not whole");
  leftOut(counts.foreign, "not ours");
  // A channel may hold any bytes: they shall not steer the terminal.
  fmt::print("{}\n", printable(text));
}

void complain(const replay::TableCounts& counts)
{
  if (counts.changed_type == 0) return;
  const replay::MessageType* type = replay::typeOfChannel(counts.channel);
  throw std::runtime_error(fmt::format("{}: {} messages are not today's {}; {}", counts.channel, counts.changed_type,
                                       type ? type->name : "type of their channel",
                                       replay::migrationOf(type ? type->name : "such types")));
}

}  // namespace

void writeTables(const ReplayArguments& arguments)
{
  replay::LogSelection selection = selectionOf(arguments);
  LogPass pass(arguments, "writing tables");
  files::OutputFolder folder(arguments.csv, replay::MessageTables::usualFiles());
  replay::MessageTables tables([&folder](const std::string& name) { return folder.staged(name); });
  while (const auto event = pass.next()) {
    if (selection.takes(*event)) tables.add(*event);
  }
  pass.end();
  if (tables.counts().empty())
    throw files::FileError(fmt::format("{}: no event in this part; nothing written", arguments.log));
  tables.finish();
  folder.publish();
  if (!arguments.quiet) fmt::print("{}\n", arguments.csv);
  for (const replay::TableCounts& counts : tables.counts()) {
    if (!arguments.quiet) report(counts);
  }
  if (pass.interrupted()) {
    fmt::print(stderr, "eyeslam-replay: interrupted; {} holds the tables of what was read\n", arguments.csv);
  }
  for (const replay::TableCounts& counts : tables.counts()) complain(counts);
}

}  // namespace eyeslam::apps
