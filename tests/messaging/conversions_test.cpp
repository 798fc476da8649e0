// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <functional>
#include <limits>

#include "support/encoded_message.h"
#include "support/random_values.h"

namespace eyeslam::messaging {
namespace {

using retina::Reason;
using support::Bytes;

/// All types of fixed size: what a controller needs, and the rest.
template <class Message>
class FixedMessage : public ::testing::Test {
 protected:
  using Value = typename Conversion<Message>::Value;

  static Value value(std::uint64_t seed)
  {
    Value value;
    support::RandomValues(seed).fill(value);
    return value;
  }
  static Message message(std::uint64_t seed)
  {
    Message message{};
    EXPECT_EQ(write(value(seed), message), Reason::none);
    return message;
  }
};
using FixedTypes = ::testing::Types<laser_command_t, laser_state_t, micron_command_t, micron_state_t, operator_t,
                                    registration_t, retina_pose_t, servo_status_t, tool_tip_t>;
TYPED_TEST_SUITE(FixedMessage, FixedTypes, );

TYPED_TEST(FixedMessage, IsOfFixedSizeBelow1400Bytes)
{
  EXPECT_TRUE(kFixedSize<TypeParam>);
  EXPECT_LT(TypeParam().getEncodedSize(), 1400);
}

TYPED_TEST(FixedMessage, EveryPossibleValueTravelsUnchanged)
{
  EXPECT_TRUE(rc::check([](std::uint64_t seed) {
    const Bytes sent = support::encodedMessage(TestFixture::message(seed));
    TypeParam received{}, again{};
    typename Conversion<TypeParam>::Value value;
    RC_ASSERT(support::decodeMessage(sent, received));
    RC_ASSERT(read(received, value) == Reason::none);
    RC_ASSERT(write(value, again) == Reason::none);
    RC_ASSERT(support::encodedMessage(again) == sent);
  }));
}

// No field is forgotten: a bit that changes in the message changes in the value, or the message is refused.
TYPED_TEST(FixedMessage, EveryByteBetweenHeaderAndTagReachesTheValue)
{
  constexpr std::size_t kBody = 8 + 4 * 8;
  const std::size_t tag = HasTag<TypeParam>::value ? kTagBytes : 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Bytes sent = support::encodedMessage(TestFixture::message(seed));
    for (std::size_t at = kBody; at < sent.size() - tag; ++at) {
      Bytes changed = sent;
      changed[at] = static_cast<std::uint8_t>(changed[at] ^ 1U);
      TypeParam received{}, again{};
      typename Conversion<TypeParam>::Value value;
      ASSERT_TRUE(support::decodeMessage(changed, received));
      if (read(received, value) != Reason::none) continue;
      again.utime = received.utime;
      ASSERT_EQ(write(value, again), Reason::none) << "byte " << at;
      EXPECT_EQ(support::encodedMessage(again), changed) << "byte " << at;
    }
  }
}

template <std::size_t kSize>
void add(std::vector<double*>& all, double (&numbers)[kSize])
{
  for (double& number : numbers) all.push_back(&number);
}

std::vector<double*> numbersOf(laser_command_t& m) { return {&m.duration, &m.power, &m.expiry}; }
std::vector<double*> numbersOf(laser_state_t& m) { return {&m.pulse_duration}; }
std::vector<double*> numbersOf(micron_command_t& m)
{
  std::vector<double*> all{&m.speed_bound, &m.expiry};
  add(all, m.goal);
  add(all, m.pivot);
  return all;
}
std::vector<double*> numbersOf(micron_state_t& m)
{
  std::vector<double*> all{&m.lead,       &m.reach_lateral, &m.reach_axial,
                           &m.cycle_rate, &m.speed_limit,   &m.acceleration_limit};
  for (auto* position : {&m.null_position, &m.tip_position, &m.handle_position}) add(all, *position);
  for (auto* orientation : {&m.null_orientation, &m.tip_orientation, &m.handle_orientation}) add(all, *orientation);
  add(all, m.goal_position);
  add(all, m.port_displacement);
  return all;
}
std::vector<double*> numbersOf(operator_t& m) { return {&m.point_px[0], &m.point_px[1], &m.standoff, &m.lambda}; }
std::vector<double*> numbersOf(registration_t& m)
{
  std::vector<double*> all{&m.residual_px, &m.condition, &m.um_per_px, &m.plane_offset, &m.plane_residual};
  add(all, m.image_T_manipulator);
  add(all, m.row_covariance);
  add(all, m.plane_normal);
  return all;
}
std::vector<double*> numbersOf(retina_pose_t& m)
{
  std::vector<double*> all{&m.exposure,      &m.x_px,          &m.y_px,           &m.theta,    &m.scale,
                           &m.velocity_x_px, &m.velocity_y_px, &m.velocity_theta, &m.um_per_px};
  add(all, m.covariance);
  return all;
}
std::vector<double*> numbersOf(servo_status_t& m)
{
  return {&m.pose_age, &m.state_age, &m.laser_age, &m.operator_age, &m.frame_to_command, &m.computation, &m.lateness};
}
std::vector<double*> numbersOf(tool_tip_t& m)
{
  std::vector<double*> all{&m.exposure,  &m.tip_x_px,  &m.tip_y_px,      &m.shaft_angle,
                           &m.spot_x_px, &m.spot_y_px, &m.shaft_width_px};
  add(all, m.tip_covariance);
  add(all, m.spot_covariance);
  return all;
}

TYPED_TEST(FixedMessage, ANumberThatIsNotFiniteIsRefusedWhereverItStands)
{
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), -HUGE_VAL}) {
    TypeParam message = TestFixture::message(7);
    typename Conversion<TypeParam>::Value value;
    for (double* number : numbersOf(message)) {
      const double good = *number;
      *number = bad;
      EXPECT_EQ(read(message, value), Reason::not_finite);
      *number = good;
    }
    EXPECT_EQ(read(message, value), Reason::none);
  }
}

