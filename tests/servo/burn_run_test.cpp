// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/burn_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "support/allocation_counter.h"
#include "support/burn_scene.h"

using namespace eyeslam;
using namespace eyeslam::servo;
using messaging::LaserAction;
using retina::Reason;
using support::BurnScene;
using support::linePlan;

namespace {

using Change = std::function<void(BurnInput&)>;

/// A way to open one interlock, and what the run must say then.
struct Opening {
  std::string name;
  Reason reason;
  Change change;
};

Change laser(void (*spoil)(messaging::LaserState&))
{
  return [spoil, spoilt = std::make_shared<messaging::LaserState>()](BurnInput& in) {
    *spoilt = *in.laser;
    spoil(*spoilt);
    in.laser = spoilt.get();
  };
}

Change wish(void (*spoil)(messaging::OperatorWish&))
{
  return [spoil, spoilt = std::make_shared<messaging::OperatorWish>()](BurnInput& in) {
    *spoilt = *in.wish;
    spoil(*spoilt);
    in.wish = spoilt.get();
  };
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double sine(double frequency, std::int64_t utime)
{
  return std::sin(2.0 * M_PI * frequency * 1e-6 * static_cast<double>(utime - support::kBurnStart));
}

std::vector<Opening> openings()
{
  return {
      {"no Laser", Reason::not_in_laser, [](BurnInput& in) { in.laser_state = false; }},
      {"foot switch", Reason::foot_switch_up, laser([](auto& state) { state.foot_switch = false; })},
      {"armed laser", Reason::not_armed, laser([](auto& state) { state.armed = false; })},
      {"remote interlock", Reason::interlock_open, laser([](auto& state) { state.interlock_closed = false; })},
      {"no laser heard", Reason::foot_switch_up, [](BurnInput& in) { in.laser = nullptr; }},
      {"old laser", Reason::laser_stale, [](BurnInput& in) { in.laser_age = 0.051; }},
      {"armed by human", Reason::not_armed, wish([](auto& human) { human.arm = false; })},
      {"stop", Reason::not_armed, wish([](auto& human) { human.stop = true; })},
      {"not approved", Reason::plan_not_in_force, wish([](auto& human) { human.plan_approved = false; })},
      {"another plan approved", Reason::plan_not_in_force, wish([](auto& human) { human.plan_hash[3] ^= 1; })},
      {"no human heard", Reason::plan_not_in_force, [](BurnInput& in) { in.wish = nullptr; }},
      {"old human", Reason::operator_stale, [](BurnInput& in) { in.operator_age = 0.201; }},
      {"no preparation", Reason::plan_not_in_force, [](BurnInput& in) { in.preparation = nullptr; }},
      {"another map", Reason::map_changed, [](BurnInput& in) { ++in.map_id; }},
      {"another scale", Reason::plan_scale, [](BurnInput& in) { in.um_per_px *= 1.031; }},
      {"unknown scale", Reason::plan_scale, [](BurnInput& in) { in.um_per_px = 0.0; }},
      {"not registered", Reason::registration_uncertain, [](BurnInput& in) { in.registered = false; }},
      {"not tracked", Reason::retina_lost, [](BurnInput& in) { in.tracked = false; }},
      {"old pose", Reason::pose_stale, [](BurnInput& in) { in.pose_age = 0.061; }},
      {"uncertain pose", Reason::pose_uncertain, [](BurnInput& in) { in.pose_error = 21e-6; }},
      {"surprise", Reason::pose_surprising, [](BurnInput& in) { in.innovation = 21e-6; }},
      {"jump", Reason::retina_jumped, [](BurnInput& in) { in.since_jump = 0.149; }},
      {"moving retina", Reason::retina_moves, [](BurnInput& in) { in.retina_speed = 5.1e-3; }},
      {"end of reach", Reason::reach_ends, [](BurnInput& in) { in.reach_left = 0.199e-3; }},
      {"standoff", Reason::standoff_wrong, [](BurnInput& in) { in.tip.z() -= 0.32e-3; }},
      {"no shaft", Reason::beam_misses, [](BurnInput& in) { in.shaft.setConstant(kNaN); }},
      {"shaft along the retina", Reason::beam_misses,
       [](BurnInput& in) {
         in.shaft = {1.0, 0.0, 0.01};
       }},
      {"tip no number", Reason::beam_misses, [](BurnInput& in) { in.tip.x() = kNaN; }},
      {"pose age no number", Reason::pose_stale, [](BurnInput& in) { in.pose_age = kNaN; }},
      {"vibrating tip", Reason::tip_moves,
       [](BurnInput& in) {
         in.tip.x() += 15e-6 * sine(100.0, in.now);  // round in a circle: as fast at any time
         in.tip.y() += 15e-6 * sine(100.0, in.now + 2500);
       }},
      {"swaying tip", Reason::tip_unsettled, [](BurnInput& in) { in.tip.x() += 100e-6 * sine(3.1, in.now); }},
      {"out of everyone's reach", Reason::reach_ends, [](BurnInput& in) { in.null.x() += 5e-3; }},
      {"out of the picture", Reason::out_of_view, [](BurnInput& in) { in.view.view_T_retina.x = 30e-3; }},
      {"late after the pose", Reason::pose_not_new, [](BurnInput& in) { in.since_pose = 4e-3; }},
  };
}

/// Fires the first target of a scene half way.
void beginPulse(BurnScene& scene)
{
  for (int i = 0; i < 2000 && scene.laser.pulses.empty(); ++i) scene.step();
  scene.run_ms(5);
}

}  // namespace

TEST(BurnRun, BurnsAllTargetsOfAPlanOnceAndInItsOrder)
{
  BurnScene scene(linePlan(5));
  scene.run_ms(4000);
  EXPECT_EQ(scene.laser.pulses, (std::vector<int>{10, 11, 12, 13, 14}));
  EXPECT_EQ(scene.run->ledger().count(Fate::done), 5U);
  EXPECT_EQ(scene.step().reason, Reason::plan_done);
  scene.run_ms(1000);
  EXPECT_EQ(scene.laser.pulses.size(), 5U);
}

// The study's rate with the rule of 3 ms: 2.39 a second.
TEST(BurnRun, BurnsAsFastAsTheStudy)
{
  BurnScene scene(linePlan(8));
  const std::int64_t begun = scene.now;
  while (scene.laser.pulses.size() < 8 && scene.now - begun < 10'000'000) scene.step();
  const double rate = 8.0 / (1e-6 * static_cast<double>(scene.now - begun));
  RecordProperty("burns_per_s", std::to_string(rate));
  EXPECT_GT(rate, 2.3);
}

TEST(BurnRun, EachOpenInterlockAloneForbidsThePulseAndSaysWhy)
{
  for (const Opening& opening : openings()) {
    BurnScene scene(linePlan(1));
    std::vector<Reason> reasons;
    for (int i = 0; i < 1500; ++i) {
      const BurnOutput& output = scene.step(opening.change);
      EXPECT_NE(output.command.action, LaserAction::fire) << opening.name;
      if (i > 600) reasons.push_back(output.reason);
    }
    EXPECT_TRUE(scene.laser.pulses.empty()) << opening.name;
    EXPECT_NE(std::find(reasons.begin(), reasons.end(), opening.reason), reasons.end())
        << opening.name << ": " << retina::word(reasons.back());
    scene.run_ms(1500);
    EXPECT_EQ(scene.laser.pulses.size(), 1U) << opening.name << ": and with it closed it fires";
  }
}

// What must not outlast the interlock; the others only keep a pulse from beginning.
TEST(BurnRun, ARunningPulseIsStoppedInTheVeryCycleThatAnInterlockOpens)
{
  for (const Opening& opening : openings()) {
    const bool only_to_begin = opening.reason == Reason::pose_surprising || opening.reason == Reason::retina_jumped ||
                               opening.reason == Reason::pose_not_new || opening.reason == Reason::tip_moves ||
                               opening.reason == Reason::tip_unsettled || opening.reason == Reason::out_of_view ||
                               opening.name == "out of everyone's reach";
    if (only_to_begin) continue;
    BurnScene scene(linePlan(1));
    beginPulse(scene);
    ASSERT_EQ(scene.laser.pulses.size(), 1U);
    ASSERT_TRUE(scene.laser.state.emitting);
    EXPECT_NE(scene.step(opening.change).command.action, LaserAction::fire) << opening.name;
  }
}

TEST(BurnRun, ALargeSurpriseStopsARunningPulse)
{
  BurnScene scene(linePlan(1));
  beginPulse(scene);
  EXPECT_EQ(scene.step([](BurnInput& in) { in.innovation = 30e-6; }).command.action, LaserAction::fire);
  EXPECT_NE(scene.step([](BurnInput& in) { in.innovation = 41e-6; }).command.action, LaserAction::fire);
}

TEST(BurnRun, APulseThatWasCutIsRecordedAndNotRepeated)
{
  BurnScene scene(linePlan(2));
  beginPulse(scene);
  scene.step([](BurnInput& in) { in.tracked = false; });
  scene.run_ms(3000);
  EXPECT_EQ(scene.laser.pulses, (std::vector<int>{10, 11}));
  const TargetRecord& cut = scene.run->ledger().at(0);
  EXPECT_EQ(cut.fate, Fate::missed);
  EXPECT_EQ(cut.reason, Reason::retina_lost);
  EXPECT_GT(cut.emitted_s, 0.0);
  EXPECT_LT(cut.emitted_s, 0.019);
  EXPECT_EQ(scene.run->ledger().at(1).fate, Fate::done);
}

TEST(BurnRun, WhileTheLaserHasNotToldOfAPulseThereIsNoOther)
{
  BurnScene scene(linePlan(3));
  beginPulse(scene);
  const messaging::LaserState frozen = scene.laser.state;  // still emitting: its last word
  bool waits = false;
  for (int i = 0; i < 3000; ++i) {
    const BurnOutput& output = scene.step([&](BurnInput& in) { in.laser = &frozen; });
    waits = waits || output.reason == Reason::pulse_unconfirmed;
  }
  EXPECT_TRUE(waits);
  EXPECT_EQ(scene.laser.pulses.size(), 1U);
  scene.run_ms(2000);
  EXPECT_EQ(scene.laser.pulses.size(), 3U);
}

TEST(BurnRun, APulseThatTheLaserRefusesIsAskedForAgainAFewTimesUnderANewNumber)
{
  BurnScene scene(linePlan(1));
  scene.laser.refuses = true;
  std::vector<std::int64_t> numbers;
  for (int i = 0; i < 8000; ++i) {
    const messaging::LaserCommand& command = scene.step().command;
    if (command.pulse > 0 && (numbers.empty() || numbers.back() != command.pulse)) numbers.push_back(command.pulse);
  }
  EXPECT_EQ(numbers, (std::vector<std::int64_t>{1, 2, 3}));
  EXPECT_EQ(scene.run->ledger().at(0).fate, Fate::missed);
  EXPECT_EQ(scene.run->ledger().at(0).reason, Reason::pulse_refused);
  EXPECT_EQ(scene.run->ledger().at(0).emitted_s, 0.0);
}

TEST(BurnRun, ASpotThatIsSeenBesideWhereItShouldBeIsBroughtOntoTheTarget)
{
  BurnScene scene(linePlan(3));
  scene.spot_offset = {70e-6, -50e-6};  // the surface is not where it was thought
  scene.run_ms(6000);
  EXPECT_EQ(scene.laser.pulses.size(), 3U);
  EXPECT_LT((scene.run->spotCorrection() - scene.spot_offset).norm(), 5e-6);
}

TEST(BurnRun, WithoutASpotInTheNewestFrameThereIsNoPulse)
{
  BurnScene scene(linePlan(1));
  const Change dark = [](BurnInput& in) { in.spot.reset(); };
  Reason last = Reason::none;
  for (int i = 0; i < 1500; ++i) last = scene.step(dark).reason;
  EXPECT_EQ(last, Reason::spot_off_target);
  const Change elsewhere = [](BurnInput& in) {
    if (in.spot) in.spot->x() += 350e-6;  // beyond what is believed, so that it is not followed
  };
  for (int i = 0; i < 1500; ++i) last = scene.step(elsewhere).reason;
  EXPECT_EQ(last, Reason::spot_off_target);
  EXPECT_TRUE(scene.laser.pulses.empty());
}

TEST(BurnRun, AFrameThatTheTreatmentBeamOutshinesDoesNotStopIt)
{
  BurnScene scene(linePlan(1));
  beginPulse(scene);
  const std::int64_t fired = scene.now;
  for (int i = 0; i < 30; ++i) {
    scene.step([&](BurnInput& in) {
      in.sight_utime = fired;
      in.spot.reset();
    });
  }
  EXPECT_EQ(scene.run->ledger().at(0).fate, Fate::done);
}

TEST(BurnRun, ASpotThatWasSeenLongAgoIsNone)
{
  BurnScene scene(linePlan(1));
  std::int64_t seen = 0;
  Eigen::Vector2d spot = Eigen::Vector2d::Zero();
  for (int i = 0; i < 1500; ++i) {
    scene.laser.state.foot_switch = i >= 800;
    const Change silent = [&](BurnInput& in) {  // with the spot on its target TOOL_TIP falls silent, poses go on
      if (i < 700) {
        seen = in.sight_utime;
        spot = in.spot.value_or(spot);
      }
      in.sight_utime = seen;
      in.spot = spot;
    };
    const Reason reason = scene.step(silent).reason;
    EXPECT_TRUE(i < 800 || reason == Reason::spot_off_target);
  }
  EXPECT_TRUE(scene.laser.pulses.empty());
}

TEST(BurnRun, AVesselThatAppearsUnderARunningPulseStopsIt)
{
  BurnScene scene(linePlan(1));
  beginPulse(scene);
  ASSERT_TRUE(scene.laser.state.emitting);
  scene.prepared->verdicts[0] = {Reason::near_vessel, -10e-6};
  EXPECT_NE(scene.step().command.action, LaserAction::fire);
}

TEST(BurnRun, TheBeamRestsOnItsTargetBeforeThePulse)
{
  for (const double dwell_ms : {100.0, 200.0, 400.0}) {
    BurnRunOptions options;
    options.dwell_ms = dwell_ms;
    BurnScene scene(linePlan(1), options);
    std::int64_t arrived = 0;
    while (scene.laser.pulses.empty()) {
      scene.step();
      const bool off = (scene.spotNow() - Eigen::Vector2d(0.0, 100e-6)).norm() > 20e-6;
      if (off || arrived == 0) arrived = scene.now;
    }
    EXPECT_GE(1e-3 * static_cast<double>(scene.now - arrived), dwell_ms - 20.0 - 2.0);  // the pulse ends the dwell
    EXPECT_LE(1e-3 * static_cast<double>(scene.now - arrived), dwell_ms + 40.0);        // and a frame at most
  }
}

TEST(BurnRun, WithNoRoomToRememberBurnsThereAreNone)
{
  fixtures::BurnPlan full = linePlan(messaging::kMostTargets);
  for (fixtures::BurnTarget& target : full.targets) target.position_px.y() = 9000.0;
  BurnScene scene(linePlan(1));
  const auto wanted = scene.prepared;
  for (int i = 0; i < 4; ++i) {  // 4 x 2048 places, as if burnt in runs before
    full.um_per_px += 1e-6;
    scene.prepared = support::preparedFor(full);
    burn_plan_t message = *scene.prepared->proposed.message;
    for (burn_target_t& target : message.target) target.state = burn_target_t::DONE;
    scene.prepared->proposed.message = std::make_shared<const burn_plan_t>(message);
    scene.wish.plan_hash = scene.prepared->proposed.hash;
    scene.step();
  }
  scene.prepared = wanted;
  scene.wish.plan_hash = wanted->proposed.hash;
  Reason last = Reason::none;
  for (int i = 0; i < 1500; ++i) last = scene.step().reason;
  EXPECT_TRUE(scene.laser.pulses.empty());
  EXPECT_EQ(last, Reason::burns_full);
}

TEST(BurnRun, TheGoalTravelsNoFasterThanAsked)
{
  BurnScene scene(linePlan(4));
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  bool going = false;
  for (int i = 0; i < 3000; ++i) {
    const BurnOutput& output = scene.step();
    const Eigen::Vector3d goal = output.goal.value_or(last);
    EXPECT_TRUE(!going || (goal - last).norm() <= 5e-6 * 1.001);
    going = output.goal.has_value();
    last = goal;
  }
}

TEST(BurnRun, CommandsAreOffOutsideLaserAndOnlyAimWithoutAPlan)
{
  BurnScene scene(linePlan(1));
  EXPECT_EQ(scene.step([](BurnInput& in) { in.laser_state = false; }).command.action, LaserAction::off);
  EXPECT_EQ(scene.step([](BurnInput& in) { in.wish = nullptr; }).command.action, LaserAction::aim);
  EXPECT_EQ(scene.step().command.action, LaserAction::aim);
}

TEST(BurnRun, EveryCommandIsOneThatAMessageCarries)
{
  BurnScene scene(linePlan(2));
  laser_command_t message{};
  for (int i = 0; i < 2000; ++i) ASSERT_EQ(messaging::write(scene.step().command, message), Reason::none);
}

TEST(BurnRun, NeverAllocates)
{
  BurnScene scene(linePlan(3));
  const std::int64_t before = support::allocations();
  scene.laser.pulses.reserve(8);
  const std::int64_t reserved = support::allocations() - before;
  scene.run_ms(3000);
  EXPECT_EQ(support::allocations(), before + reserved);
  EXPECT_EQ(scene.laser.pulses.size(), 3U);
}
