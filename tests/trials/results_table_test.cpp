// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/results_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/whole_file.h"
#include "support/temporary_folder.h"

namespace eyeslam::trials {
namespace {

// Contracts, section 7, letter by letter: what other people's scripts rely on.
constexpr const char* kContract =
    "scenario,seed,aid,motion,condition,retina,camera_hz,latency_ms,"
    "mean_um,rms_um,median_um,p95_um,max_um,path_coverage,duration_s,tip_travel_mm,saturated_fraction,pose_rms_px,"
    "pose_rms_deg,"
    "tracked_fraction,targets,fired,refused,missed,placement_mean_um,placement_p95_um,placement_max_um,far_pulses,"
    "far_unexplained,burns_per_s,"
    "min_vessel_clearance_um,interlock_violations,hold_events,fault_events,wall_s,version,config_hash";

TrialScore tracing(std::uint64_t seed)
{
  TrialScore score;
  score.scenario = "vessel_tracing";
  score.seed = seed;
  score.aid = "hard";
  score.camera_hz = 30.0;
  score.rms_um = 12.25;
  score.hold_events = 2;
  score.version = "0.1.0";
  return score;
}

TrialScore hostile()
{
  TrialScore score = tracing(std::numeric_limits<std::uint64_t>::max());
  score.retina = "my \"best\", eye\r\nof 2 <b>.jpg";
  score.rms_um.reset();
  score.min_vessel_clearance_um = -3.5;
  score.targets = std::int64_t{32};
  return score;
}

TEST(ResultsTable, HasTheColumnsOfTheContract)
{
  std::string names;
  for (const std::string& name : columns()) names += (names.empty() ? "" : ",") + name;
  EXPECT_EQ(names, kContract);
  EXPECT_EQ(resultsTable({}), std::string(kContract) + "\n");
}

TEST(ResultsTable, LeavesEmptyWhatDoesNotApply)
{
  const std::vector<std::string> row = rowOf(tracing(3));
  ASSERT_EQ(row.size(), columns().size());
  const auto cell = [&row](const std::string& name) {
    return row[static_cast<std::size_t>(std::find(columns().begin(), columns().end(), name) - columns().begin())];
  };
  EXPECT_EQ(cell("rms_um"), "12.25");
  EXPECT_EQ(cell("seed"), "3");
  EXPECT_EQ(cell("hold_events"), "2");
  EXPECT_EQ(cell("targets"), "");
  EXPECT_EQ(cell("p95_um"), "");
}

TEST(ResultsTable, ReadsBackWhatItWrote)
{
  const support::TemporaryFolder folder;
  const std::vector<TrialScore> scores{tracing(0), hostile()};
  writeResultsTable(folder.path("results.csv"), scores);
  const std::vector<TrialScore> read = readResultsTable(folder.path("results.csv"));
  ASSERT_EQ(read.size(), scores.size());
  for (std::size_t i = 0; i < scores.size(); ++i) EXPECT_EQ(rowOf(read[i]), rowOf(scores[i]));
  EXPECT_FALSE(read[1].rms_um);
  EXPECT_EQ(read[1].seed, hostile().seed);
  EXPECT_EQ(read[1].retina, hostile().retina);
}

TEST(ResultsTable, TakesConcatenatedShards)
{
  const std::vector<TrialScore> merged =
      parseResultsTable(resultsTable({tracing(0), hostile()}) + resultsTable({}) + resultsTable({tracing(7)}));
  ASSERT_EQ(merged.size(), 3U);
  EXPECT_EQ(merged[2].seed, 7U);
}

TEST(ResultsTable, NamesLineAndColumnOfWhatItCannotRead)
{
  const auto faultOf = [](const std::string& text) {
    try {
      parseResultsTable(text);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  std::string text = resultsTable({tracing(0), hostile(), tracing(2)});
  EXPECT_EQ(faultOf(text), "");
  std::string spoilt = text;
  spoilt.replace(spoilt.rfind("12.25"), 5, "twelve");
  EXPECT_EQ(faultOf(spoilt), "line 5: column rms_um: \"twelve\" is not a number");
  EXPECT_NE(faultOf(text.substr(text.find('\n') + 1)).find("line 1: "), std::string::npos);
  EXPECT_NE(faultOf(text + "a,b\n").find("line 6: 2 columns instead of 37"), std::string::npos);
  EXPECT_NE(faultOf(text + "\"open").find("a quote is not closed"), std::string::npos);
  EXPECT_NE(faultOf("").find("no line of names"), std::string::npos);
}

TEST(ResultsTable, NamesTheFileThatIsNone)
{
  const support::TemporaryFolder folder;
  files::writeWholeFile(folder.path("other.csv"), std::string("frame,utime\n0,1\n"));
  try {
    readResultsTable(folder.path("other.csv"));
    FAIL() << "was read";
  } catch (const files::FileError& error) {
    EXPECT_NE(std::string(error.what()).find("other.csv: line 1"), std::string::npos) << error.what();
  }
}

TEST(ResultsJson, HasEveryColumnAndWhatNoColumnHas)
{
  TrialScore score = hostile();
  score.more = {{"calm_rms_um", 9.5}, {"never", std::numeric_limits<double>::quiet_NaN()}};
  score.retina += "\xff";  // no UTF-8
  const nlohmann::json json = nlohmann::json::parse(jsonOf(score));
  for (const std::string& name : columns()) EXPECT_TRUE(json.contains(name)) << name;
  EXPECT_TRUE(json["rms_um"].is_null());
  EXPECT_EQ(json["targets"], 32);
  EXPECT_EQ(json["seed"].get<std::uint64_t>(), score.seed);
  EXPECT_EQ(json["more"]["calm_rms_um"], 9.5);
  EXPECT_TRUE(json["more"]["never"].is_null());
}

}  // namespace
}  // namespace eyeslam::trials
