// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/servo_messages.h"

#include <array>
#include <cmath>

#include "eyeslam/messaging/field_copy.h"

namespace eyeslam::messaging {
namespace {

constexpr Range kAge{-1.0, 1e9};  // s; -1 = nothing has come yet

bool isPlane(const PublishedPlane& plane)
{
  constexpr double kRounding = 1e-6;
  return plane.known ? std::abs(plane.normal.squaredNorm() - 1.0) < kRounding : plane.normal.isZero(0.0);
}

}  // namespace

std::string_view word(ServoState state)
{
  constexpr std::array<std::string_view, 6> kWords{"standby", "ready", "assist", "laser", "hold", "fault"};
  const auto number = static_cast<std::size_t>(state);
  return number < kWords.size() ? kWords[number] : "unknown";
}

template <>
struct Listing<registration_t> {
  template <class Copy, class Message, class Registration>
  static void list(Copy& copy, Message& message, Registration& registration)
  {
    copy.flag(message.valid, registration.valid);
    copy.reason(message.reason, registration.reason);
    copy.number(message.samples, registration.samples, kNotNegative);
    copy.numbers(message.image_T_manipulator, registration.image_T_manipulator, kAnyNumber);
    copy.covariance(message.row_covariance, registration.row_covariance);
    copy.number(message.residual_px, registration.residual_px, kNotNegative);
    copy.number(message.condition, registration.condition, kNotNegative);
    copy.number(message.um_per_px, registration.um_per_px, kUmPerPx);
    copy.flag(message.plane_known, registration.plane.known);
    copy.numbers(message.plane_normal, registration.plane.normal, {-1.0, 1.0});
    copy.number(message.plane_offset, registration.plane.offset, kPosition);
    copy.number(message.plane_residual, registration.plane.residual, kNotNegative);
    copy.require(isPlane(registration.plane));
  }
};
template struct ListedConversion<registration_t, PublishedRegistration>;

template <>
struct Listing<servo_status_t> {
  template <class Copy, class Message, class Status>
  static void list(Copy& copy, Message& message, Status& status)
  {
    copy.choice(message.state, status.state, ServoState::fault);
    copy.reason(message.reason, status.reason);
    copy.number(message.map_id, status.map_id, kAnyNumber);
    copy.flag(message.real_time, status.real_time);
    copy.number(message.pose_age, status.pose_age, kAge);
    copy.number(message.state_age, status.state_age, kAge);
    copy.number(message.laser_age, status.laser_age, kAge);
    copy.number(message.operator_age, status.operator_age, kAge);
    copy.number(message.frame_to_command, status.frame_to_command, kAge);
    copy.number(message.computation, status.computation, {0.0, 1.0});
    copy.number(message.lateness, status.lateness, kNotNegative);
    copy.number(message.cycles, status.cycles, kNotNegative);
    copy.number(message.overruns, status.overruns, kNotNegative);
    copy.number(message.messages_lost, status.messages_lost, kNotNegative);
    copy.counts(message.messages_refused, status.messages_refused);
  }
};
template struct ListedConversion<servo_status_t, ServoStatus>;

}  // namespace eyeslam::messaging
