// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/todays_type.h"

#include <fmt/format.h>

#include "eyeslam/replay/log_survey.h"
#include "eyeslam/replay/recomputed_part.h"

namespace eyeslam::replay {

JudgedEvent judgeToday(const files::LogEvent& event)
{
  const JudgedEvent judged = judge(event);
  if (judged.standing != Standing::changed_type) return judged;
  const std::string type = judged.type ? judged.type->name : std::string("type of its channel");
  throw ReplayError(fmt::format("{} is not today's {}; {}", event.channel, type, migrationOf(type)));
}

}  // namespace eyeslam::replay
