// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "eyeslam/replay/log_survey.h"

namespace eyeslam::apps {

/// Names and notes that come from a log, without what would steer a terminal.
std::string printable(std::string text);

/// For people: a head, a line a channel, then what is wrong, then the MARKs.
std::string surveyText(const replay::LogSurvey& survey, const std::string& path);

/// For programs: all that the survey holds; times in s since the log's first event, ages in ms.
std::string surveyJson(const replay::LogSurvey& survey, const std::string& path);

}  // namespace eyeslam::apps
