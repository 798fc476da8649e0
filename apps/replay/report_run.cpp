// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/report_run.h"

#include <fmt/format.h>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/output_folder.h"
#include "eyeslam/trials/report_warnings.h"
#include "eyeslam/trials/results_table.h"
#include "eyeslam/trials/trial_judge.h"
#include "eyeslam/trials/trial_report.h"
#include "replay/log_pass.h"

namespace eyeslam::apps {
namespace {

const char* const kScores = "results.json";
const char* const kTable = "results.csv";
const char* const kReport = "report.html";

trials::TrialRecord judged(const ReplayArguments& arguments)
try {
  LogPass pass(arguments, "judging");
  trials::TrialJudge judge;
  while (const auto event = pass.nextOfToday()) judge.take(event->event);
  pass.end();
  if (pass.interrupted()) throw files::FileError(arguments.log + ": interrupted; nothing written");
  if (!judge.isTrial()) {
    throw files::FileError(arguments.log + ": no MARK START of a trial: nothing says what was to be reached");
  }
  return judge.record();
} catch (const configuration::ConfigurationError& error) {  // of the log's MARK, not of the call
  throw files::FileError(fmt::format("{}: {}", arguments.log, error.what()));
}

}  // namespace

void reportLog(const ReplayArguments& arguments)
{
  files::OutputFolder folder(arguments.out, {kScores, kTable, kReport});
  const trials::TrialRecord record = judged(arguments);
  folder.write(kScores, trials::jsonOf(record.score));
  folder.write(kTable, trials::resultsTable({record.score}));
  folder.write(kReport, trials::trialReport(record));
  folder.publish();
  if (!arguments.quiet) fmt::print("{0}/{1}\n{0}/{2}\n{0}/{3}\n", arguments.out, kReport, kScores, kTable);
  if (!record.whole) throw files::FileError(fmt::format("{}: {}", arguments.log, trials::kCutOff));
}

}  // namespace eyeslam::apps
