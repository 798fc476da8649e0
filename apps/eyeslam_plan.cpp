// SPDX-License-Identifier: GPL-3.0-or-later
// eyeslam-plan: the map of eyeslam-track in, a plan of laser burns out (contracts, sections 2 and 6).
#include <fmt/format.h>

#include "command_line/program.h"
#include "eyeslam/configuration/listing.h"
#include "eyeslam/files/prescription_file.h"
#include "plan/plan_arguments.h"
#include "plan/plan_check.h"
#include "plan/plan_run.h"

namespace {

using namespace eyeslam::apps;

constexpr const char* kDocumentHead =
    "# Keys of a prescription\n\nFor `--set KEY=VALUE` and for `--prescription FILE.yaml`, in which groups nest. This "
    "page is what\n"
    "`eyeslam-plan --dump-config=markdown` prints; `eyeslam-plan --dump-config` prints a YAML file to start from.\n"
    "Places are x and y in map px, lists of them separated by spaces, commas or as YAML lists.\n\n";

void dump(const PlanArguments& arguments)
{
  const eyeslam::fixtures::BurnPrescription prescription = prescriptionOf(arguments);
  if (arguments.dump == "yaml")
    fmt::print("{}", eyeslam::files::prescriptionYaml(prescription));
  else if (arguments.dump == "markdown")
    fmt::print("{}{}", kDocumentHead, eyeslam::configuration::markdownOf(prescription));
  else
    throw UsageError(fmt::format("--dump-config={}: yaml or markdown is wanted", arguments.dump));
}

}  // namespace

int main(int argc, char** argv)
{
  PlanArguments arguments;
  return runProgram("eyeslam-plan", "Plans laser burns between the vessels of a map.", argc, argv,
                    [&arguments](CLI::App& app) {
                      addOptions(app, arguments);
                      return [&arguments] {
                        if (!arguments.dump.empty()) return dump(arguments);
                        check(arguments);
                        if (!arguments.check.empty()) return checkPlan(arguments);
                        makePlan(arguments);
                      };
                    });
}
