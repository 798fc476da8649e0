// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/manual_laser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "eyeslam/messaging/subscription.h"

namespace eyeslam::trials {
namespace {

using Eigen::Vector2d;
using messaging::LaserAction;

constexpr std::int64_t kUtime = 1'700'000'000'000'000;
constexpr int kSeenOver_ms = 100, kDelay_ms = 30, kReaction_ms = 200;  // the defaults

const TrialSetting& setting()
{
  static const TrialSetting laser =
      settingOf("laser",
                "task: laser\naid: manual\nprescription: {pattern: {kind: rings, diameters_um: \"1000 2000\", "
                "counts: \"5 11\"}}\n");
  return laser;
}

const TrialScene& scene()
{
  static const TrialScene retina(setting(), 2);
  return retina;
}

/// A manual laser, and what it said in each millisecond.
class Operated : public ::testing::Test {
 protected:
  /// The beam so far beside the target that he aims at.
  messaging::LaserCommand step(double off)
  {
    const messaging::ReceiveTime now{kUtime + 1000 * ms, kUtime + 1000 * ms};
    laser.step(laser.target() + Vector2d(off, 0.0), now);
    link.drain(now);
    ++ms;
    return laser.done() ? messaging::LaserCommand() : *commands.latest();
  }
  /// @return milliseconds until it fires, as counted from now; -1: not within this time
  int untilFire(double off, int longest_ms)
  {
    for (int i = 0; i < longest_ms; ++i)
      if (step(off).action == LaserAction::fire) return i;
    return -1;
  }
  std::int64_t count(int state) const
  {
    const auto& targets = plans.latest()->target;
    return std::count_if(targets.begin(), targets.end(), [state](const burn_target_t& t) { return t.state == state; });
  }

  messaging::Link link{"memq://", 4, std::nullopt};
  messaging::Subscription<laser_command_t> commands{link};
  messaging::Subscription<burn_plan_t> plans{link};
  ManualLaser laser{setting(), scene(), link};
  std::int64_t ms = 0;
};

TEST_F(Operated, FiresNotBeforeHeHasSeenAndReacted)
{
  const int at = untilFire(0.0, 2000);
  EXPECT_GE(at, kReaction_ms + kSeenOver_ms + kDelay_ms - 1);
  EXPECT_LE(at, kReaction_ms + kSeenOver_ms + kDelay_ms + 1);
}

TEST_F(Operated, OnlyAimsWhileWhatHeSeesIsTooFarOff)
{
  EXPECT_EQ(untilFire(101e-6, 3000), -1);
  EXPECT_EQ(commands.latest()->action, LaserAction::aim);
  EXPECT_GE(untilFire(99e-6, 2000), kReaction_ms);
}

// Tremor to both sides does not keep him from firing, as the mean of its distances, 160 um, would; being off does.
TEST_F(Operated, GoesByTheMeanPlaceOfAMoment)
{
  const auto fires = [this](double there, double back) {
    for (int i = 0; i < 600; ++i)
      if (step(i % 2 == 0 ? there : back).action == LaserAction::fire) return true;
    return false;
  };
  EXPECT_FALSE(fires(300e-6, -60e-6));
  EXPECT_TRUE(fires(180e-6, -140e-6));
}

TEST_F(Operated, FiresAtWhatHeSawThoughTheBeamHasLeft)
{
  for (int i = 0; i < kSeenOver_ms + kReaction_ms; ++i) ASSERT_EQ(step(0.0).action, LaserAction::aim);
  EXPECT_NE(untilFire(500e-6, kDelay_ms + 5), -1);
}

TEST_F(Operated, BurnsEachTargetOnceInTheOrderOfItsPlanAndSaysSoInThePlan)
{
  step(0.0);
  const burn_plan_t plan = *plans.latest();
  EXPECT_EQ(plan.state, burn_plan_t::IN_FORCE);
  std::vector<int> allowed, burnt;
  for (const burn_target_t& target : plan.target)
    if (target.state == 0) allowed.push_back(target.id);
  ASSERT_GT(allowed.size(), 3U);
  const std::int64_t refused = count(3);
  std::int64_t pulse = 0;
  while (!laser.done() && ms < 60'000) {
    const messaging::LaserCommand command = step(0.0);
    if (command.action != LaserAction::fire || command.pulse == pulse) continue;
    EXPECT_EQ(command.pulse, ++pulse);
    burnt.push_back(command.target);
    EXPECT_EQ(count(1), pulse - 1) << "done is only what has been burnt";
    const auto& target = *std::find_if(plan.target.begin(), plan.target.end(),
                                       [&](const burn_target_t& t) { return t.id == command.target; });
    EXPECT_EQ(command.duration, target.duration);
    EXPECT_EQ(command.power, target.power);
    const Vector2d place = 1e-6 * scene().umPerPx() * Vector2d(target.x_px, target.y_px);
    EXPECT_LT((laser.target() - place).norm(), 1e-9) << "he aims at what he burns";
  }
  ASSERT_TRUE(laser.done());
  EXPECT_EQ(burnt, allowed);
  step(0.0);
  EXPECT_EQ(count(0), 0);
  EXPECT_EQ(count(1), static_cast<std::int64_t>(allowed.size()));
  EXPECT_EQ(count(3), refused);
}

TEST_F(Operated, PlansOnTheTrueVesselsAndKeepsOffThem)
{
  step(0.0);
  const burn_plan_t& plan = *plans.latest();
  for (const burn_target_t& target : plan.target) {
    if (target.state != 0) continue;
    const Vector2d place = 1e-6 * scene().umPerPx() * Vector2d(target.x_px, target.y_px);
    EXPECT_GT(scene().vesselDistance(place), 0.5e-6 * target.burn_um) << target.id;
  }
}

}  // namespace
}  // namespace eyeslam::trials
