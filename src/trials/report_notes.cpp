// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/report_notes.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "eyeslam/trials/aid_style.h"

namespace eyeslam::trials {

namespace {

/// "gain 2.6 1/s, reaction 200 ms", of those that the configuration has.
std::string figuresOf(const std::string& yaml, const std::vector<std::vector<std::string>>& names)
{
  std::string text;
  for (const std::vector<std::string>& name : names) {
    const std::optional<std::string> value = configuredValue(yaml, name[0]);
    if (value) text += fmt::format("{}{} {} {}", text.empty() ? "" : ", ", name[1], *value, name[2]);
  }
  return text.empty() ? "not in the configuration" : text;
}

}  // namespace

std::optional<std::string> configuredValue(const std::string& yaml, const std::string& key)
{
  try {
    YAML::Node node = YAML::Load(yaml);
    std::istringstream parts(key);
    std::string part;
    while (std::getline(parts, part, '.')) {
      if (!node.IsMap() || !node[part]) return std::nullopt;
      node.reset(node[part]);
    }
    if (!node.IsScalar()) return std::nullopt;
    return node.as<std::string>();
  } catch (const YAML::Exception&) {
    return std::nullopt;
  }
}

double vesselMarginOf(const TrialRecord& record)
{
  const auto um = configuredValue(record.configuration, "prescription.safety.margin_um");
  const double value = um ? std::strtod(um->c_str(), nullptr) : 0.0;
  return std::isfinite(value) && value > 0.0 ? 1e-6 * value : 0.0;
}

std::string truthNote()
{
  return "All errors are against the simulation's truth, never against the system's own estimate. Eye, hand, Micron, "
         "laser and camera are simulated. This is research software: no medical device, and nothing here was measured "
         "on tissue or on a patient.";
}

std::string operatorNote(const TrialRecord& record)
{
  const std::string hand =
      figuresOf(record.configuration, {{"hardware.hand.surgeon.gain_hz", "gain", "1/s"},
                                       {"hardware.hand.surgeon.reaction_ms", "reaction", "ms"},
                                       {"hardware.hand.surgeon.dead_zone_um", "dead zone", "\u00b5m"},
                                       {"hardware.hand.surgeon.lag_ms", "lag", "ms"},
                                       {"hardware.hand.tremor.tremor_low_um", "tremor at least", "\u00b5m"},
                                       {"hardware.hand.tremor.tremor_high_um", "at most", "\u00b5m RMS an axis"}});
  if (record.score.aid != "manual")
    return "The hand that holds the instrument, with every aid and without, is a model: " + hand + ".";
  const std::string fires =
      figuresOf(record.configuration, {{"laser.manual_gain_hz", "gain", "1/s"},
                                       {"laser.manual_within_um", "fires when the error it saw was below", "\u00b5m"},
                                       {"laser.manual_delay_ms", "from decision to pulse", "ms"}});
  return "The manual laser operator is a model fitted to nothing: a simulated hand that goes from target to target and "
         "fires once the error that it saw a reaction time ago was small (" +
         fires + "; hand: " + hand +
         "). Figures of manual operation tell how the aid compares with this model, not with a surgeon.";
}

std::string latencyNote(const TrialRecord& record)
{
  return record.computation_s.empty()
             ? "In lock step latencies are those of the scenario's camera and computer, drawn and not measured."
             : "Measured in real time.";
}

}  // namespace eyeslam::trials
