// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/operator_console.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/plan_file.h"
#include "eyeslam/messaging/record_messages.h"
#include "link/status_text.h"
#include "support/temporary_folder.h"

namespace eyeslam::apps {
namespace {

using messaging::ReceiveTime;
using messaging::ServoState;
using messaging::ServoStatus;
using testing::Contains;
using testing::HasSubstr;

constexpr std::int64_t kStart = 1'700'000'000'000'000;
constexpr std::int64_t kTurn_us = 10'000;
constexpr Eigen::Vector2d::Scalar kCentreX = 399.5, kCentreY = 303.5;

/// A console, and a servo's end of the same link.
class Console : public testing::Test {
 protected:
  /// The next turns of the program.
  void turn(int turns = 1)
  {
    for (int i = 0; i < turns; ++i) {
      now_.monotonic += kTurn_us;
      now_.utime += kTurn_us;
      link_.drain(now_);
      console_.work(now_);
      link_.drain(now_);
    }
  }
  void obey(const std::string& line) { console_.obey(line, now_); }
  void say(ServoState state, retina::Reason reason = retina::Reason::none)
  {
    ServoStatus status;
    status.state = state;
    status.reason = reason;
    statuses_.publish(status, now_.utime, now_.utime);
    turn();
  }
  void see(std::int64_t map_id)
  {
    messaging::RetinaPose pose;
    pose.frame = {now_.utime, 5, 0.01};
    pose.map.id = map_id;
    pose.motion.tracked = true;
    pose.motion.map_T_frame = {10.0, -20.0, 0.0, 1.0};
    pose.motion.covariance = Eigen::Matrix3d::Identity();
    poses_.publish(pose, now_.utime, now_.utime);
    messaging::InstrumentSight sight;
    sight.frame = pose.frame;
    sight.tip = {true, {300.0, 200.0}, Eigen::Matrix2d::Identity()};
    tips_.publish(sight, now_.utime, now_.utime);
    turn();
  }
  std::string writePlan(double power_mw)
  {
    fixtures::BurnPlan plan;
    plan.um_per_px = 5.0;
    plan.map.hash = std::string(64, 'a');
    fixtures::BurnTarget target;
    target.position_px = {100.0, 120.0};
    target.spot_um = target.burn_um = 100.0;
    target.duration_ms = 20.0;
    target.power_mw = power_mw;
    target.clearance_um = 500.0;
    plan.targets = {target};
    const std::string path = folder_.path("plan.json");
    files::writePlan(plan, path);
    return path;
  }

