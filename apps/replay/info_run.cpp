// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/info_run.h"

#include <fmt/format.h>

#include "eyeslam/files/partial_file.h"
#include "eyeslam/files/whole_file.h"
#include "eyeslam/replay/log_survey.h"
#include "replay/log_pass.h"
#include "replay/survey_text.h"

namespace eyeslam::apps {

void showLog(const ReplayArguments& arguments)
{
  LogPass pass(arguments, "reading");
  replay::LogSurveyor surveyor;
  while (const auto event = pass.next()) surveyor.add(*event);
  pass.requireEvents();
  const replay::LogSurvey survey = surveyor.survey(pass.log());
  if (!arguments.json.empty()) {
    files::PartialFile file(arguments.json);
    files::writeWholeFile(file.partialPath(), surveyJson(survey, arguments.log));
    file.publish();
  }
  if (!arguments.quiet) fmt::print("{}", surveyText(survey, arguments.log));
  if (pass.interrupted()) fmt::print(stderr, "eyeslam-replay: interrupted; this is only the beginning of the log\n");
}

}  // namespace eyeslam::apps
