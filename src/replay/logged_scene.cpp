// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/logged_scene.h"

#include <cstdlib>

#include "eyeslam/messaging/decoding.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/replay/message_types.h"

namespace eyeslam::replay {
namespace {

constexpr std::size_t kStates = 400;  // 0.4 s: older than that no frame is told of

}  // namespace

// What is not understood is as if it had not come.
template <class Message, class Value>
bool LoggedScene::read(const files::LogEvent& event, std::optional<Value>& value)
{
  Message message{};
  if (!messaging::decode(event.data, event.size, message)) return false;
  Value now{};
  if (messaging::Conversion<Message>::read(message, now) != retina::Reason::none) return false;
  value = std::move(now);
  return true;
}

void LoggedScene::take(const SortedEvent& sorted)
{
  const files::LogEvent& event = sorted.event;
  if (judge(event).standing != Standing::ours) return;
  if (event.channel == "RETINA_POSE") read<retina_pose_t>(event, pose_);
  if (event.channel == "TOOL_TIP") read<tool_tip_t>(event, sight_);
  if (event.channel == "OPERATOR") read<operator_t>(event, wish_);
  if (event.channel == "SERVO_STATUS") read<servo_status_t>(event, status_);
  if (event.channel == "MICRON_STATE") takeState(event);
  if (event.channel == "BURN_PLAN") takePlan(event);
  std::optional<messaging::PublishedRegistration> registration;
  if (event.channel == "REGISTRATION" && read<registration_t>(event, registration) && registration->valid)
    registration_ = registration;
  std::optional<vessel_map_t> tile;
  if (event.channel == "VESSEL_MAP" && read<vessel_map_t>(event, tile)) maps_.add(*tile);
  laser_state_t laser{};
  if (event.channel == "LASER_STATE" && messaging::decode(event.data, event.size, laser))
    emitting_ = laser.emitting != 0;
}

void LoggedScene::takeState(const files::LogEvent& event)
{
  std::optional<messaging::MicronState> state;
  if (!read<micron_state_t>(event, state)) return;
  states_.push_back({headerOf(event).utime, *state});
  if (states_.size() > kStates) states_.pop_front();
}

void LoggedScene::takePlan(const files::LogEvent& event)
{
  std::optional<burn_plan_t> plan;
  if (!read<burn_plan_t>(event, plan)) return;
  (plan->state == burn_plan_t::IN_FORCE ? in_force_ : proposed_) = std::move(plan);
}

const messaging::MicronState* LoggedScene::stateAt(std::int64_t utime) const
{
  const State* nearest = nullptr;
  for (const State& state : states_)
    if (nearest == nullptr || std::abs(state.utime - utime) < std::abs(nearest->utime - utime)) nearest = &state;
  return nearest == nullptr ? nullptr : &nearest->state;
}

double LoggedScene::umPerPx() const
{
  if (pose_ && pose_->map.um_per_px > 0.0) return pose_->map.um_per_px;
  return registration_ ? registration_->um_per_px : 0.0;
}

}  // namespace eyeslam::replay
