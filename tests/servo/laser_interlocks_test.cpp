// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/laser_interlocks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

using namespace eyeslam;
using eyeslam::retina::Reason;
using eyeslam::servo::LaserInterlocks;
using eyeslam::servo::PulseConditions;

namespace {

PulseConditions allClosed()
{
  PulseConditions c;
  c.laser_state = c.foot_switch = c.armed_by_human = c.armed_laser = c.interlock_closed = true;
  c.plan_in_force = c.target_valid = c.target_unburnt = c.registered = c.tracked = true;
  c.laser_age = 0.01;
  c.operator_age = 0.05;
  c.pose_age = 0.03;
  c.pose_error = 5e-6;
  c.innovation = 5e-6;
  c.since_jump = 1.0;
  c.goal_distance = 10e-6;
  c.settled_for = 0.05;
  c.spot_distance = 15e-6;
  c.reach_left = 1e-3;
  c.speed = 0.5e-3;
  c.retina_speed = 0.5e-3;
  c.standoff_error = 50e-6;
  c.clearance = 150e-6;
  return c;
}

struct Opening {
  const char* name;
  std::function<void(PulseConditions&)> open;
  Reason reason;
  bool ends_a_pulse;
};

/// One way to open each interlock, a little beyond its limit.
std::vector<Opening> openings()
{
  return {
      {"state", [](auto& c) { c.laser_state = false; }, Reason::not_in_laser, true},
      {"foot switch", [](auto& c) { c.foot_switch = false; }, Reason::foot_switch_up, true},
      {"armed by the human", [](auto& c) { c.armed_by_human = false; }, Reason::not_armed, true},
      {"armed at the laser", [](auto& c) { c.armed_laser = false; }, Reason::not_armed, true},
      {"remote interlock", [](auto& c) { c.interlock_closed = false; }, Reason::interlock_open, true},
      {"laser's age", [](auto& c) { c.laser_age = 0.0501; }, Reason::laser_stale, true},
      {"operator's age", [](auto& c) { c.operator_age = 0.2001; }, Reason::operator_stale, true},
      {"plan", [](auto& c) { c.plan_in_force = false; }, Reason::plan_not_in_force, true},
      {"target", [](auto& c) { c.target_valid = false; }, Reason::target_invalid, true},
      {"registration", [](auto& c) { c.registered = false; }, Reason::registration_uncertain, true},
      {"tracked", [](auto& c) { c.tracked = false; }, Reason::retina_lost, true},
      {"pose's age", [](auto& c) { c.pose_age = 0.0535; }, Reason::pose_stale, true},
      {"pose's error", [](auto& c) { c.pose_error = 21e-6; }, Reason::pose_uncertain, true},
      {"innovation", [](auto& c) { c.innovation = 41e-6; }, Reason::pose_surprising, true},
      {"retina's speed", [](auto& c) { c.retina_speed = 5.1e-3; }, Reason::retina_moves, true},
      {"reach", [](auto& c) { c.reach_left = 199e-6; }, Reason::reach_ends, true},
      {"standoff", [](auto& c) { c.standoff_error = 301e-6; }, Reason::standoff_wrong, true},
      {"vessel", [](auto& c) { c.clearance = 99e-6; }, Reason::near_vessel, true},
      {"spot", [](auto& c) { c.spot_distance = 41e-6; }, Reason::spot_off_target, true},
      {"burnt", [](auto& c) { c.target_unburnt = false; }, Reason::target_burnt, false},
      {"innovation before", [](auto& c) { c.innovation = 21e-6; }, Reason::pose_surprising, false},
      {"jump", [](auto& c) { c.since_jump = 0.149; }, Reason::retina_jumped, false},
      {"tip's speed", [](auto& c) { c.speed = 2.1e-3; }, Reason::tip_moves, false},
      {"goal", [](auto& c) { c.goal_distance = 21e-6; }, Reason::tip_unsettled, false},
      {"settled", [](auto& c) { c.settled_for = 0.029; }, Reason::tip_unsettled, false},
  };
}

std::vector<double PulseConditions::*> numbers()
{
  using C = PulseConditions;
  return {&C::laser_age,  &C::operator_age,  &C::pose_age,       &C::pose_error,    &C::innovation,
          &C::since_jump, &C::goal_distance, &C::settled_for,    &C::spot_distance, &C::reach_left,
          &C::speed,      &C::retina_speed,  &C::standoff_error, &C::clearance};
}

TEST(LaserInterlocks, AllowAPulseWhileAllAreClosed)
{
  EXPECT_EQ(LaserInterlocks().whyNotBegin(allClosed()), Reason::none);
  EXPECT_EQ(LaserInterlocks().whyNotGoOn(allClosed()), Reason::none);
}

TEST(LaserInterlocks, EachAloneForbidsAPulseAndNamesItself)
{
  for (const Opening& opening : openings()) {
    SCOPED_TRACE(opening.name);
    PulseConditions conditions = allClosed();
    opening.open(conditions);
    EXPECT_EQ(LaserInterlocks().whyNotBegin(conditions), opening.reason);
    EXPECT_EQ(LaserInterlocks().whyNotGoOn(conditions), opening.ends_a_pulse ? opening.reason : Reason::none);
  }
}

TEST(LaserInterlocks, WhatIsNoNumberForbidsAPulse)
{
  for (const auto number : numbers()) {
    PulseConditions conditions = allClosed();
    conditions.*number = NAN;
    EXPECT_NE(LaserInterlocks().whyNotBegin(conditions), Reason::none);
  }
}

TEST(LaserInterlocks, NothingKnownForbidsAPulse)
{
  EXPECT_NE(LaserInterlocks().whyNotBegin({}), Reason::none);
  EXPECT_NE(LaserInterlocks().whyNotGoOn({}), Reason::none);
}

TEST(LaserInterlocks, ClosingMoreNeverForbidsWhatWasAllowed)
{
  std::mt19937 random(1);
  const std::vector<Opening> all = openings();
  for (int i = 0; i < 100000; ++i) {
    PulseConditions conditions = allClosed();
    int opened = 0;
    for (const Opening& opening : all) {
      if (random() % 20 != 0) continue;
      opening.open(conditions);
      ++opened;
    }
    EXPECT_EQ(LaserInterlocks().whyNotBegin(conditions) == Reason::none, opened == 0);
  }
}

}  // namespace
