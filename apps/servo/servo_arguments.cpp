// SPDX-License-Identifier: GPL-3.0-or-later
#include "servo/servo_arguments.h"

#include <fmt/format.h>

#include "command_line/program.h"
#include "eyeslam/configuration/assignment.h"
#include "eyeslam/configuration/listing.h"

namespace eyeslam::apps {
namespace {

constexpr const char* kExamples =
    "  eyeslam-servo --registration camera.json\n"
    "  eyeslam-servo --lcm 'udpm://239.255.76.67:7667?ttl=1' --key micron.key --registration camera.json\n"
    "  eyeslam-servo --set cycle.null_at=controller --timing cycles.csv\n"
    "  eyeslam-servo --dump-config > servo.yaml && eyeslam-servo --config servo.yaml\n"
    "What it shall do comes from eyeslam-view. Ctrl-C hands the tip over to the controller's tremor filter and ends.";

}  // namespace

void addOptions(CLI::App& app, ServoArguments& a)
{
  addLinkOptions(app, a.link);
  app.add_option("--config", a.config, "YAML file with options; --dump-config prints all")->type_name("FILE");
  app.add_option("--set", a.settings, "One option; may be repeated")
      ->type_name("GROUP.KEY=VALUE")
      ->expected(1)
      ->take_all();
  app.add_option("--registration", a.registration,
                 "The camera's registration: read at the start where the file exists, written after a calibration")
      ->type_name("FILE.json");
  app.add_option("--timing", a.timing, "Write lateness and CPU time of each cycle at the end")->type_name("FILE.csv");
  app.add_flag("--dump-config{yaml}", a.dump, "Print all options as YAML and exit; =markdown: as tables");
  app.add_flag("--quiet", a.quiet, "Print nothing but errors");
  addStandardOptions(app, kExamples);
}

servo::ServoConfiguration configurationOf(const ServoArguments& arguments)
{
  std::vector<configuration::Assignment> assignments;
  if (!arguments.config.empty()) assignments = configuration::readYaml(arguments.config);
  for (const std::string& setting : arguments.settings) assignments.push_back(configuration::parseSetting(setting));
  return configuration::applied(servo::ServoConfiguration{}, assignments);
}

void dump(const ServoArguments& arguments)
{
  const servo::ServoConfiguration options = configurationOf(arguments);
  if (arguments.dump == "yaml") {
    fmt::print("{}", configuration::yamlOf(options));
  } else if (arguments.dump == "markdown") {
    fmt::print("{}", configuration::markdownOf(options));
  } else {
    throw UsageError(fmt::format("--dump-config={}: yaml or markdown is wanted", arguments.dump));
  }
}

}  // namespace eyeslam::apps
