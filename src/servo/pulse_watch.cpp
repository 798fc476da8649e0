// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/pulse_watch.h"

#include <algorithm>

#include "eyeslam/servo/loop_time.h"

namespace eyeslam::servo {

using retina::Reason;

namespace {

constexpr double kLate_s = 0.01;  // after which a pulse that began with the first command is over
// After the last command has lapsed (5 ms) nothing begins; a word about what began before may take this long.
constexpr double kWord_s = 0.1;

}  // namespace

void PulseWatch::begin(std::size_t index, const messaging::LaserCommand& pulse, const LaserWord& laser,
                       std::int64_t now) noexcept
{
  phase_ = Phase::firing;
  index_ = index;
  begun_ = last_fire_ = now;
  stopped_by_ = Reason::none;
  // Above what the laser has seen, be it from a run before: else its old word would pass for this pulse's.
  number_ = std::max(number_, laser.state ? laser.state->pulse : 0) + 1;
  command_ = pulse;
  command_.action = messaging::LaserAction::fire;
  command_.pulse = number_;
}

PulseFate PulseWatch::endedWith(bool begun, double emitted_s, Reason otherwise) const noexcept
{
  return {index_, begun, emitted_s, command_.duration, stopped_by_ != Reason::none ? stopped_by_ : otherwise};
}

std::optional<PulseFate> PulseWatch::follow(const LaserWord& laser, Reason why, std::int64_t now) noexcept
{
  if (phase_ == Phase::idle) return std::nullopt;
  if (phase_ == Phase::firing) {
    if (why != Reason::none) stopped_by_ = why;
    const bool over = seconds(now - begun_) > command_.duration + kLate_s;
    if (why != Reason::none || over) phase_ = Phase::ending;
    if (phase_ == Phase::firing) last_fire_ = now;
  }
  if (laser.state == nullptr) return std::nullopt;
  if (laser.state->pulse == number_) {
    if (!laser.state->pulse_done) return std::nullopt;
    phase_ = Phase::idle;
    return endedWith(laser.state->pulse_duration > 0.0, laser.state->pulse_duration, Reason::pulse_cut);
  }
  const bool told_since = seconds(now - last_fire_) - laser.age_s > kWord_s;
  if (phase_ != Phase::ending || !told_since) return std::nullopt;
  phase_ = Phase::idle;
  const Reason refusal = laser.state->reason;
  return endedWith(false, 0.0, refusal != Reason::none ? refusal : Reason::pulse_refused);
}

}  // namespace eyeslam::servo
