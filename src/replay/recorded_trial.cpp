// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/recorded_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "eyeslam/replay/recorded_configuration.h"

namespace eyeslam::replay {
namespace {

using configuration::ConfigurationError;
using configuration::Field;

void requireSameExperiment(trials::TrialSetting recorded, trials::TrialSetting asked)
{
  const std::vector<Field> was = configuration::fieldsOf(recorded), is = configuration::fieldsOf(asked);
  for (std::size_t i = 0; i < was.size(); ++i) {
    if (isOfTracker(was[i].key) || isOfServo(was[i].key) ||
        configuration::textOf(was[i]) == configuration::textOf(is[i]))
      continue;
    throw ConfigurationError(fmt::format(
        "{}: decided on what is recorded, '{}'; keys of servo, preparation, calibration and vision can be otherwise",
        was[i].key, configuration::textOf(was[i])));
  }
}

}  // namespace

bool isOfTracker(const std::string& key) { return key.rfind("vision.", 0) == 0; }

bool isOfServo(const std::string& key)
{
  constexpr const char* kGroups[] = {"servo.", "preparation.", "calibration."};
  return std::any_of(std::begin(kGroups), std::end(kGroups),
                     [&key](const char* group) { return key.rfind(group, 0) == 0; });
}

std::optional<RecordedTrial> recordedTrial(const mark_t& mark, const std::vector<configuration::Assignment>& changes)
{
  const std::optional<trials::TrialName> name =
      mark.kind == mark_t::START ? trials::TrialName::parse(mark.note) : std::nullopt;
  if (!name) return std::nullopt;
  const trials::TrialSetting recorded =
      recordedConfiguration(mark, [&name](const std::string& yaml) { return trials::settingOf(name->scenario, yaml); });
  RecordedTrial trial{*name, configuration::applied(recorded, changes), mark.session, mark.utime, mark.version};
  requireSameExperiment(recorded, trial.setting);
  return trial;
}

}  // namespace eyeslam::replay
