// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "eyeslam/trials/trial_record.h"

namespace eyeslam::trials {

/// The value of a dotted key ("prescription.safety.margin_um") in a configuration; none where it has no such, or is no
/// YAML.
std::optional<std::string> configuredValue(const std::string& yaml, const std::string& key);

/// Distance that burns keep from vessels, m; 0: the configuration does not say.
double vesselMarginOf(const TrialRecord& record);

/// What every page says: against what errors are, and what the software is.
std::string truthNote();

/// Who holds the instrument: a model, with its figures from the configuration. Of manual laser trials: fitted to
/// nothing.
std::string operatorNote(const TrialRecord& record);

/// How the latencies of a trial came about: in lock step they are the scenario's, in real time measured.
std::string latencyNote(const TrialRecord& record);

}  // namespace eyeslam::trials