MicronCommand following()
{
  MicronCommand command;
  command.mode = MicronMode::follow;
  command.goal = {0.001, 0.002, 0.003};
  return command;
}

Reason refusalOf(const MicronCommand& command)
{
  micron_command_t message{};
  return write(command, message);
}

TEST(MicronCommandMessage, IsRefusedBeyondItsRanges)
{
  const auto changed = [](const std::function<void(MicronCommand&)>& change) {
    MicronCommand command = following();
    change(command);
    return refusalOf(command);
  };
  EXPECT_EQ(refusalOf(following()), Reason::none);
  EXPECT_EQ(changed([](MicronCommand& c) { c.speed_bound = 0.0; }), Reason::out_of_range);
  EXPECT_EQ(changed([](MicronCommand& c) { c.speed_bound = 0.3; }), Reason::out_of_range);
  EXPECT_EQ(changed([](MicronCommand& c) { c.expiry = 2.0; }), Reason::out_of_range);
  EXPECT_EQ(changed([](MicronCommand& c) { c.goal.x() = 1.1; }), Reason::out_of_range);
  EXPECT_EQ(changed([](MicronCommand& c) { c.mode = MicronMode::at_null; }), Reason::out_of_range);
  EXPECT_EQ(changed([](MicronCommand& c) { c.pivot.x() = 0.1; }), Reason::out_of_range);
  EXPECT_EQ(changed([](MicronCommand& c) { c.goal.x() = std::nan(""); }), Reason::not_finite);
}

// A deflection that was meant as a place in the manipulator's frame is tens of mm long.
TEST(MicronCommandMessage, ADeflectionIsAtMostTenMillimetres)
{
  MicronCommand command = following();
  command.reference = GoalReference::deflection;
  EXPECT_EQ(refusalOf(command), Reason::none);
  command.goal = {0.008, 0.008, 0.0};
  EXPECT_EQ(refusalOf(command), Reason::out_of_range);
  command.reference = GoalReference::tip;
  EXPECT_EQ(refusalOf(command), Reason::none);
}

TEST(LaserCommandMessage, FiresOnlyWithTargetPulseAndDuration)
{
  const LaserCommand whole{1, LaserAction::fire, 3, 1, 0.02, 0.1, 0.005};
  laser_command_t message{};
  EXPECT_EQ(write(whole, message), Reason::none);
  for (const auto& spoil : std::vector<std::function<void(LaserCommand&)>>{
           [](LaserCommand& c) { c.target = -1; }, [](LaserCommand& c) { c.pulse = 0; },
           [](LaserCommand& c) { c.duration = 0.0; }, [](LaserCommand& c) { c.action = LaserAction::aim; }}) {
    LaserCommand command = whole;
    spoil(command);
    EXPECT_EQ(write(command, message), Reason::out_of_range);
  }
}

