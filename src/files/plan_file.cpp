// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/plan_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "eyeslam/configuration/field.h"
#include "eyeslam/configuration/json.h"
#include "eyeslam/files/file_error.h"
#include "eyeslam/files/json_fields.h"
#include "eyeslam/files/partial_file.h"
#include "eyeslam/files/whole_file.h"

namespace eyeslam::files {
namespace {

using fixtures::BurnPlan;
using fixtures::BurnPrescription;
using fixtures::BurnTarget;
using retina::Reason;

constexpr int kPlanVersion = 1;
constexpr double kMost_um = 1e6;
constexpr double kMost_um_per_px = 50.0;
constexpr int kMostTargets = 1000000;
constexpr double kRounding_um = 1e-6;

nlohmann::ordered_json jsonOf(const BurnTarget& target)
{
  nlohmann::ordered_json json;
  json["id"] = target.id;
  json["x_px"] = target.position_px.x();
  json["y_px"] = target.position_px.y();
  json["spot_um"] = target.spot_um;
  json["burn_um"] = target.burn_um;
  json["duration_ms"] = target.duration_ms;
  json["power_mw"] = target.power_mw;
  json["tile"] = target.tile;
  json["valid"] = target.valid();
  json["reason"] = retina::word(target.reason);
  json["clearance_um"] = target.clearance_um;
  return json;
}

BurnPrescription prescriptionFrom(const JsonFields& json)
{
  BurnPrescription prescription;
  std::vector<configuration::Field> fields = configuration::fieldsOf(prescription);
  std::vector<std::string> keys;
  for (configuration::Field& field : fields) {
    const nlohmann::json& value = json.at(field.key);
    if (!value.is_string() && !value.is_number() && !value.is_boolean()) json.fail(field.key, "is no value");
    const std::string wrong = assignText(field, value.is_string() ? value.get<std::string>() : value.dump());
    if (!wrong.empty()) json.fail(field.key, wrong);
    keys.push_back(field.key);
  }
  json.allowOnly(keys);
  return prescription;
}

Reason reasonFrom(const JsonFields& json)
{
  const std::string word = json.text("reason");
  if (word.empty()) return Reason::none;
  for (int number = static_cast<int>(Reason::near_vessel); number <= static_cast<int>(Reason::crowded); ++number) {
    if (retina::word(static_cast<Reason>(number)) == word) return static_cast<Reason>(number);
  }
  json.fail("reason", fmt::format("'{}' is no reason against a burn", word));
}

BurnTarget targetFrom(const JsonFields& json, double least_clearance_um)
{
  json.allowOnly({"id", "x_px", "y_px", "spot_um", "burn_um", "duration_ms", "power_mw", "tile", "valid", "reason",
                  "clearance_um"});
  BurnTarget target;
  target.id = json.whole("id", 0, kMostTargets);
  target.position_px = {json.number("x_px", -kFarthest_px, kFarthest_px),
                        json.number("y_px", -kFarthest_px, kFarthest_px)};
  target.spot_um = json.number("spot_um", 1.0, kMost_um);
  target.burn_um = json.number("burn_um", target.spot_um, kMost_um);
  target.duration_ms = json.number("duration_ms", 0.0, 1e6);
  target.power_mw = json.number("power_mw", 0.0, 1e6);
  target.tile = json.whole("tile", 0, kMostTargets);
  target.reason = reasonFrom(json);
  target.clearance_um = json.number("clearance_um", -kMost_um, 1e9);
  if (json.truth("valid") != target.valid()) json.fail("valid", "contradicts the reason");
  if (target.valid() && target.clearance_um < least_clearance_um - kRounding_um) {
    json.fail("clearance_um", fmt::format("is below the margin, {}, although the target is valid", least_clearance_um));
  }
  return target;
}

std::vector<BurnTarget> targetsFrom(const JsonFields& json, double least_clearance_um)
{
  std::vector<BurnTarget> targets;
  std::set<int> ids;
  for (const JsonFields& fields : json.list("targets")) {
    targets.push_back(targetFrom(fields, least_clearance_um));
    if (!ids.insert(targets.back().id).second) fields.fail("id", "stands twice");
    if (targets.size() > 1 && targets.back().valid() && !targets[targets.size() - 2].valid()) {
      fields.fail("valid", "a valid target stands behind a refused one");
    }
  }
  return targets;
}

std::string hashFrom(const JsonFields& json, const std::string& name)
{
  constexpr std::size_t kDigits = 64;
  std::string hash = json.text(name);
  if (hash.size() != kDigits || hash.find_first_not_of("0123456789abcdef") != std::string::npos) {
    json.fail(name, "is no SHA-256, 64 hexadecimal digits");
  }
  return hash;
}

fixtures::PlanMap mapFrom(const JsonFields& json)
{
  json.allowOnly({"hash", "origin_x", "origin_y", "px_per_cell", "track"});
  fixtures::PlanMap map;
  map.hash = hashFrom(json, "hash");
  map.origin_x = json.number("origin_x", -kFarthest_px, kFarthest_px);
  map.origin_y = json.number("origin_y", -kFarthest_px, kFarthest_px);
  map.px_per_cell = json.number("px_per_cell", 1e-3, 100.0);
  if (!json.text("track").empty()) map.track = hashFrom(json, "track");
  return map;
}

// Stands twice in the file, so that a reader needs no prescription; a hand that changes one is caught.
double sameNumber(const JsonFields& json, const std::string& name, double in_prescription)
{
  if (json.number(name, 0.0, kMost_um) != in_prescription) json.fail(name, "differs from prescription.safety." + name);
  return in_prescription;
}

}  // namespace

std::string planJson(const BurnPlan& plan)
{
  BurnPrescription prescription = plan.prescription;
  nlohmann::ordered_json json;
  json["version"] = kPlanVersion;
  json["um_per_px"] = plan.um_per_px;
  json["margin_um"] = prescription.safety.margin_um;
  json["localization_um"] = prescription.safety.localization_um;
  json["map"] = {{"hash", plan.map.hash},
                 {"origin_x", plan.map.origin_x},
                 {"origin_y", plan.map.origin_y},
                 {"px_per_cell", plan.map.px_per_cell},
                 {"track", plan.map.track}};
  json["prescription"] = configuration::jsonOf(configuration::fieldsOf(prescription));
  json["targets"] = nlohmann::ordered_json::array();
  for (const BurnTarget& target : plan.targets) json["targets"].push_back(jsonOf(target));
  return json.dump(1) + "\n";
}

BurnPlan planFrom(const std::string& text, const std::string& path)
{
  const JsonFields json = JsonFields::parse(text, path);
  if (!json.has("version") || !json.has("targets")) throw FileError(path + ": is no plan of eyeslam-plan");
  if (json.whole("version", 0, 1000000) != kPlanVersion)
    json.fail("version", fmt::format("{} is wanted", kPlanVersion));
  json.allowOnly({"version", "um_per_px", "margin_um", "localization_um", "map", "prescription", "targets"});
  BurnPlan plan;
  plan.um_per_px = json.number("um_per_px", 1e-3, kMost_um_per_px);
  plan.map = mapFrom(json.object("map"));
  plan.prescription = prescriptionFrom(json.object("prescription"));
  try {
    fixtures::check(plan.prescription);
  } catch (const fixtures::PlanError& error) {
    json.fail("prescription", error.what());
  }
  const auto& safety = plan.prescription.safety;
  plan.targets = targetsFrom(json, sameNumber(json, "margin_um", safety.margin_um) +
                                       sameNumber(json, "localization_um", safety.localization_um));
  return plan;
}

BurnPlan readPlan(const std::string& path) { return planFrom(readWholeText(path), path); }

void writePlan(const BurnPlan& plan, const std::string& path)
{
  PartialFile file(path);
  writeWholeFile(file.partialPath(), planJson(plan));
  file.publish();
}

void checkSameTrack(const BurnPlan& plan, const std::string& plan_path, const RecordedMap& map)
{
  if (plan.map.track.empty() || map.track.empty() || plan.map.track == map.track) return;
  throw FileError(fmt::format("{}: map.track: the plan was made on another video than {}", plan_path, map.path));
}

}  // namespace eyeslam::files
