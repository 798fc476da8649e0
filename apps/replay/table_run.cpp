// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/table_run.h"

#include <fmt/format.h>

#include <stdexcept>

#include "eyeslam/files/output_folder.h"
#include "eyeslam/replay/log_survey.h"
#include "eyeslam/replay/message_tables.h"
#include "replay/log_pass.h"

namespace eyeslam::apps {
namespace {

void report(const replay::TableCounts& counts)
{
  std::string left_out;
  if (counts.changed_type > 0) left_out += fmt::format(", {} left out: another type", counts.changed_type);
  if (counts.undecodable > 0) left_out += fmt::format(", {} left out: not whole", counts.undecodable);
  if (counts.foreign > 0) left_out += fmt::format(", {} left out: not ours", counts.foreign);
  fmt::print("  {:<24} {} rows{}\n", counts.file.empty() ? "-" : counts.file, counts.rows,
             counts.file.empty() ? fmt::format(" of {}{}", counts.channel, left_out) : left_out);
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
  pass.requireEvents();
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
