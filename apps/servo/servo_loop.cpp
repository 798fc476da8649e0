// SPDX-License-Identifier: GPL-3.0-or-later
#include "servo/servo_loop.h"

#include <utility>

namespace eyeslam::apps {
namespace {

// A flood must not take the cycle: 64 messages are 0.4 ms, and at most 4 or 5 are due in a millisecond.
constexpr std::size_t kMostMessages = 64;

}  // namespace

ServoLoop::ServoLoop(const servo::ServoOptions& options, messaging::Link& link, ServoExchanges& exchanges,
                     bool real_time, CycleRecord& record, messaging::Clocks clocks)
    : link_(link), clocks_(clocks), exchanges_(exchanges), record_(record), real_time_(real_time), servo_(options, link)
{}

bool ServoLoop::cycle(const CycleStart& start)
{
  record_.add(start);
  const messaging::ReceiveTime now{start.monotonic, start.utime};
  link_.drain(clocks_, kMostMessages);
  takeWhatWasPrepared(start.utime);
  const bool closes = exchanges_.closes;
  if (closes) servo_.close();
  servo_.cycle(now, {start.lateness, start.computation, start.left_out, real_time_});
  leaveSamples();
  leavePlan();
  status_ = servo_.status();
  exchanges_.statuses.tryOffer(status_);
  return !closes || servo_.motion().has_value();
}

void ServoLoop::takeWhatWasPrepared(std::int64_t utime)
{
  if (exchanges_.preparations.tryTake(preparation_)) {
    in_use_ = preparation_.get();
    preparation_ = servo_.adopt(std::move(preparation_));
  }
  if (exchanges_.calibrations.tryTake(calibration_) && calibration_) servo_.adopt(*calibration_, utime);
}

void ServoLoop::leaveSamples()
{
  const servo::CalibrationSamples* samples = servo_.samples();
  if (samples == nullptr || !samples_) return;
  *samples_ = *samples;
  if (exchanges_.samples.tryOffer(samples_)) servo_.samplesTaken();
}

void ServoLoop::leavePlan()
{
  if (!schedule_.isDue(servo_) || in_use_ == nullptr || !plan_) return;
  if (servo_.ledger().describe(*in_use_, *plan_) && exchanges_.plans.tryOffer(plan_)) schedule_.told(servo_);
}

}  // namespace eyeslam::apps
