// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/servo_replay.h"

#include <fmt/format.h>

#include <utility>

#include "eyeslam/messaging/decoding.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/replay/message_types.h"
#include "eyeslam/replay/recorded_configuration.h"
#include "eyeslam/replay/recorded_trial.h"
#include "eyeslam/replay/todays_type.h"

namespace eyeslam::replay {
namespace {

constexpr const char* kServo = "eyeslam-servo";
constexpr std::int64_t kSame_us = 1'000'000;  // as events are sorted
constexpr const char* kCompared[] = {"MICRON_COMMAND", "LASER_COMMAND", "SERVO_STATUS", "REGISTRATION"};

bool isMark(std::string_view channel) { return channel == "MARK"; }

servo::ServoConfiguration liveServoConfiguration(const std::string& yaml)
{
  return configuration::applied(servo::ServoConfiguration{}, configuration::parseYaml(kServo, yaml));
}

}  // namespace

ServoReplay::ServoReplay(std::vector<configuration::Assignment> changes, Comparison& comparison)
    : changes_(std::move(changes)), comparison_(comparison)
{}

void ServoReplay::take(const SortedEvent& sorted)
{
  files::LogEvent event = sorted.event;
  event.utime = sorted.utime;
  const bool concerns = isMark(event.channel) || RecomputedServo::hears(event.channel) ||
                        event.channel == "SERVO_STATUS" || event.channel == "REGISTRATION";
  if (!concerns) return;
  if (judgeToday(event).standing != Standing::ours) return;
  if (timeline_ && ((stopped_ && event.utime > *stopped_) || sorted.part != part_)) end();
  part_ = sorted.part;
  if (timeline_) timeline_->take(event);
  mark_t mark{};
  if (isMark(event.channel) && messaging::decode(event.data, event.size, mark)) take(mark, event.utime);
}

void ServoReplay::take(const mark_t& mark, std::int64_t utime)
{
  const bool of_it = timeline_ && mark.sender == start_.sender && mark.session == start_.session;
  if (of_it && mark.kind == mark_t::STOP) stopped_ = utime;
  if (mark.kind != mark_t::START) return;
  if (timeline_ && (of_it || mark.sender != start_.sender)) return;
  if (timeline_) end();  // it was started anew, without having been stopped
  if (mark.sender == kServo) {
    beginLive(mark, utime);
  } else if (mark.sender == "eyeslam-trial") {
    beginTrial(mark, utime);
  }
}

void ServoReplay::beginTrial(const mark_t& mark, std::int64_t utime)
{
  const std::optional<RecordedTrial> trial = recordedTrial(mark, changes_);
  if (!trial) return;
  // Either may be any number in a damaged log.
  if (mark.utime < utime - kSame_us || mark.utime > utime + kSame_us)
    throw ReplayError("MARK START is of another time than it was logged at, so that nothing says when cycles were");
  start_ = mark;
  bare_hand_ = trial->setting.scenario.isManual();
  if (bare_hand_) return;
  timeline_ = std::make_unique<LockStepTimeline>(trial->setting, mark.session, mark.utime, comparison_, goals_);
  about_ = fmt::format("servo of {} {} in lock step: {}{}, seed {}", mark.sender, mark.version, trial->name.scenario,
                       trial->name.variant.empty() ? "" : ", " + trial->name.variant, trial->name.seed);
  for (const char* channel : kCompared) comparison_.expect(channel);
}

// From when it was logged on: its sender may be of a computer with another clock.
void ServoReplay::beginLive(const mark_t& mark, std::int64_t utime)
{
  timeline_ = std::make_unique<LiveTimeline>(
      configuration::applied(recordedConfiguration(mark, liveServoConfiguration), changes_), mark.session, utime,
      comparison_, goals_);
  start_ = mark;
  live_ = true;
  about_ = fmt::format("servo of {} {}, which ran in real time", mark.sender, mark.version);
  comparison_.expect("MICRON_COMMAND");
}

void ServoReplay::finish()
{
  if (timeline_) end();
}

// Of a log that was cut off the last cycle may lack anything.
void ServoReplay::end()
{
  timeline_->finish(stopped_.has_value());
  timeline_.reset();
  stopped_.reset();
}

std::string ServoReplay::lacking() const
{
  if (!about_.empty()) return "";
  if (bare_hand_) return "a trial by hand alone: there was no servo to compute again";
  return "no MARK START of eyeslam-trial or eyeslam-servo: nothing says how the servo was set; "
         "the logger must run before the servo begins";
}

}  // namespace eyeslam::replay