  support::TemporaryFolder folder_;
  messaging::Link link_{"memq://", 3, {}};
  ReceiveTime now_{1'000'000, kStart};
  std::vector<std::string> said_;
  std::vector<messaging::OperatorWish> heard_;
  messaging::Subscription<operator_t> wishes_{link_, [this](const auto& wish, const auto&) { heard_.push_back(wish); }};
  messaging::Subscription<burn_plan_t> plans_{link_};
  messaging::Publisher<servo_status_t> statuses_{link_};
  messaging::Publisher<retina_pose_t> poses_{link_};
  messaging::Publisher<tool_tip_t> tips_{link_};
  messaging::Publisher<registration_t> registrations_{link_};
  OperatorConsole console_{link_, {kCentreX, kCentreY}, [this](const std::string& line) { said_.push_back(line); }};
};

TEST_F(Console, SendsTheWishAtTwentyHertzAndAtOnceWhenItChanges)
{
  turn(100);  // 1 s
  EXPECT_NEAR(static_cast<double>(heard_.size()), 20.0, 1.0);
  EXPECT_EQ(heard_.back().mode, messaging::WantedMode::standby);
  const std::size_t before = heard_.size();
  obey("ready");
  turn();
  ASSERT_EQ(heard_.size(), before + 1);
  EXPECT_EQ(heard_.back().mode, messaging::WantedMode::ready);
}

TEST_F(Console, DatesTheWishByTheLineThatMadeIt)
{
  obey("ready");
  const std::int64_t acted = now_.utime;
  turn(50);
  EXPECT_EQ(wishes_.header().utime, acted);
}

TEST_F(Console, TellsEachChangeOfTheServoOnce)
{
  say(ServoState::ready);
  say(ServoState::ready);
  say(ServoState::hold, retina::Reason::pose_stale);
  EXPECT_EQ(said_, (std::vector<std::string>{"servo: ready", "servo: hold: pose_stale"}));
}

TEST_F(Console, TellsThatTheServoFellSilentAndThatItIsBack)
{
  say(ServoState::assist);
  turn(120);
  say(ServoState::assist);
  EXPECT_EQ(said_, (std::vector<std::string>{"servo: assist", "servo: silent", "servo: assist"}));
}

TEST_F(Console, TakesThePointWhereTheTipIsSeen)
{
  see(9);
  obey("fixture point here");
  turn();
  // Without turn and scale the centre does not matter: map = image + translation.
  EXPECT_NEAR((heard_.back().fixture.point_px - Eigen::Vector2d(310.0, 180.0)).norm(), 0.0, 1e-9);
  EXPECT_EQ(heard_.back().map_id, 9);
}

TEST_F(Console, ProposesAPlanEverySecondAndApprovesItByItsHash)
{
  see(9);
  obey("propose " + writePlan(150.0));
  turn();
  ASSERT_NE(plans_.latest(), nullptr);
  EXPECT_EQ(plans_.latest()->state, burn_plan_t::PROPOSED);
  EXPECT_EQ(plans_.latest()->map_id, 9);
  const std::string hash = said_.back().substr(said_.back().find("hash ") + 5);
  ASSERT_EQ(hash.size(), 64U);
  turn(300);
  EXPECT_EQ(plans_.accepted(), 4);
  EXPECT_THROW(obey("approve " + hash.substr(0, 7)), CommandError) << "too few digits";
  EXPECT_THROW(obey("approve " + hash.substr(1, 8)), CommandError) << "not from its beginning";
  EXPECT_FALSE(heard_.back().plan_approved);
  obey("approve " + hash.substr(0, 8));
  turn();
  EXPECT_TRUE(heard_.back().plan_approved);
  EXPECT_EQ(hexOf(heard_.back().plan_hash), hash);
}

TEST_F(Console, WithdrawsTheApprovalWithAnotherPlan)
{
  see(9);
  obey("propose " + writePlan(150.0));
  const std::string first = said_.back().substr(said_.back().find("hash ") + 5);
  obey("approve " + first);
  obey("propose " + writePlan(160.0));
  turn();
  EXPECT_FALSE(heard_.back().plan_approved);
  EXPECT_EQ(heard_.back().plan_hash, messaging::Hash{});
  EXPECT_THROW(obey("approve " + first), CommandError);
}

TEST_F(Console, RefusesPlansThatCannotBeRead)
{
  EXPECT_THROW(obey("propose " + folder_.path("gone.json")), CommandError) << "no map yet";
  see(9);
  EXPECT_THROW(obey("propose " + folder_.path("gone.json")), files::FileError);
  EXPECT_THROW(obey("approve 12345678"), CommandError);
  turn(150);
  EXPECT_EQ(plans_.received(), 0);
}

TEST_F(Console, WaitsForAStateAndGoesOn)
{
  say(ServoState::standby);
  obey("await ready");
  EXPECT_TRUE(console_.waits());
  turn(10);
  EXPECT_TRUE(console_.waits());
  say(ServoState::ready);
  EXPECT_FALSE(console_.waits());
}

TEST_F(Console, GivesUpWaitingAfterItsTime)
{
  obey("await registration 0.5");
  turn(45);
  EXPECT_TRUE(console_.waits());
  EXPECT_THROW(turn(10), CommandError);
  EXPECT_FALSE(console_.waits());
}

TEST_F(Console, PausesWithoutComplaint)
{
  obey("wait 0.1");
  turn(5);
  EXPECT_TRUE(console_.waits());
  turn(10);
  EXPECT_FALSE(console_.waits());
}

TEST_F(Console, EndsDisarmedInStandby)
{
  obey("ready");
  turn();
  console_.standBy(now_);
  turn();
  EXPECT_EQ(heard_.back().mode, messaging::WantedMode::standby);
  EXPECT_FALSE(heard_.back().arm);
}

TEST_F(Console, ListsEveryCommandAndAnswersToIt)
{
  obey("help");
  EXPECT_GT(said_.size(), 20U);
  for (const char* name : {"standby", "calibrate", "fixture point", "approve", "arm", "stop", "rearm", "quit"}) {
    EXPECT_THAT(said_, Contains(HasSubstr(name)));
  }
  EXPECT_THROW(obey("fly"), CommandError);
  obey("quit");
  EXPECT_TRUE(console_.quits());
}

TEST(StatusText, NamesWhatWasRefused)
{
  ServoStatus status;
  status.messages_refused[messaging::refusalIndex(retina::Reason::expired)] = 2;
  status.messages_refused[messaging::refusalIndex(retina::Reason::unauthenticated)] = 1;
  EXPECT_THAT(statusText(status), HasSubstr("1 unauthenticated, 2 expired"));
  EXPECT_THAT(statusText(status), HasSubstr("not in real time"));
}

}  // namespace
}  // namespace eyeslam::apps
