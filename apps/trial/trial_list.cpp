// SPDX-License-Identifier: GPL-3.0-or-later
#include "trial/trial_list.h"

#include <fmt/format.h>

#include <algorithm>

#include "eyeslam/configuration/listing.h"

namespace eyeslam::apps {
namespace {

using trials::Variant;

// What the surgeon is helped by and what moves decides nothing about where.
constexpr const char* kElsewhere[] = {"aid", "lambda", "motion", "null_at", "camera_hz", "latency_ms"};
constexpr double kReady_s = 15.0;  // until the servo is calibrated and helps; for the progress bar alone

bool decidesOnPlace(const std::string& key)
{
  if (key.rfind("hardware.camera.", 0) == 0) return true;
  return key.find('.') == std::string::npos &&
         std::find(std::begin(kElsewhere), std::end(kElsewhere), key) == std::end(kElsewhere);
}

std::string placeOf(trials::TrialSetting setting, std::uint64_t seed)
{
  std::string place = fmt::format("{} {}", setting.scenario.name, seed);
  for (const configuration::Field& field : configuration::fieldsOf(setting))
    if (decidesOnPlace(field.key)) place += fmt::format(" {}={}", field.key, configuration::textOf(field));
  return place;
}

PlannedTrial planned(const Variant& variant, std::uint64_t seed)
{
  const trials::Scenario& scenario = variant.setting.scenario;
  const std::string folder = scenario.name + (variant.name.empty() ? "" : "/" + variant.name);
  const double before = scenario.isManual() ? 0.0 : kReady_s;
  return {&variant, seed, fmt::format("{}/seed_{:04}", folder, seed), placeOf(variant.setting, seed),
          before + scenario.duration_s};
}

}  // namespace

TrialList::TrialList(const TrialArguments& arguments)
{
  const std::vector<configuration::Assignment> settings = settingsOf(arguments);
  scenarios_.reserve(arguments.scenarios.size());
  for (const std::string& path : arguments.scenarios) scenarios_.push_back(trials::readScenario(path, settings));
  std::vector<PlannedTrial> all;
  for (const std::vector<Variant>& variants : scenarios_)
    for (const std::uint64_t seed : seedsOf(arguments))
      for (const Variant& variant : variants) all.push_back(planned(variant, seed));
  const Shard shard = shardOf(arguments);
  const auto begin = static_cast<std::ptrdiff_t>((shard.number - 1) * all.size() / shard.count);
  const auto end = static_cast<std::ptrdiff_t>(shard.number * all.size() / shard.count);
  trials_.assign(all.begin() + begin, all.begin() + end);
}

std::string nameOf(const PlannedTrial& trial)
{
  return fmt::format("{}{}, seed {}", trial.variant->setting.scenario.name,
                     trial.variant->name.empty() ? "" : ", " + trial.variant->name, trial.seed);
}

}  // namespace eyeslam::apps
