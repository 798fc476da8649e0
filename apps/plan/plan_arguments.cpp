// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/plan_arguments.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "command_line/number_check.h"
#include "command_line/program.h"
#include "eyeslam/files/prescription_file.h"

namespace eyeslam::apps {
namespace {

const char* const kExamples =
    "  eyeslam-plan results --fovea 512,300 --disc 815,280\n"
    "  eyeslam-plan results --pattern hexagonal --spacing-um 400 --svg plan.svg --over mosaic\n"
    "  eyeslam-plan --dump-config > my.yaml && eyeslam-plan results --prescription my.yaml --out my.json\n"
    "  eyeslam-plan results --set pattern.kind=barrage --set 'pattern.centre_px=400 300'\n"
    "  eyeslam-plan --check results/plan.json newer_results\n";

// An option with a name of its own for a key that --set knows as well.
void addShorthand(CLI::App& app, PlanArguments& a, const char* option, const char* key, const char* type,
                  const char* about)
{
  app.add_option_function<std::string>(
         option, [&a, key](const std::string& text) { a.shorthands.push_back(fmt::format("{}={}", key, text)); },
         fmt::format("{} ({})", about, key))
      ->type_name(type);
}

void addPrescription(CLI::App& app, PlanArguments& a)
{
  app.add_option("--prescription", a.prescription, "YAML file of what is wanted; --dump-config prints all keys")
      ->type_name("FILE.yaml");
  app.add_option("--set", a.settings, "One key of it; may be repeated")
      ->type_name("GROUP.KEY=VALUE")
      ->expected(1)
      ->take_all();
  addShorthand(app, a, "--pattern", "pattern.kind", "KIND",
               "rings, arcs, grid, hexagonal, macular, squares, panretinal, spots or barrage");
  addShorthand(app, a, "--spacing-um", "pattern.spacing_um", "UM", "From centre to centre");
  addShorthand(app, a, "--spot-um", "laser.spot_um", "UM", "Diameter of the beam");
  addShorthand(app, a, "--margin-um", "safety.margin_um", "UM", "From the burn's edge to any vessel's");
  addShorthand(app, a, "--fovea", "keep_out.fovea_px", "X,Y", "The foveal centre, map px");
  addShorthand(app, a, "--disc", "keep_out.disc_px", "X,Y", "The middle of the optic disc, map px");
  addShorthand(app, a, "--start", "order.start_px", "X,Y", "Where the instrument is, map px");
  app.add_flag("--dump-config{yaml}", a.dump, "Print the prescription as YAML and exit; =markdown: as tables");
}

void addFiles(CLI::App& app, PlanArguments& a)
{
  app.add_option("DIR", a.folder, "What eyeslam-track wrote");
  app.add_option("--out", a.out, "The plan; default DIR/plan.json")->type_name("FILE");
  app.add_option("--um-per-px", a.um_per_px, "Size of a map pixel; default: that of the map's file")
      ->type_name("UM")
      ->check(within(1e-6, 1e6));
  app.add_option("--frame", a.frame, "The map as it was after this frame; default: the newest")
      ->type_name("FRAME")
      ->check(frameNumber());
  app.add_option("--svg", a.svg, "Draw the plan: white may be burnt, black is refused")->type_name("FILE.svg");
  app.add_option("--png", a.png, "The same as pixels")->type_name("FILE.png");
  app.add_option("--over", a.over, "Draw over map, mosaic, or a picture in map px (with FILE.json: as that says)")
      ->type_name("PICTURE");
  app.add_flag("--travel", a.travel, "Draw the way from burn to burn");
  app.add_option("--check", a.check,
                 "Validate a plan again on the map of DIR; fails when a target became invalid; --out keeps the result")
      ->type_name("PLAN");
  app.add_flag("--quiet", a.quiet, "Print nothing but errors");
}

void checkEnding(const char* option, const std::string& path, const char* ending)
{
  if (path.empty() || std::filesystem::path(path).extension() == ending) return;
  throw UsageError(fmt::format("{} {}: a name that ends in {} is wanted", option, path, ending));
}

}  // namespace

void addOptions(CLI::App& app, PlanArguments& arguments)
{
  addFiles(app, arguments);
  addPrescription(app, arguments);
  addStandardOptions(app, kExamples);
}

void check(const PlanArguments& arguments)
{
  if (arguments.folder.empty()) throw UsageError("DIR is missing; the folder that eyeslam-track wrote is wanted");
  checkEnding("--svg", arguments.svg, ".svg");
  checkEnding("--png", arguments.png, ".png");
  const bool prescribes =
      !arguments.prescription.empty() || !arguments.settings.empty() || !arguments.shorthands.empty();
  if (!arguments.check.empty() && prescribes) {
    throw UsageError("--check PLAN: the plan has its prescription; leave --prescription, --set and their like out");
  }
}

fixtures::BurnPrescription prescriptionOf(const PlanArguments& arguments)
{
  std::vector<std::string> settings = arguments.settings;
  settings.insert(settings.end(), arguments.shorthands.begin(), arguments.shorthands.end());
  return files::readPrescription(arguments.prescription, settings);
}

std::string planPath(const PlanArguments& arguments)
{
  if (!arguments.out.empty() || !arguments.check.empty()) return arguments.out;
  return (std::filesystem::path(arguments.folder) / "plan.json").string();
}

}  // namespace eyeslam::apps
