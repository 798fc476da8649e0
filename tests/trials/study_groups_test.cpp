// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/study_groups.h"

#include <gtest/gtest.h>

#include "eyeslam/trials/report_warnings.h"

namespace eyeslam::trials {
namespace {

TrialRecord trial(const std::string& variant, const std::string& aid, std::uint64_t seed, double rms_um, double p95_um)
{
  TrialRecord record;
  record.task = "trace";
  record.variant = variant;
  record.score.scenario = "vessel_tracing";
  record.score.aid = aid;
  record.score.seed = seed;
  record.score.rms_um = rms_um;
  record.score.p95_um = p95_um;
  return record;
}

bool anyHas(const std::vector<std::string>& texts, const std::string& part)
{
  for (const std::string& text : texts)
    if (text.find(part) != std::string::npos) return true;
  return false;
}

TEST(StudyGroups, CompareWhatDiffersInAidAndSeedAlone)
{
  const std::vector<TrialRecord> records{
      trial("aid=hard,motion=jerky", "hard", 0, 20, 40),     trial("aid=none,motion=jerky", "none", 0, 200, 400),
      trial("aid=hard,motion=in_situ", "hard", 0, 10, 20),   trial("aid=none,motion=in_situ", "none", 0, 100, 200),
      trial("aid=none,motion=in_situ", "none", 1, 140, 200), trial("aid=hard,motion=in_situ", "hard", 1, 14, 20)};
  const std::vector<StudyGroup> groups = groupsOf(records);
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].variant, "motion=jerky");
  EXPECT_EQ(groups[1].variant, "motion=in_situ");
  EXPECT_EQ(groups[1].aids.front().aid, "none");
  const std::vector<AidComparison> comparisons = comparisonsOf(groups[1]);
  ASSERT_EQ(comparisons.size(), 2U);
  EXPECT_EQ(comparisons[0].seeds, (std::vector<std::uint64_t>{0, 1}));
  EXPECT_DOUBLE_EQ(comparisons[0].figures.reduction_percent.value, 90.0);
}

TEST(StudyGroups, CountASeedAsMadeWorseByEitherMeasure)
{
  const std::vector<TrialRecord> records{
      trial("aid=none", "none", 0, 50, 90), trial("aid=hard", "hard", 0, 60, 80),   // RMS
      trial("aid=none", "none", 1, 50, 90), trial("aid=hard", "hard", 1, 40, 95),   // p95
      trial("aid=none", "none", 2, 50, 90), trial("aid=hard", "hard", 2, 40, 80)};  // neither
  const std::vector<StudyGroup> groups = groupsOf(records);
  EXPECT_EQ(seedsMadeWorse(comparisonsOf(groups[0]), "hard"), (std::vector<std::uint64_t>{0, 1}));
  EXPECT_TRUE(anyHas(warningsOf(records, groups), "worse with aid hard than without it in seeds 0, 1"));
}

TEST(StudyGroups, ATrialWithoutPartnerIsWarnedOfAndNotCompared)
{
  const std::vector<TrialRecord> records{trial("aid=none", "none", 0, 50, 90), trial("aid=hard", "hard", 0, 5, 9),
                                         trial("aid=hard", "hard", 5, 6, 9)};
  const std::vector<StudyGroup> groups = groupsOf(records);
  EXPECT_EQ(comparisonsOf(groups[0])[0].figures.pairs, 1U);
  EXPECT_TRUE(anyHas(warningsOf(records, groups), "seed 5"));
}

TEST(StudyGroups, ATrialGivenTwiceCountsOnce)
{
  const std::vector<TrialRecord> records{trial("", "hard", 0, 5, 9), trial("", "hard", 0, 7, 9)};
  const std::vector<StudyGroup> groups = groupsOf(records);
  ASSERT_EQ(groups[0].aids[0].trials.size(), 1U);
  EXPECT_EQ(groups[0].aids[0].trials[0], &records[0]);
  EXPECT_TRUE(anyHas(warningsOf(records, groups), "given twice"));
}

TEST(StudyGroups, ShowTheMiddleAndTheWorstSeed)
{
  std::vector<TrialRecord> records;
  for (const double rms : {30.0, 10.0, 20.0, 50.0, 40.0})
    records.push_back(trial("", "hard", static_cast<std::uint64_t>(rms), rms, rms));
  const std::vector<StudyGroup> groups = groupsOf(records);
  const Examples examples = examplesOf(groups[0].aids[0]);
  EXPECT_EQ(examples.median->score.seed, 30U);
  EXPECT_EQ(examples.worst->score.seed, 50U);
}

}  // namespace
}  // namespace eyeslam::trials
