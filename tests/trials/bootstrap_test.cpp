// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/bootstrap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "eyeslam/simulation/random.h"

namespace eyeslam::trials {
namespace {

TEST(MeanOverSeeds, AgreesWithAHandCalculation)
{
  // 2, 4, 9: mean 5, squares 9 + 1 + 16 = 26, over n - 1.
  const OverSeeds over = meanOverSeeds({2.0, 4.0, 9.0});
  EXPECT_DOUBLE_EQ(over.mean, 5.0);
  EXPECT_DOUBLE_EQ(over.spread, std::sqrt(13.0));
  EXPECT_DOUBLE_EQ(meanOverSeeds({7.0}).spread, 0.0);
  EXPECT_DOUBLE_EQ(meanOverSeeds({}).mean, 0.0);
}

TEST(ComparePairs, AgreesWithAHandCalculationOfTwoSeeds)
{
  // Resamples of two seeds: both the first (1/4), both the second (1/4), one of each (1/2). The reductions are
  // 90 %, 60 % and 100 (1 - 50 / 200) = 75 %: all of the central 95 % reaches from 60 to 90.
  const PairedComparison result = comparePairs({100.0, 100.0}, {10.0, 40.0});
  EXPECT_EQ(result.pairs, 2U);
  EXPECT_DOUBLE_EQ(result.unaided.mean, 100.0);
  EXPECT_DOUBLE_EQ(result.aided.mean, 25.0);
  EXPECT_DOUBLE_EQ(result.reduction_percent.value, 75.0);
  EXPECT_DOUBLE_EQ(result.reduction_percent.low, 60.0);
  EXPECT_DOUBLE_EQ(result.reduction_percent.high, 90.0);
}

TEST(ComparePairs, FindsTheSeedsInWhichTheAidIsWorse)
{
  const PairedComparison result = comparePairs({10.0, 10.0, 10.0}, {9.0, 10.0, 10.5});
  EXPECT_EQ(result.worse, (std::vector<bool>{false, false, true}));
}

TEST(ComparePairs, PairsCancelWhatSeedsHaveInCommon)
{
  // Seeds differ tenfold, the aid halves each of them: nothing is uncertain about that.
  const PairedComparison result = comparePairs({10.0, 20.0, 50.0, 100.0}, {5.0, 10.0, 25.0, 50.0});
  EXPECT_NEAR(result.reduction_percent.low, 50.0, 1e-9);
  EXPECT_NEAR(result.reduction_percent.high, 50.0, 1e-9);
}

TEST(ComparePairs, OfNoPairsIsNothing)
{
  EXPECT_EQ(comparePairs({}, {}).pairs, 0U);
  EXPECT_DOUBLE_EQ(comparePairs({0.0}, {0.0}).reduction_percent.value, 0.0);
  EXPECT_THROW(comparePairs({1.0}, {}), std::invalid_argument);
}

TEST(Bootstrap, IsTheSameEachTime)
{
  const std::vector<double> without{120, 90, 110, 140, 99}, with{12, 14, 9, 11, 30};
  const Estimate first = comparePairs(without, with).reduction_percent;
  const Estimate second = comparePairs(without, with).reduction_percent;
  EXPECT_EQ(first.low, second.low);
  EXPECT_EQ(first.high, second.high);
}

TEST(Bootstrap, HoldsTheTruthInAbout95Of100Studies)
{
  // Twenty seeds of log-normal errors; the aid takes 80 % off on average. The percentile bootstrap of twenty is known
  // to be a little narrow (Efron and Tibshirani 1993, chapter 14): 92 to 94 %. 200 studies give 93 +- 1.8 %.
  constexpr int kStudies = 200, kSeeds = 20;
  simulation::Random random(7);
  int held = 0;
  for (int study = 0; study < kStudies; ++study) {
    std::vector<double> without, with;
    for (int seed = 0; seed < kSeeds; ++seed) {
      without.push_back(100.0 * std::exp(0.3 * random.normal()));
      // The mean of exp(s n) is exp(s^2 / 2).
      with.push_back(0.2 * without.back() * std::exp(0.4 * random.normal() - 0.08));
    }
    const Estimate reduction = comparePairs(without, with).reduction_percent;
    held += reduction.low <= 80.0 && 80.0 <= reduction.high ? 1 : 0;
  }
  EXPECT_GE(held, kStudies * 87 / 100);
  EXPECT_LE(held, kStudies * 98 / 100);
}

}  // namespace
}  // namespace eyeslam::trials
