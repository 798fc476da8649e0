// SPDX-License-Identifier: GPL-3.0-or-later
// What a live servo does when what it hears is wrong; EYESLAM_SERVO is its program.
#include "support/live_bench.h"
#include "support/live_fault.h"

namespace eyeslam {
namespace {

using messaging::MicronMode;
using messaging::ServoState;
using messaging::WantedMode;
using retina::Reason;
using simulation::HardwareFault;

constexpr std::int64_t kStranger = 55;
const messaging::Key kOtherKey{3, 2, 1};

class WrongMessages : public support::LiveFaultOn<support::LiveBench> {
 protected:
  void SetUp() override { ASSERT_NO_FATAL_FAILURE(begin(WantedMode::laser)); }

  /// Refused before it stopped: so many, and as many more as came in the time of a cycle.
  void expectRefused(const std::optional<Status>& stop, Reason reason, std::int64_t count, double per_s) const
  {
    ASSERT_TRUE(stop);
    const std::int64_t refused =
        stop->value.messages_refused[messaging::refusalIndex(reason)] - before_[messaging::refusalIndex(reason)];
    EXPECT_GE(refused, count);
    EXPECT_LE(static_cast<double>(refused), static_cast<double>(count) + per_s * cycleOf(*stop));
  }
  void markFault()
  {
    before_ = bench.record.statuses.last().value.messages_refused;
    mark();
  }

