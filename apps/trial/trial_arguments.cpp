// SPDX-License-Identifier: GPL-3.0-or-later
#include "trial/trial_arguments.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <set>

#include "command_line/program.h"

namespace eyeslam::apps {
namespace {

const char* const kExamples =
    "  eyeslam-trial scenarios/vessel_tracing.yaml --out results\n"
    "  eyeslam-trial scenarios/vessel_tracing.yaml --set 'aid=none hard' --seeds 20 --out study\n"
    "  eyeslam-trial scenarios/*.yaml --set duration_s=5 --out everything\n"
    "  eyeslam-trial scenarios/vessel_tracing.yaml --set aid=hard --real-time --out live\n"
    "  eyeslam-trial scenarios/laser_rings.yaml --set retina=fundus.png --set motion=jerky --out jerky\n"
    "  eyeslam-trial scenarios/laser_rings.yaml --dump-config > mine.yaml\n";

constexpr std::int64_t kMostSeeds = 10000;

void addSeeds(CLI::App& app, TrialArguments& a)
{
  CLI::Option* seeds = app.add_option("--seeds", a.seeds, "Run each with the seeds 0 to N-1")
                           ->type_name("N")
                           ->check(CLI::Range(std::int64_t{1}, kMostSeeds).description(""));
  app.add_option("--seed", a.seed, "Run each with this seed alone; default 0")
      ->type_name("S")
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1} << 53).description(""))
      ->excludes(seeds);
}

bool readNumber(const std::string& text, std::size_t& number)
{
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && rest == text.data() + text.size();
}

}  // namespace

void addOptions(CLI::App& app, TrialArguments& a)
{
  app.add_option("SCENARIO", a.scenarios, "Scenario files; a list of values in one sweeps them");
  app.add_option("--out", a.out, "Folder for logs, scores and reports")->type_name("DIR");
  addSeeds(app, a);
  app.add_option("--set", a.settings, "One key of every scenario; several values are swept; may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
  app.add_option("--jobs", a.jobs, "Trials at a time; default: one a core")
      ->type_name("J")
      ->check(CLI::Range(1, 1024).description(""));
  app.add_option("--shard", a.shard,
                 "Run the I-th of N parts of the list of trials; tables of all parts make the whole")
      ->type_name("I/N");
  app.add_flag("--real-time", a.real_time,
               "As fast as time passes, with eyeslam-track and eyeslam-servo as programs of their own, one trial after "
               "the other");
  app.add_flag("--video", a.video, "Keep what the camera saw, lossless, beside the log of each trial with an aid");
  app.add_flag("--no-logs", a.no_logs, "Keep scores and reports alone");
  app.add_flag("--dump-config{yaml}", a.dump,
               "Print every option of SCENARIO (its first variant) as YAML and exit; =markdown: all keys as tables");
  app.add_flag("--quiet", a.quiet, "Print nothing but errors");
  addStandardOptions(app, kExamples);
}

void check(const TrialArguments& arguments)
{
  if (arguments.scenarios.empty())
    throw UsageError("SCENARIO is missing; a file such as scenarios/vessel_tracing.yaml is wanted");
  if (arguments.out.empty()) throw UsageError("--out is missing; a folder for the results is wanted");
  if (arguments.video && arguments.no_logs) throw UsageError("--video: stands beside the log; leave --no-logs out");
  if (arguments.real_time && arguments.jobs > 1)
    throw UsageError("--jobs: trials in real time need the computer for themselves; leave it out");
  std::set<std::string> names;
  for (const std::string& path : arguments.scenarios) {
    if (!names.insert(std::filesystem::path(path).stem().string()).second)
      throw UsageError(fmt::format("{}: two scenarios of that name; their results would share a folder", path));
  }
  shardOf(arguments);
}

Shard shardOf(const TrialArguments& arguments)
{
  const std::string& text = arguments.shard;
  const std::size_t slash = text.find('/');
  Shard shard;
  const bool read = slash != std::string::npos && readNumber(text.substr(0, slash), shard.number) &&
                    readNumber(text.substr(slash + 1), shard.count);
  if (read && shard.number >= 1 && shard.number <= shard.count) return shard;
  throw UsageError(fmt::format("--shard {}: I/N with I from 1 to N is wanted, such as 1/4", text));
}

std::vector<configuration::Assignment> settingsOf(const TrialArguments& arguments)
{
  std::vector<configuration::Assignment> settings;
  settings.reserve(arguments.settings.size());
  for (const std::string& setting : arguments.settings) settings.push_back(configuration::parseSetting(setting));
  return settings;
}

std::vector<std::uint64_t> seedsOf(const TrialArguments& arguments)
{
  std::vector<std::uint64_t> seeds;
  for (std::int64_t seed = 0; seed < arguments.seeds.value_or(0); ++seed)
    seeds.push_back(static_cast<std::uint64_t>(seed));
  if (seeds.empty()) seeds.push_back(static_cast<std::uint64_t>(arguments.seed.value_or(0)));
  return seeds;
}

}  // namespace eyeslam::apps
