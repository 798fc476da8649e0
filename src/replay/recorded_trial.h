// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eyeslam/configuration/assignment.h"
#include "eyeslam/mark_t.hpp"
#include "eyeslam/trials/scenario.h"
#include "eyeslam/trials/trial.h"

namespace eyeslam::replay {

/// The trial that a log is of, by its MARK START.
struct RecordedTrial {
  trials::TrialName name;
  trials::TrialSetting setting;  ///< as recorded, and then as it was asked to be otherwise
  std::int64_t session = 0, start = 0;
  std::string version;
};

/// Whether a key of a trial's configuration is the tracker's, or the servo's: these two can be computed again.
bool isOfTracker(const std::string& key);
bool isOfServo(const std::string& key);

/// @param changes  keys as `eyeslam-trial` has them, over what was recorded. Those of the servo (`servo`,
///                 `preparation`, `calibration`) and of the tracker (`vision`) may be otherwise; the others decided on
///                 what is recorded
/// @return none where the MARK is not that of a trial's start
/// @throws configuration::ConfigurationError  naming the key that cannot be changed so; ReplayError: naming the version
///         that wrote what is not understood
std::optional<RecordedTrial> recordedTrial(const mark_t& mark, const std::vector<configuration::Assignment>& changes);

}  // namespace eyeslam::replay