TEST(OperatorMessage, AZoneHasThreeCornersAndAPlanWithoutApprovalNoHash)
{
  OperatorWish wish;
  operator_t message{};
  wish.zones = 1;
  wish.zone[0].corners = 2;
  EXPECT_EQ(write(wish, message), Reason::out_of_range);
  wish.zone[0].corners = 3;
  EXPECT_EQ(write(wish, message), Reason::none);
  wish.zones = 9;
  EXPECT_EQ(write(wish, message), Reason::out_of_range);
  wish.zones = 1;
  wish.plan_hash[3] = 1;
  EXPECT_EQ(write(wish, message), Reason::out_of_range);
}

TEST(OperatorMessage, AVesselIsNamedByItsIdOrByAPointNotByBoth)
{
  OperatorWish wish;
  operator_t message{};
  wish.fixture.kind = FixtureKind::vessel;
  wish.fixture.point_px = {10.0, 20.0};
  EXPECT_EQ(write(wish, message), Reason::none);
  OperatorWish heard;
  EXPECT_EQ(read(message, heard), Reason::none);
  EXPECT_EQ(heard.fixture.point_px, wish.fixture.point_px);
  EXPECT_EQ(heard.fixture.vessel, -1);
  wish.fixture.vessel = 4;
  EXPECT_EQ(write(wish, message), Reason::out_of_range);
  message.vessel = 4;
  EXPECT_EQ(read(message, heard), Reason::out_of_range) << "whoever sent it";
  wish.fixture.point_px.setZero();
  EXPECT_EQ(write(wish, message), Reason::none);
  for (const FixtureKind kind : {FixtureKind::none, FixtureKind::filter, FixtureKind::scaling, FixtureKind::standoff,
                                 FixtureKind::calibration}) {
    wish.fixture = {};
    wish.fixture.kind = kind;
    EXPECT_EQ(write(wish, message), Reason::none);
    wish.fixture.point_px.y() = 1.0;
    EXPECT_EQ(write(wish, message), Reason::out_of_range) << "neither of a point nor of a vessel";
  }
}

TEST(ToolTipMessage, HasNoPlaceForWhatIsNotSeen)
{
  InstrumentSight sight;
  tool_tip_t message{};
  EXPECT_EQ(write(sight, message), Reason::none);
  sight.tip.position_px.x() = 5.0;
  EXPECT_EQ(write(sight, message), Reason::out_of_range);
  sight.tip.present = true;
  EXPECT_EQ(write(sight, message), Reason::none);
}

TEST(RetinaPoseMessage, RefusesWhatIsNoCovariance)
{
  RetinaPose pose;
  retina_pose_t message{};
  pose.motion.covariance << 4, 1, 0, 1, 4, 0, 0, 0, 1;
  EXPECT_EQ(write(pose, message), Reason::none);
  pose.motion.covariance(0, 1) = -1.0;
  EXPECT_EQ(write(pose, message), Reason::out_of_range);
  pose.motion.covariance(0, 1) = pose.motion.covariance(1, 0) = 4.1;
  EXPECT_EQ(write(pose, message), Reason::out_of_range);
  pose.motion.covariance = -Eigen::Matrix3d::Identity();
  EXPECT_EQ(write(pose, message), Reason::out_of_range);
}

TEST(RetinaPoseMessage, CarriesEachFieldUnderItsName)
{
  RetinaPose pose;
  pose.frame = {100, 7, 0.01};
  pose.map = {8, 9, 5.5};
  pose.motion.tracked = true;
  pose.motion.map_T_frame = {1.0, 2.0, 0.3, 1.1};
  pose.motion.velocity = {4.0, 5.0, 0.6};
  pose.motion.covariance << 9, 2, 3, 2, 8, 1, 3, 1, 7;
  retina_pose_t message{};
  ASSERT_EQ(write(pose, message), Reason::none);
  EXPECT_EQ(message.utime, 100);
  EXPECT_EQ(message.frame, 7);
  EXPECT_EQ(message.y_px, 2.0);
  EXPECT_EQ(message.theta, 0.3);
  EXPECT_EQ(message.scale, 1.1);
  EXPECT_EQ(message.velocity_theta, 0.6);
  EXPECT_EQ(message.covariance[1], 2.0);
  EXPECT_EQ(message.covariance[5], 1.0);
  EXPECT_EQ(message.map_version, 9);
  EXPECT_EQ(message.um_per_px, 5.5);
}

TEST(Channel, IsTheTypesNameInCapitals)
{
  EXPECT_EQ(channelOf<retina_pose_t>(), "RETINA_POSE");
  EXPECT_EQ(channelOf<operator_t>(), "OPERATOR");
  EXPECT_EQ(channelOf<servo_status_t>(), "SERVO_STATUS");
}

}  // namespace
}  // namespace eyeslam::messaging
