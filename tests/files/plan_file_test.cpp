// SPDX-License-Identifier: GPL-3.0-or-later
// plan.json: what is written is read back to the last bit; whatever is wrong in it is refused by its field.
#include "eyeslam/files/plan_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "eyeslam/files/file_error.h"
#include "eyeslam/fixtures/burn_planner.h"
#include "support/planning_maps.h"
#include "support/temporary_folder.h"

namespace eyeslam::files {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

fixtures::BurnPlan smallPlan()
{
  retina::VesselMap map = support::emptyMap(300, 200);
  support::drawVessel(map, {100.0, 0.0}, {180.0, 200.0}, 3.0);
  fixtures::BurnPrescription prescription;
  prescription.pattern.spacing_um = 612.3456789;
  prescription.keep_out.polygons_px = "100,100 140,100 140,150; 10 10 20 10 20 20";
  fixtures::BurnPlan plan = fixtures::planBurns(map, prescription);
  plan.map.track = std::string(64, 'a');
  return plan;
}

void expectRefused(const std::string& text, const std::string& field)
{
  try {
    planFrom(text, "p.json");
    ADD_FAILURE() << field;
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), ::testing::StartsWith("p.json: "));
    EXPECT_THAT(error.what(), HasSubstr(field));
  }
}

TEST(PlanFile, ReadsBackWhatItWroteToTheLastBit)
{
  const fixtures::BurnPlan plan = smallPlan();
  const fixtures::BurnPlan again = planFrom(planJson(plan), "p.json");
  EXPECT_EQ(planJson(again), planJson(plan));
  ASSERT_EQ(again.targets.size(), plan.targets.size());
  for (std::size_t i = 0; i < plan.targets.size(); ++i) {
    EXPECT_EQ(again.targets[i].position_px, plan.targets[i].position_px);
    EXPECT_EQ(again.targets[i].reason, plan.targets[i].reason);
  }
  EXPECT_EQ(again.prescription.keep_out.polygons_px, plan.prescription.keep_out.polygons_px);
}

TEST(PlanFile, IsWrittenWhole)
{
  const support::TemporaryFolder folder;
  writePlan(smallPlan(), folder.path("plan.json"));
  EXPECT_EQ(planJson(readPlan(folder.path("plan.json"))), planJson(smallPlan()));
  EXPECT_THROW(writePlan(smallPlan(), folder.path("no/plan.json")), FileError);
  EXPECT_THROW(readPlan(folder.path("none.json")), FileError);
}

TEST(PlanFile, RefusesEveryBeginningOfItself)
{
  const std::string text = planJson(smallPlan());
  for (std::size_t size = 0; size + 2 < text.size(); size += 97) {
    EXPECT_THROW(planFrom(text.substr(0, size), "p.json"), FileError) << size;
  }
}

TEST(PlanFile, RefusesForeignFiles)
{
  expectRefused("[1, 2]", "no JSON object");
  expectRefused("{}", "no plan of eyeslam-plan");
  expectRefused(R"({"origin_x": 1.0, "px_per_cell": 2.0})", "no plan of eyeslam-plan");
}

TEST(PlanFile, NamesEachFieldThatIsWrong)
{
  const Json good = Json::parse(planJson(smallPlan()));
  const auto with = [&good](const std::string& pointer, const Json& value) {
    Json json = good;
    json[Json::json_pointer(pointer)] = value;
    return json.dump();
  };
  expectRefused(with("/version", 2), "version");
  expectRefused(with("/um_per_px", -5.0), "um_per_px");
  expectRefused(with("/um_per_px", nullptr), "um_per_px");
  expectRefused(with("/um_per_px", 5000.0), "um_per_px");
  expectRefused(with("/margin_um", 50.0), "margin_um");
  expectRefused(with("/localization_um", "ten"), "localization_um");
  expectRefused(with("/map/hash", "abc"), "map.hash");
  expectRefused(with("/map/px_per_cell", 0.0), "map.px_per_cell");
  expectRefused(with("/map/origin_x", false), "map.origin_x");
  expectRefused(with("/targets/0/x_px", nullptr), "targets[0].x_px");
  expectRefused(with("/targets/3/y_px", "1"), "targets[3].y_px");
  expectRefused(with("/targets/1/id", 1.5), "targets[1].id");
  expectRefused(with("/targets/1/id", -1), "targets[1].id");
  expectRefused(with("/targets/1/id", good["targets"][0]["id"]), "targets[1].id: stands twice");
  expectRefused(with("/targets/0/spot_um", -100.0), "targets[0].spot_um");
  expectRefused(with("/targets/0/burn_um", 50.0), "targets[0].burn_um");
  expectRefused(with("/targets/0/duration_ms", -1.0), "targets[0].duration_ms");
  expectRefused(with("/targets/0/power_mw", {1}), "targets[0].power_mw");
  expectRefused(with("/targets/0/tile", -1), "targets[0].tile");
  expectRefused(with("/targets/0/valid", false), "targets[0].valid");
  expectRefused(with("/targets/0/reason", "because"), "targets[0].reason");
  expectRefused(with("/targets/0/clearance_um", 100.0), "targets[0].clearance_um");
  expectRefused(with("/targets/0/colour", 1), "targets[0].colour: is unknown");
  expectRefused(with("/prescription/pattern.spacing_um", -1.0), "pattern.spacing_um");
  expectRefused(with("/prescription/pattern.kind", "star"), "pattern.kind");
  expectRefused(with("/prescription/safety.seen_frames", 1.5), "safety.seen_frames");
}

TEST(PlanFile, NamesEachFieldThatIsMissing)
{
  const Json good = Json::parse(planJson(smallPlan()));
  for (const auto& field : good.items()) {
    Json json = good;
    json.erase(field.key());
    EXPECT_THROW(planFrom(json.dump(), "p.json"), FileError) << field.key();
  }
  for (const auto& field : good["targets"][0].items()) {
    Json json = good;
    json["targets"][0].erase(field.key());
    expectRefused(json.dump(), "targets[0]." + field.key());
  }
}

TEST(PlanFile, RefusesNumbersThatAreNone)
{
  std::string text = planJson(smallPlan());
  const std::size_t at = text.find("\"x_px\": ") + 8;
  for (const char* const number : {"NaN", "Infinity", "1e999", "-1e999", "1e7", "null", "\"1\""}) {
    std::string wrong = text;
    wrong.replace(at, text.find(',', at) - at, number);
    EXPECT_THROW(planFrom(wrong, "p.json"), FileError) << number;
  }
}

TEST(PlanFile, RefusesAValidTargetBehindARefusedOne)
{
  Json json = Json::parse(planJson(smallPlan()));
  ASSERT_FALSE(json["targets"].back()["valid"].get<bool>());
  std::rotate(json["targets"].begin(), json["targets"].begin() + 1, json["targets"].end());
  expectRefused(json.dump(), "behind a refused one");
}

TEST(PlanFile, SaysThatAMapIsOfAnotherVideo)
{
  const fixtures::BurnPlan plan = smallPlan();
  RecordedMap map;
  map.path = "other/map/map_000001.png";
  EXPECT_NO_THROW(checkSameTrack(plan, "p.json", map)) << "unknown";
  map.track = plan.map.track;
  EXPECT_NO_THROW(checkSameTrack(plan, "p.json", map));
  map.track = std::string(64, 'b');
  EXPECT_THROW(checkSameTrack(plan, "p.json", map), FileError);
}

}  // namespace
}  // namespace eyeslam::files