  messaging::Refusals before_{};
};

TEST_F(WrongMessages, AStateThatIsNoNumberIsAFaultAtOnce)
{
  markFault();
  bench.hardware().inject(HardwareFault::tip_not_finite);
  has_states = false;
  const auto stop = expectStop(ServoState::fault, Reason::state_not_finite);
  expectRefused(stop, Reason::not_finite, 1, 1000.0);
  bench.hardware().mend(HardwareFault::tip_not_finite);
  expectOnlyRearmingLeads(wanted);
}

TEST_F(WrongMessages, AControllerThatRestartsIsAFaultAtOnce)
{
  markFault();
  bench.hardware().inject(HardwareFault::restart);
  bench.run(3);
  bench.record.acceptNewSessions();  // who listens has noticed it, too
  const auto stop = expectStop(ServoState::fault, Reason::controller_restarted);
  expectRefused(stop, Reason::wrong_session, 1, 1000.0);
  expectOnlyRearmingLeads(wanted);
}

TEST_F(WrongMessages, AClockThatStepsIsAFaultAtOnce)
{
  markFault();
  bench.hardware().inject(HardwareFault::clock_step);
  bench.run(3);
  bench.record.acceptNewSessions();
  const auto stop = expectStop(ServoState::fault, Reason::clock_stepped);
  expectRefused(stop, Reason::clock_stepped, 1, 1000.0);
  expectOnlyRearmingLeads(wanted);
}

TEST_F(WrongMessages, APoseThatJumpsFartherThanAnyEyeIsHoldAtOnce)
{
  const double jump_px = 1.8e-3 * 1e6 / bench.hardware().umPerPx();
  markFault();
  bench.spoil_pose = [jump_px](messaging::RetinaPose& pose) { pose.motion.map_T_frame.x += jump_px; };
  const auto stop = expectStop(ServoState::hold, Reason::pose_jumped);
  ASSERT_TRUE(stop);
  const auto poses = bench.record.poses.since(fault_utime);
  ASSERT_FALSE(poses.empty());
  EXPECT_LE(1e-6 * static_cast<double>(stop->header.utime_sent - poses[0].header.utime_sent), 10e-3 + cycleOf(*stop))
      << "the first that jumped";
  bench.spoil_pose = nullptr;
  expectOnlyRearmingLeads(wanted);
}

TEST_F(WrongMessages, CommandsThatComeLateAreNotObeyedAndTheServoHolds)
{
  markFault();
  bench.commands_held_us = 80'000;
  expectStop(ServoState::hold, Reason::expired);
  for (const auto& state : bench.record.states.since(fault_utime + 60'000)) {
    ASSERT_FALSE(state.value.follows_command);
    EXPECT_EQ(state.value.reason, Reason::expired);
  }
  bench.commands_held_us = 0;
  expectOnlyRearmingLeads(wanted);
}

TEST_F(WrongMessages, AForgedPulseIsNeverEmitted)
{
  bench.askAssist();  // nothing of the servo's own is lit
  wanted = ServoState::assist;
  ASSERT_TRUE(bench.runUntil([this] { return bench.state() == wanted; }, 1000));
  bench.foot_switch = true;
  bench.run(100);
  markFault();
  messaging::LaserCommand pulse;
  pulse.action = messaging::LaserAction::fire;
  pulse.target = 1;
  pulse.duration = pulse.power = 0.1;
  const std::int64_t own = bench.record.lights.last().header.session;
  for (int i = 0; i < 4; ++i) {
    pulse.pulse = 1000 + i;
    bench.put("LASER_COMMAND", bench.message<laser_command_t>(pulse, own, 1'000'000 + i, kOtherKey));
    bench.run(10);
  }
  expectStop(ServoState::hold, Reason::unauthenticated);
  const auto told = bench.record.lasers.since(fault_utime);
  ASSERT_FALSE(told.empty());
  for (const auto& laser : told) EXPECT_FALSE(laser.value.aiming || laser.value.emitting);
}

struct Attack {
  const char* name;
  Reason reason;
  void (*send)(support::LiveBench& bench, int i);
};
void PrintTo(const Attack& attack, std::ostream* out) { *out << attack.name; }

messaging::MicronCommand strangeCommand()
{
  messaging::MicronCommand command;
  command.mode = MicronMode::follow;
  command.goal.x() = 1e-3;
  return command;
}

class Attacked : public WrongMessages, public testing::WithParamInterface<Attack> {};

TEST_P(Attacked, HoldsAtTheFourthMessageThatItRefusesWithinASecondAndNotBefore)
{
  const auto send = [this](int i) {
    GetParam().send(bench, i);
    bench.run(20);
  };
  markFault();
  for (int i = 0; i < 3; ++i) send(i);
  bench.run(100);
  for (const Status& status : bench.record.statuses.since(fault_utime)) {
    ASSERT_EQ(status.value.state, wanted) << describe(status);
  }
  const std::int64_t fourth = support::clocks().utime;
  GetParam().send(bench, 3);
  const auto stop = expectStop(ServoState::hold, GetParam().reason);
  expectRefused(stop, GetParam().reason, 4, 0.0);
  EXPECT_LE(1e-6 * static_cast<double>(stop->header.utime_sent - fourth), 20e-3 + cycleOf(*stop));
  expectOnlyRearmingLeads(wanted);
}

constexpr Attack kAttacks[] = {
    {"forged_command", Reason::unauthenticated,
     [](support::LiveBench& bench, int i) {
       const std::int64_t servo = bench.record.motions.last().header.session;
       bench.put("MICRON_COMMAND", bench.message<micron_command_t>(strangeCommand(), servo, 1'000'000 + i, kOtherKey));
     }},
    {"forged_wish", Reason::unauthenticated,
     [](support::LiveBench& bench, int i) {
       bench.put("OPERATOR", bench.message<operator_t>(messaging::OperatorWish{}, kStranger, i, kOtherKey));
     }},
    {"replayed_command", Reason::replayed,
     [](support::LiveBench& bench, int) { bench.put("MICRON_COMMAND", bench.first_command.at("MICRON_COMMAND")); }},
    {"replayed_wish", Reason::replayed,
     [](support::LiveBench& bench, int) {
       bench.put("OPERATOR", bench.message<operator_t>(bench.wish, bench.link.session(), bench.wishesSaid() - 1));
     }},
    {"a_goal_as_a_pose", Reason::wrong_type,
     [](support::LiveBench& bench, int i) {
       bench.put("RETINA_POSE", bench.message<micron_command_t>(strangeCommand(), bench.link.session(), i));
     }},
    {"another_console", Reason::wrong_session,
     [](support::LiveBench& bench, int i) {
       bench.put("OPERATOR", bench.message<operator_t>(messaging::OperatorWish{}, kStranger, i));
     }},
};
INSTANTIATE_TEST_SUITE_P(By, Attacked, testing::ValuesIn(kAttacks),
                         [](const auto& attack) { return std::string(attack.param.name); });

}  // namespace
}  // namespace eyeslam
