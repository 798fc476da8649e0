// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/supervisor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "eyeslam/servo/hand_over.h"

using namespace eyeslam;
using eyeslam::retina::Reason;
using eyeslam::servo::HandOver;
using eyeslam::servo::Health;
using eyeslam::servo::Mode;
using eyeslam::servo::State;
using eyeslam::servo::Supervisor;
using eyeslam::servo::Wish;

namespace {

Wish wish(Mode mode, bool rearmed = false) { return {mode, false, rearmed}; }

Supervisor in(State state)
{
  Supervisor supervisor;
  const Health well;
  if (state == State::standby) return supervisor;
  supervisor.update(wish(Mode::ready), well);
  if (state == State::assist) supervisor.update(wish(Mode::assist), well);
  if (state == State::laser) supervisor.update(wish(Mode::laser), well);
  Health ill;
  if (state == State::hold) ill.state_link = Reason::state_stale;
  if (state == State::fault) ill.clock = Reason::clock_stepped;
  if (state == State::hold || state == State::fault) supervisor.update(wish(Mode::ready), ill);
  EXPECT_EQ(supervisor.state(), state);
  return supervisor;
}

constexpr State kStates[] = {State::standby, State::ready, State::assist, State::laser, State::hold, State::fault};
constexpr Mode kModes[] = {Mode::standby, Mode::ready, Mode::assist, Mode::laser};

struct Trouble {
  Reason Health::*what;
  Reason why;
};
const std::vector<Trouble> kWrong{{&Health::cycle, Reason::internal_error},
                                  {&Health::clock, Reason::clock_stepped},
                                  {&Health::controller, Reason::state_not_finite},
                                  {&Health::rival, Reason::wrong_session}};
const std::vector<Trouble> kLinks{{&Health::state_link, Reason::state_stale},
                                  {&Health::operator_link, Reason::operator_stale},
                                  {&Health::messages, Reason::replayed}};
const std::vector<Trouble> kSight{{&Health::registration, Reason::registration_drift},
                                  {&Health::retina, Reason::pose_stale}};

TEST(Supervisor, GoesWhereTheHumanWantsWhileAllIsWell)
{
  for (const Mode mode : kModes) {
    Supervisor supervisor = in(State::ready);
    supervisor.update(wish(mode), {});
    EXPECT_EQ(static_cast<int>(supervisor.state()), static_cast<int>(mode));
    EXPECT_EQ(supervisor.reason(), Reason::none);
  }
}

TEST(Supervisor, WhatIsWrongIsAFaultInTheSameCycleFromAnywhere)
{
  for (const Trouble& trouble : kWrong) {
    for (const State state : kStates) {
      if (state == State::fault) continue;
      for (const Mode mode : kModes) {
        Supervisor supervisor = in(state);
        Health health;
        health.*trouble.what = trouble.why;
        EXPECT_EQ(supervisor.update(wish(mode, true), health), State::fault);
        EXPECT_EQ(supervisor.reason(), trouble.why);
      }
    }
  }
}

TEST(Supervisor, ALostLinkHoldsInTheSameCycle)
{
  for (const Trouble& trouble : kLinks) {
    for (const State state : {State::ready, State::assist, State::laser}) {
      Supervisor supervisor = in(state);
      Health health;
      health.*trouble.what = trouble.why;
      EXPECT_EQ(supervisor.update(wish(Mode::laser), health), State::hold);
      EXPECT_EQ(supervisor.reason(), trouble.why);
    }
  }
}

TEST(Supervisor, WithoutSightItHoldsInsteadOfGuiding)
{
  for (const Trouble& trouble : kSight) {
    Health health;
    health.*trouble.what = trouble.why;
    for (const State state : {State::assist, State::laser}) {
      Supervisor supervisor = in(state);
      EXPECT_EQ(supervisor.update(wish(static_cast<Mode>(state)), health), State::hold);
      EXPECT_EQ(supervisor.reason(), trouble.why);
    }
    Supervisor ready = in(State::ready);
    EXPECT_EQ(ready.update(wish(Mode::assist), health), State::ready) << "tremor cancelling needs no sight";
    EXPECT_EQ(ready.reason(), trouble.why);
  }
}

TEST(Supervisor, WithoutAPlanThereIsNoLaser)
{
  Health health;
  health.plan = Reason::plan_not_in_force;
  Supervisor ready = in(State::ready);
  EXPECT_EQ(ready.update(wish(Mode::laser), health), State::ready);
  EXPECT_EQ(ready.reason(), Reason::plan_not_in_force);
  Supervisor laser = in(State::laser);
  EXPECT_EQ(laser.update(wish(Mode::laser), health), State::hold);
}

TEST(Supervisor, AStopHoldsWhateverIsWanted)
{
  for (const State state : {State::ready, State::assist, State::laser}) {
    for (const Mode mode : kModes) {
      Supervisor supervisor = in(state);
      EXPECT_EQ(supervisor.update({mode, true, true}, {}), State::hold);
      EXPECT_EQ(supervisor.reason(), Reason::stopped);
    }
  }
}

TEST(Supervisor, OnlyAHumanLeavesHoldAndFaultForMotion)
{
  for (const State state : {State::hold, State::fault}) {
    for (const Mode mode : {Mode::ready, Mode::assist, Mode::laser}) {
      Supervisor supervisor = in(state);
      for (int cycle = 0; cycle < 1000; ++cycle) EXPECT_EQ(supervisor.update(wish(mode), {}), state);
      supervisor.update(wish(mode, true), {});
      EXPECT_EQ(supervisor.state(), state == State::hold ? State::ready : State::standby);
    }
  }
}

TEST(Supervisor, ReArmingDoesNothingWhileTheTroubleLasts)
{
  for (const Trouble& trouble : kWrong) {
    Supervisor supervisor = in(State::fault);
    Health health;
    health.*trouble.what = trouble.why;
    EXPECT_EQ(supervisor.update(wish(Mode::ready, true), health), State::fault);
  }
  for (const Trouble& trouble : kLinks) {
    Supervisor supervisor = in(State::hold);
    Health health;
    health.*trouble.what = trouble.why;
    EXPECT_EQ(supervisor.update(wish(Mode::ready, true), health), State::hold);
  }
  Supervisor stopped = in(State::hold);
  EXPECT_EQ(stopped.update({Mode::ready, true, true}, {}), State::hold);
}

TEST(Supervisor, HoldAndFaultKeepTheReasonThatLedThere)
{
  Supervisor supervisor = in(State::hold);
  for (int cycle = 0; cycle < 10; ++cycle) supervisor.update(wish(Mode::assist), {});
  EXPECT_EQ(supervisor.reason(), Reason::state_stale);
}

// The invariants, over random inputs: no motion and no guidance without what each needs.
TEST(Supervisor, NeverMovesOrGuidesWithoutWhatThatNeeds)
{
  std::mt19937 random(1);
  const auto rarely = [&random] { return random() % 40 == 0; };
  Supervisor supervisor;
  Wish now;
  for (int cycle = 0; cycle < 1000000; ++cycle) {
    Health health;
    for (const auto* troubles : {&kWrong, &kLinks, &kSight}) {
      for (const Trouble& trouble : *troubles) {
        if (rarely()) health.*trouble.what = trouble.why;
      }
    }
    if (rarely()) now.mode = kModes[random() % 4];
    now.stop = rarely();
    now.rearmed = rarely();
    const State before = supervisor.state();
    const State after = supervisor.update(now, health);
    const auto anyOf = [&health](const std::vector<Trouble>& troubles) {
      return std::any_of(troubles.begin(), troubles.end(),
                         [&](const Trouble& trouble) { return health.*trouble.what != Reason::none; });
    };
    const bool guides = supervisor.guides();
    EXPECT_FALSE(supervisor.moves() && anyOf(kWrong));
    EXPECT_FALSE(guides && (anyOf(kLinks) || anyOf(kSight) || now.stop));
    EXPECT_FALSE(guides && before == State::hold);
    EXPECT_FALSE(before == State::fault && after != State::fault && !now.rearmed);
    EXPECT_FALSE(before == State::hold && supervisor.moves() && after != State::hold && !now.rearmed);
    if (HasFailure()) return;
  }
}

TEST(HandOver, RampsInItsTimeAndNeverSteps)
{
  HandOver hand_over;
  double last = 0.0;
  int cycles = 0;
  for (; hand_over.share() < 1.0; ++cycles) {
    const double share = hand_over.update(true, 1e-3);
    EXPECT_LE(std::abs(share - last), 1.51e-3 / 0.15);
    last = share;
  }
  EXPECT_NEAR(cycles, 150, 1);
  for (cycles = 0; hand_over.share() > 0.0; ++cycles) hand_over.update(false, 1e-3);
  EXPECT_NEAR(cycles, 150, 1);
}

TEST(HandOver, IgnoresATimeThatIsNone)
{
  HandOver hand_over;
  hand_over.update(true, 0.05);
  const double share = hand_over.share();
  for (const double dt : {double{NAN}, double{INFINITY}, -1.0, 0.0}) EXPECT_EQ(hand_over.update(true, dt), share);
}

}  // namespace
