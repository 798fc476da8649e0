// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/replay_arguments.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "command_line/number_check.h"
#include "command_line/program.h"

namespace eyeslam::apps {
namespace {

const char* const kExamples =
    "  eyeslam-replay info trial.lcm\n"
    "  eyeslam-replay trial.lcm\n"
    "  eyeslam-replay trial.lcm --only tracker --video video.mkv\n"
    "  eyeslam-replay trial.lcm --set servo.cycle.predicts_null=false --json difference.json\n"
    "  eyeslam-replay overlay trial.lcm --out overlay.mp4\n"
    "  eyeslam-replay report trial.lcm --out report\n"
    "  eyeslam-replay trial.lcm --csv tables\n"
    "  eyeslam-replay trial.lcm --lcm 'udpm://239.255.76.67:7667?ttl=0' --speed 0.5 --from 10\n"
    "  eyeslam-replay cut trial.lcm --from 12.5 --to 20 --channels 'MICRON_.*|MARK' --out moment.lcm\n";

CLI::App* addCommand(CLI::App& app, ReplayArguments& a, const std::string& name, const std::string& does)
{
  CLI::App* command = app.add_subcommand(name, does);
  command->add_option("LOG", a.log, "LCM log")->required();
  command->add_flag("--quiet", a.quiet, "Print nothing but errors");
  return command;
}

void addPart(CLI::App& app, ReplayArguments& a)
{
  app.add_option("--from", a.part.from, "Begin so long after the log's first event")
      ->type_name("S")
      ->check(within(-1e12, 1e12));
  app.add_option("--to", a.part.to, "End before this time")->type_name("S")->check(within(-1e12, 1e12));
  app.add_option("--channels", a.part.channels, "Only channels whose whole name this regular expression fits")
      ->type_name("REGEX");
}

CLI::App* addInfo(CLI::App& app, ReplayArguments& a)
{
  CLI::App* info = addCommand(app, a, "info", "What a log holds: channels, counts, gaps, times, versions, damage");
  info->add_option("--json", a.json, "The same for programs")->type_name("FILE");
  return info;
}

CLI::App* addCut(CLI::App& app, ReplayArguments& a)
{
  CLI::App* cut = addCommand(app, a, "cut", "A part of a log as a log");
  addPart(*cut, a);
  cut->add_option("--out", a.out, "The new log")->type_name("FILE")->required();
  return cut;
}

CLI::App* addReport(CLI::App& app, ReplayArguments& a)
{
  CLI::App* report = addCommand(app, a, "report", "Scores and report of a trial, from its log alone");
  report->add_option("--out", a.out, "Folder for them")->type_name("DIR")->required();
  return report;
}

void addVideo(CLI::App& app, ReplayArguments& a)
{
  app.add_option("--video", a.video, "The tracker's pictures; default: video.mkv beside LOG")->type_name("FILE");
  app.add_option("--offset", a.offset, "What the video's clock is behind the log's, to be believed; default 0")
      ->type_name("S")
      ->check(within(-1e5, 1e5));
}

CLI::App* addOverlay(CLI::App& app, ReplayArguments& a)
{
  CLI::App* overlay =
      addCommand(app, a, "overlay", "The video beside a log with everything drawn that the log tells of");
  addPart(*overlay, a);
  addVideo(*overlay, a);
  overlay->add_option("--out", a.out, "The new video, .mp4 or .mkv")->type_name("FILE")->required();
  return overlay;
}

void addComputing(CLI::App& app, ReplayArguments& a)
{
  app.add_option("--only", a.only, "Compute again the tracker or the servo alone")
      ->check(CLI::IsMember({"tracker", "servo"}));
  addVideo(app, a);
  app.add_option("--config", a.config, "What if: YAML file of keys that shall be otherwise than recorded")
      ->type_name("FILE");
  app.add_option("--set", a.settings, "The same for one key; may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
  app.add_option("--json", a.json, "Write what was compared for programs")->type_name("FILE");
}

// Of options that other work of this program has.
void checkComputing(const ReplayArguments& a)
{
  if (!a.part.channels.empty())
    throw UsageError("--channels: what was heard on all channels is needed to compute a log again; leave it out");
}

void checkNotComputing(const ReplayArguments& a)
{
  const std::pair<const char*, bool> given[] = {{"--only", !a.only.empty()},        {"--video", !a.video.empty()},
                                                {"--offset", a.offset.has_value()}, {"--config", !a.config.empty()},
                                                {"--set", !a.settings.empty()},     {"--json", !a.json.empty()}};
  for (const auto& [name, is_given] : given) {
    if (is_given)
      throw UsageError(fmt::format("{}: nothing is computed again with --csv or --lcm; leave it out", name));
  }
}

}  // namespace

ReplayCommands addOptions(CLI::App& app, ReplayArguments& arguments)
{
  addStandardOptions(app, kExamples);
  app.add_option("LOG", arguments.log, "LCM log, as lcm-logger or eyeslam-trial wrote it");
  addPart(app, arguments);
  addComputing(app, arguments);
  app.add_option("--csv", arguments.csv, "Write its messages as tables, one file a channel")->type_name("DIR");
  addLinkOptions(app, arguments.link);
  CLI::Option* link = app.get_option("--lcm");
  link->description("Play it onto this LCM URL, '' = the default one");
  link->each([&arguments](const std::string&) { arguments.plays = true; });
  app.get_option("--key")->description("Lets it leave this computer: 64 hexadecimal digits")->needs(link);
  app.add_option("--speed", arguments.speed, "Of playing, times real time; default 1")
      ->type_name("X")
      ->check(within(1e-3, 1e3))
      ->needs(link);
  app.add_flag("--quiet", arguments.quiet, "Print nothing but errors");
  return {addInfo(app, arguments), addCut(app, arguments), addReport(app, arguments), addOverlay(app, arguments)};
}

std::vector<configuration::Assignment> changesOf(const ReplayArguments& arguments)
{
  std::vector<configuration::Assignment> changes;
  if (!arguments.config.empty()) changes = configuration::readYaml(arguments.config, configuration::YamlLists::joined);
  for (const std::string& setting : arguments.settings) changes.push_back(configuration::parseSetting(setting));
  return changes;
}

replay::LogSelection selectionOf(const ReplayArguments& arguments)
try {
  return replay::LogSelection(arguments.part);
} catch (const std::invalid_argument& error) {
  throw UsageError(fmt::format("--from, --to, --channels: {}", error.what()));
}

void check(const ReplayArguments& arguments)
{
  if (arguments.log.empty()) throw UsageError("LOG is missing; an LCM log is wanted, as lcm-logger writes it");
  if (arguments.plays && !arguments.csv.empty()) throw UsageError("--csv and --lcm: one of them at a time");
  arguments.plays || !arguments.csv.empty() ? checkNotComputing(arguments) : checkComputing(arguments);
}

}  // namespace eyeslam::apps
