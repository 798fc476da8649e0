// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/trial_report.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <memory>

#include "support/sanitized.h"
#include "support/synthetic_trials.h"
#include "support/xml_check.h"

namespace eyeslam::trials {
namespace {

using support::XmlCheck;

/// What every page must be, whatever is in it.
void expectSelfContained(const std::string& page)
{
  EXPECT_EQ(XmlCheck::faultOf(page), "");
  for (const char* outside : {"<script", "<link", "<iframe", "url(", "@import"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  for (std::size_t at = page.find("href=\""); at != std::string::npos; at = page.find("href=\"", at + 1)) {
    const std::string address = page.substr(at + 6, 16);
    EXPECT_TRUE(address.rfind("data:image/", 0) == 0 || address[0] == '#') << address;
  }
  EXPECT_EQ(page.find(" src="), std::string::npos);
}

bool has(const std::string& page, const std::string& part) { return page.find(part) != std::string::npos; }

class TrialReports : public testing::Test {
 protected:
  static void SetUpTestSuite() { generator = std::make_unique<support::SyntheticTrials>(3.0); }
  static void TearDownTestSuite() { generator.reset(); }

  support::SyntheticTrials& make = *generator;

 private:
  static std::unique_ptr<support::SyntheticTrials> generator;  // one for all: its retinas cost a second each
};
std::unique_ptr<support::SyntheticTrials> TrialReports::generator;

TEST_F(TrialReports, NeedNothingFromOutside)
{
  expectSelfContained(trialReport(make.traced("hard", 0)));
  expectSelfContained(trialReport(make.burnt("automated", 0)));
  expectSelfContained(studyReport(
      {make.traced("none", 0), make.traced("hard", 0), make.burnt("manual", 1), make.burnt("automated", 1)}));
}

TEST_F(TrialReports, AreTheSameEachTime)
{
  const std::vector<TrialRecord> records{make.traced("none", 0), make.traced("hard", 0)};
  EXPECT_EQ(studyReport(records), studyReport(records));
}

TEST_F(TrialReports, WarnBeforeTheySayAnythingElse)
{
  TrialRecord record = make.burnt("automated", 0);
  EXPECT_FALSE(has(trialReport(record), "class=\"warnings\""));
  record.passed = false;
  record.verdict = "blackout: must hold; it did not";
  record.score.interlock_violations = 2;
  record.score.far_unexplained = 1;
  record.score.fault_events = 1;
  record.events.push_back({1.5, "fault", "tip_not_finite", true});
  record.pulses.front().touched_calibre = 60e-6;
  const std::string page = trialReport(record);
  const std::size_t warned = page.find("<div class=\"warnings\">");
  ASSERT_NE(warned, std::string::npos);
  for (const char* later : {"class=\"headlines\"", "<figure>", "<table>", "class=\"note\"", "<h2>"})
    EXPECT_LT(warned, page.find(later)) << later;
  const std::string warnings = page.substr(warned, page.find("</div>", warned) - warned);
  for (const char* what : {"failed: blackout", "2 pulses while an interlock was open", "1 pulse more than 60 um off",
                           "went into fault 1 time", "tip_not_finite", "1 burn on a true vessel of 50 um or more"})
    EXPECT_TRUE(has(warnings, what)) << what;
  EXPECT_LT(studyReport({record}).find("failed: blackout"), studyReport({record}).find("<figure>"));
}

TEST_F(TrialReports, WarnWhereTheTrackerHadNoTime)
{
  TrialRecord record = make.traced("hard", 0);
  record.left_out = 0.05;
  EXPECT_FALSE(has(trialReport(record), "class=\"warnings\""));
  record.left_out = 0.41;
  EXPECT_TRUE(has(trialReport(record), "no time for 41 % of the frames"));
}

TEST_F(TrialReports, DoNotWarnOfAHoldThatHadToBe)
{
  TrialRecord record = make.traced("hard", 0);
  record.score.hold_events = 1;
  record.passed = true;
  EXPECT_FALSE(has(trialReport(record), "class=\"warnings\""));
}

TEST_F(TrialReports, DoNotWarnOfWhereABareHandBurns)
{
  TrialRecord record = make.burnt("manual", 0);
  record.score.far_unexplained = 7;
  record.pulses.front().touched_calibre = 60e-6;
  EXPECT_FALSE(has(trialReport(record), "class=\"warnings\""));
  record.score.interlock_violations = 1;
  EXPECT_TRUE(has(trialReport(record), "1 pulse while an interlock was open"));
}

TEST_F(TrialReports, NameWhatIsMissing)
{
  TrialRecord record;
  record.task = "trace";
  record.score.scenario = "vessel_tracing";
  record.score.aid = "hard";
  const std::string page = trialReport(record);
  expectSelfContained(page);
  for (const char* what : {"missing: the way of the tip", "missing: the picture of the retina", "missing: poses"})
    EXPECT_TRUE(has(page, what)) << what;
  record.task = "laser";
  expectSelfContained(trialReport(record));
  EXPECT_TRUE(has(trialReport(record), "missing: a plan in force"));
  expectSelfContained(studyReport({record}));
  expectSelfContained(studyReport({}));
}

TEST_F(TrialReports, TakeHostileTextAsText)
{
  const std::string hostile = "<script>alert('1')</script>&\"]]>\xff</pre></svg>";
  TrialRecord record = make.burnt("automated", 0);
  record.score.scenario = record.score.aid = record.score.retina = record.variant = record.verdict = hostile;
  record.score.version = record.score.config_hash = record.configuration = hostile;
  record.events.push_back({0.5, hostile, hostile, true});
  record.targets.front().reason = hostile;
  record.score.more.emplace_back(hostile, 1.0);
  record.passed = false;
  expectSelfContained(trialReport(record));
  expectSelfContained(studyReport({record, record}));
}

TEST_F(TrialReports, SayThatTheManualOperatorIsFittedToNothing)
{
  const char* said = "a model fitted to nothing";
  EXPECT_TRUE(has(trialReport(make.burnt("manual", 0)), said));
  const std::string study = studyReport({make.burnt("manual", 0), make.burnt("automated", 0)});
  EXPECT_LT(study.find(said), study.find("<table>"));
  EXPECT_TRUE(has(study, "fires when the error it saw was below 100")) << "the model's figures, from the configuration";
  EXPECT_FALSE(has(trialReport(make.burnt("automated", 0)), said));
}

TEST_F(TrialReports, SayWhatErrorsAreAgainstAndWhatTheSoftwareIs)
{
  for (const std::string& page : {trialReport(make.traced("hard", 0)), studyReport({make.traced("hard", 0)})}) {
    EXPECT_TRUE(has(page, "against the simulation&#39;s truth"));
    EXPECT_TRUE(has(page, "research software"));
  }
}

TEST_F(TrialReports, ShowBurnsWhereTheyTrulyWentAndWhyTargetsWereRefused)
{
  const TrialRecord record = make.burnt("automated", 0);
  const std::string page = trialReport(record);
  std::size_t burns = 0;
  for (std::size_t at = page.find("<title>burn of target"); at != std::string::npos;
       at = page.find("<title>burn of target", at + 1))
    ++burns;
  EXPECT_EQ(burns, record.pulses.size());
  EXPECT_TRUE(has(page, "near_vessel ("));
}

TEST_F(TrialReports, TellBurnsOnVesselsByCalibreBesideWhatTheMapHas)
{
  TrialRecord record = make.burnt("automated", 0);
  for (PulseRecord& pulse : record.pulses) pulse.touched_calibre = 0.0;
  record.pulses.front().touched_calibre = 25e-6;
  record.map.coverage = {std::nullopt, 0.875, 0.991};
  const std::string share = fmt::format("{:.2f}", 100.0 / static_cast<double>(record.pulses.size()));
  const std::string page = studyReport({record, make.burnt("manual", 0)});
  for (const std::string& said : {share, std::string("its map has"), std::string("87.5"), std::string("99.1")})
    EXPECT_TRUE(has(page, said)) << said;
  record.map = {};
  EXPECT_FALSE(has(studyReport({record, make.burnt("manual", 0)}), "its map has"));
}

TEST_F(TrialReports, SayWhetherLatenciesWereMeasured)
{
  TrialRecord record = make.traced("hard", 0);
  record.computation_s.clear();
  EXPECT_FALSE(has(trialReport(record), "in real time"));
  record.computation_s = {20e-6, 30e-6};
  EXPECT_TRUE(has(trialReport(record), "in real time"));
}

TEST_F(TrialReports, StayBelowTenMegabytesForFortyTrials)
{
  support::SyntheticTrials whole(support::kSanitized ? 2.0 : 20.0);
  std::vector<TrialRecord> records;
  for (std::uint64_t seed = 0; seed < (support::kSanitized ? 3U : 20U); ++seed) {
    records.push_back(whole.traced("none", seed));
    records.push_back(whole.traced("hard", seed));
  }
  const std::string page = studyReport(records);
  EXPECT_LT(page.size(), 10'000'000U);
  expectSelfContained(page);
}

}  // namespace
}  // namespace eyeslam::trials
