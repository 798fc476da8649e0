// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/burn_ledger.h"

#include <gtest/gtest.h>

#include <memory>

#include "support/burn_scene.h"

using namespace eyeslam;
using namespace eyeslam::servo;
using retina::Reason;
using support::kMap;

TEST(BurnLedger, RemembersPlacesOfTheirOwnMapOnly)
{
  const auto ledger = std::make_unique<BurnLedger>();
  ledger->remember(kMap, {100.0, 50.0});
  EXPECT_TRUE(ledger->isBurnt(kMap, {103.0, 54.0}, 5.1));
  EXPECT_FALSE(ledger->isBurnt(kMap, {103.0, 54.0}, 5.0));
  EXPECT_FALSE(ledger->isBurnt(kMap + 1, {100.0, 50.0}, 5.0));
}

TEST(BurnLedger, IsFullRatherThanForgetful)
{
  const auto ledger = std::make_unique<BurnLedger>();
  for (std::size_t i = 0; i < BurnLedger::kMostPlaces; ++i) {
    EXPECT_FALSE(ledger->isFull());
    ledger->remember(kMap, {static_cast<double>(i), 0.0});
  }
  EXPECT_TRUE(ledger->isFull());
  ledger->remember(kMap, {-1.0, 0.0});
  EXPECT_TRUE(ledger->isBurnt(kMap, {0.0, 0.0}, 0.1));
}

TEST(BurnLedger, DescribesOnlyThePlanThatItKeeps)
{
  const auto ledger = std::make_unique<BurnLedger>();
  const auto prepared = support::preparedFor(support::linePlan(2));
  burn_plan_t message{};
  EXPECT_FALSE(ledger->describe(*prepared, message));
  ledger->open(prepared->proposed);
  const std::int64_t before = ledger->changes();
  ledger->record(1, Fate::missed, Reason::pulse_cut, 0.004);
  EXPECT_GT(ledger->changes(), before);
  ASSERT_TRUE(ledger->describe(*prepared, message));
  EXPECT_EQ(message.state, burn_plan_t::IN_FORCE);
  EXPECT_EQ(planHash(message), prepared->proposed.hash);
  EXPECT_EQ(message.target[0].state, burn_target_t::PENDING);
  EXPECT_EQ(message.target[1].state, burn_target_t::MISSED);
  EXPECT_EQ(message.target[1].reason, static_cast<int>(Reason::pulse_cut));
  burn_plan_t read{};
  EXPECT_EQ(messaging::read(message, read), Reason::none);
  EXPECT_FALSE(ledger->describe(*support::preparedFor(support::linePlan(3)), message));
}

TEST(BurnLedger, TheLargestPlanFits)
{
  const auto ledger = std::make_unique<BurnLedger>();
  const auto prepared = support::preparedFor(support::linePlan(messaging::kMostTargets));
  ledger->open(prepared->proposed);
  EXPECT_EQ(ledger->size(), static_cast<std::size_t>(messaging::kMostTargets));
  ledger->record(ledger->size() - 1, Fate::done, Reason::none, 0.02);
  ledger->record(ledger->size(), Fate::done, Reason::none, 0.02);  // beyond its end
  EXPECT_EQ(ledger->count(Fate::done), 1U);
}
