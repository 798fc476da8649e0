// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/laser_device.h"

#include <gtest/gtest.h>

namespace eyeslam::simulation {
namespace {

using messaging::LaserAction;
using messaging::LaserCommand;
using messaging::LaserState;
using retina::Reason;

/// A laser that is ready, and one who wants pulses of 20 ms and 0.2 W.
class Laser : public ::testing::Test {
 protected:
  void want(LaserAction action, std::int64_t pulse = 0)
  {
    command_ = {};
    command_.action = action;
    if (action == LaserAction::fire) {
      command_.target = static_cast<int>(100 + pulse);
      command_.pulse = pulse;
      command_.duration = 0.02;
      command_.power = 0.2;
    }
    heard_.command = &command_;
    heard_.age = 1e-3;
    heard_.session = 7;
  }
  const LaserState& step(int periods = 1)
  {
    for (int i = 0; i < periods; ++i) {
      laser_.step(switches_, heard_);
      if (laser_.state().emitting) ++emitted_;
    }
    return laser_.state();
  }
  void expectRefusal(Reason why)
  {
    want(LaserAction::fire, 1);
    step(30);
    EXPECT_EQ(emitted_, 0);
    EXPECT_EQ(laser_.state().reason, why);
    EXPECT_EQ(laser_.state().pulse, 0);
  }
  void expectEnd(Reason why)
  {
    EXPECT_FALSE(step().emitting);
    EXPECT_TRUE(laser_.state().pulse_done);
    EXPECT_EQ(laser_.state().reason, why);
  }

  LaserDevice laser_{{}};
  LaserSwitches switches_{true, true, true};
  LaserCommand command_;
  HeardCommand<LaserCommand> heard_;
  int emitted_ = 0;  // ms
};

TEST_F(Laser, EmitsOnePulseOfItsDurationHoweverLongItIsHeld)
{
  want(LaserAction::fire, 1);
  step(100);
  EXPECT_EQ(emitted_, 20);
  const LaserState& state = laser_.state();
  EXPECT_EQ(state.pulse, 1);
  EXPECT_EQ(state.target, 101);
  EXPECT_TRUE(state.pulse_done);
  EXPECT_NEAR(state.pulse_duration, 0.02, 1e-9);
  EXPECT_EQ(state.reason, Reason::none);
  want(LaserAction::fire, 2);
  step(100);
  EXPECT_EQ(emitted_, 40);
}

TEST_F(Laser, ANumberThatWasBeforeBeginsNoPulse)
{
  want(LaserAction::fire, 2);
  step(30);
  for (const std::int64_t old : {1, 2}) {
    want(LaserAction::aim);
    step(5);
    want(LaserAction::fire, old);
    step(30);
  }
  EXPECT_EQ(emitted_, 20);
}

TEST_F(Laser, ARefusedNumberIsSpent)
{
  switches_.foot_switch = false;
  want(LaserAction::fire, 1);
  step(3);
  switches_.foot_switch = true;
  step(30);
  EXPECT_EQ(emitted_, 0);
  EXPECT_EQ(laser_.state().reason, Reason::foot_switch_up);
  want(LaserAction::fire, 2);
  step(30);
  EXPECT_EQ(emitted_, 20);
}

TEST_F(Laser, BeginsNothingWithTheFootSwitchUp)
{
  switches_.foot_switch = false;
  expectRefusal(Reason::foot_switch_up);
}

TEST_F(Laser, BeginsNothingUnarmed)
{
  switches_.armed = false;
  expectRefusal(Reason::not_armed);
}

TEST_F(Laser, EmitsNothingWithTheInterlockOpen)
{
  switches_.interlock_closed = false;
  expectRefusal(Reason::interlock_open);
  want(LaserAction::aim);
  EXPECT_FALSE(step().aiming);
}

TEST_F(Laser, RefusesAPulseLongerOrStrongerThanItsOwnLimits)
{
  want(LaserAction::fire, 1);
  command_.duration = 0.21;
  EXPECT_EQ(step(5).reason, Reason::pulse_too_long);
  want(LaserAction::fire, 2);
  command_.power = 0.76;
  EXPECT_EQ(step(5).reason, Reason::power_too_high);
  EXPECT_EQ(emitted_, 0);
}

TEST_F(Laser, ReleasingTheFootSwitchEndsThePulse)
{
  want(LaserAction::fire, 1);
  step(5);
  switches_.foot_switch = false;
  expectEnd(Reason::foot_switch_up);
}

TEST_F(Laser, OpeningTheInterlockEndsThePulse)
{
  want(LaserAction::fire, 1);
  step(5);
  switches_.interlock_closed = false;
  expectEnd(Reason::interlock_open);
}

TEST_F(Laser, DisarmingEndsThePulse)
{
  want(LaserAction::fire, 1);
  step(5);
  switches_.armed = false;
  expectEnd(Reason::not_armed);
}

TEST_F(Laser, ACommandThatIsNotRenewedEndsThePulse)
{
  want(LaserAction::fire, 1);
  step(5);
  heard_.age = 0.005;
  EXPECT_TRUE(step().emitting);
  heard_.age = 0.006;
  expectEnd(Reason::command_lapsed);
  EXPECT_FALSE(laser_.state().aiming);
}

TEST_F(Laser, NoCommandLivesLongerThanTheLaserAllows)
{
  want(LaserAction::fire, 1);
  command_.expiry = 1.0;
  heard_.age = 0.006;
  step(30);
  EXPECT_EQ(emitted_, 0);
}

TEST_F(Laser, AnotherWishEndsThePulse)
{
  want(LaserAction::fire, 1);
  step(5);
  want(LaserAction::aim);
  expectEnd(Reason::command_lapsed);
  want(LaserAction::fire, 2);
  step(5);
  want(LaserAction::off);
  expectEnd(Reason::command_lapsed);
  want(LaserAction::fire, 3);
  step(5);
  want(LaserAction::fire, 4);
  expectEnd(Reason::command_lapsed);
}

TEST_F(Laser, AClockThatStepsEndsThePulse)
{
  want(LaserAction::fire, 1);
  step(5);
  heard_.fault = Reason::clock_stepped;
  expectEnd(Reason::command_lapsed);
}

TEST_F(Laser, AimsWhileItIsMeant)
{
  EXPECT_FALSE(step().aiming);
  want(LaserAction::aim);
  EXPECT_TRUE(step().aiming);
  want(LaserAction::fire, 1);
  EXPECT_TRUE(step().aiming);
  want(LaserAction::off);
  EXPECT_FALSE(step().aiming);
}

}  // namespace
}  // namespace eyeslam::simulation
