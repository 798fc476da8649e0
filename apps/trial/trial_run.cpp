// SPDX-License-Identifier: GPL-3.0-or-later
#include "trial/trial_run.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>
#include <vector>

#include "command_line/interruption.h"
#include "command_line/program.h"
#include "eyeslam/configuration/listing.h"
#include "eyeslam/files/output_folder.h"
#include "eyeslam/files/partial_file.h"
#include "eyeslam/files/whole_file.h"
#include "eyeslam/trials/results_table.h"
#include "eyeslam/trials/trial_report.h"
#include "trial/trial_crew.h"
#include "trial/trial_list.h"
#include "trial/trial_summary.h"

namespace eyeslam::apps {
namespace {

constexpr const char* kDocumentHead =
    "# Keys of a scenario\n\nFor files of `eyeslam-trial`, in which groups nest, and for its `--set KEY=VALUE`. This "
    "page is what\n"
    "`eyeslam-trial --dump-config=markdown` prints; with a scenario `eyeslam-trial FILE --dump-config` prints all its "
    "values as YAML.\nSeveral values of a key, a YAML list or separated by spaces, are swept.\n\n";

std::string pathIn(const TrialArguments& arguments, const std::string& name)
{
  return (std::filesystem::path(arguments.out) / name).string();
}

// What cannot be written is better known before the trials than after them.
void checkFolder(const std::string& path) { const files::OutputFolder nothing(path, {}); }

std::string interruption(const TrialOutcomes& outcomes, std::size_t planned)
{
  return fmt::format("interrupted; {} of {} trials were run to their end and are kept", outcomes.records.size(),
                     planned);
}

std::string reportOf(const TrialOutcomes& outcomes, std::size_t planned)
{
  std::vector<std::string> missing;
  if (outcomes.interrupted) missing.push_back(interruption(outcomes, planned));
  for (const std::string& failure : outcomes.failures) missing.push_back("could not be run: " + failure);
  const auto& records = outcomes.records;
  return records.size() == 1 && missing.empty() ? trials::trialReport(records.front())
                                                : trials::studyReport(records, missing);
}

void writeStudy(const TrialArguments& arguments, const TrialOutcomes& outcomes, std::size_t planned)
{
  const std::vector<trials::TrialRecord>& records = outcomes.records;
  std::vector<trials::TrialScore> scores;
  scores.reserve(records.size());
  for (const trials::TrialRecord& record : records) scores.push_back(record.score);
  trials::writeResultsTable(pathIn(arguments, "results.csv"), scores);
  files::PartialFile report(pathIn(arguments, "report.html"));
  files::writeWholeFile(report.partialPath(), reportOf(outcomes, planned));
  report.publish();
}

void show(const TrialArguments& arguments, const std::vector<trials::TrialRecord>& records)
{
  if (arguments.quiet) return;
  fmt::print("{}  table   {}\n  report  {}\n", summaryOf(records), pathIn(arguments, "results.csv"),
             pathIn(arguments, "report.html"));
}

void endWith(const TrialOutcomes& outcomes, std::size_t planned)
{
  if (outcomes.interrupted && outcomes.records.empty())
    throw std::runtime_error("interrupted before the first trial had ended; nothing written");
  for (const std::string& failure : outcomes.failures) fmt::print(stderr, "eyeslam-trial: {}\n", failure);
  if (outcomes.interrupted) throw std::runtime_error(interruption(outcomes, planned));
  const std::size_t failed = failuresAmong(outcomes.records);
  if (failed == 0 && outcomes.failures.empty()) return;
  throw std::runtime_error(
      fmt::format("of {} trials {} failed and {} could not be run", planned, failed, outcomes.failures.size()));
}

}  // namespace

void dumpConfiguration(const TrialArguments& arguments)
{
  if (arguments.dump == "markdown") {
    fmt::print("{}{}", kDocumentHead, configuration::markdownOf(trials::TrialSetting{}));
    return;
  }
  if (arguments.dump != "yaml")
    throw UsageError(fmt::format("--dump-config={}: yaml or markdown is wanted", arguments.dump));
  if (arguments.scenarios.size() != 1) throw UsageError("--dump-config: one SCENARIO is wanted");
  const auto variants = trials::readScenario(arguments.scenarios.front(), settingsOf(arguments));
  fmt::print("{}", configuration::yamlOf(variants.front().setting));
}

void runTrials(const TrialArguments& arguments)
{
  check(arguments);
  const TrialList list(arguments);
  checkFolder(arguments.out);
  Interruption interruption;
  const TrialOutcomes outcomes = TrialCrew(list, arguments, interruption).run();
  if (!outcomes.records.empty()) {
    writeStudy(arguments, outcomes, list.trials().size());
    show(arguments, outcomes.records);
  }
  endWith(outcomes, list.trials().size());
}

}  // namespace eyeslam::apps
