// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/retina_predictor.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/units.h"
#include "eyeslam/servo/loop_time.h"
#include "eyeslam/servo/square.h"

namespace eyeslam::servo {

using retina::Reason;
using Signals = MotionFilter::Signals;

namespace {

constexpr double kSlowFrames_s = 1.0 / 30.0;
constexpr double kFastFrames_s = 1.0 / 120.0;
constexpr double kIntervalShare = 0.1;            // of a new interval in the running mean
constexpr double kLongestInterval = 3.0;          // times the mean: a longer one is a gap, not the camera's rate
constexpr double kMissing = 1.5;                  // times the mean: a frame was left out
constexpr double kHistory_s = 0.5;                // of the port, and the longest gap between poses that is bridged
constexpr std::int64_t kCalm_us = 100'000;        // a jump within this of another is no outlier: the eye is jumping
constexpr double kTurnVelocity = 20.0 * kDegree;  // rad/s, of the eye about its line of sight; source: assumption
constexpr double kZoomVelocity = 0.1;             // 1/s

// What is left of a time over which a velocity counts fully up to `from` and then fades.
double fadedTime(double time_s, double from_s, double fade_s)
{
  if (time_s <= from_s) return time_s;
  return from_s + fade_s * (1.0 - std::exp(-(time_s - from_s) / fade_s));
}

}  // namespace

RetinaPredictor::RetinaPredictor(const RetinaPredictorOptions& options)
    : options_(options),
      port_(options.fast_lag_ms * kMilli, options.slow_lag_ms * kMilli, options.slope_ms * kMilli),
      filters_{MotionFilter({options.velocity_mm_s * kMilli, options.gain}),
               MotionFilter({options.velocity_mm_s * kMilli, options.gain}), MotionFilter({kTurnVelocity, 0.0}),
               MotionFilter({kZoomVelocity, 0.0})},
      other_(filters_),
      interval_s_(kSlowFrames_s)
{}

Reason RetinaPredictor::observePort(std::int64_t utime, const Eigen::Vector2d& port) noexcept
{
  if (!port.allFinite()) return Reason::state_not_finite;
  if (port_.inUse() && utime <= port_.utime()) return Reason::state_late;
  dropSilentPort(utime);
  if (options_.gain > 0.0) port_.observe(utime, port);
  return Reason::none;
}

void RetinaPredictor::dropSilentPort(std::int64_t now) noexcept
{
  if (!port_.inUse() || seconds(now - port_.utime()) <= options_.port_silence_ms * kMilli) return;
  const Signals last = port_.at(now);
  for (Filters* filters : {&filters_, &other_}) {
    (*filters)[kX].foldSignals(last);
    (*filters)[kY].foldSignals(last);
  }
  port_.clear();
}

// A power of the interval through the two that were studied: the shorter it is, the faster a velocity may change
// without being noise.
RetinaPredictor::Numbers RetinaPredictor::accelerations() const noexcept
{
  const double slow = options_.acceleration_um_s2;
  const double fast = options_.fast_acceleration_um_s2;
  const double part = std::log(kSlowFrames_s / std::clamp(interval_s_, kFastFrames_s, kSlowFrames_s)) /
                      std::log(kSlowFrames_s / kFastFrames_s);
  double shift = slow * std::pow(std::max(fast, 1e-9) / std::max(slow, 1e-9), part);
  if (!port_.inUse()) shift = std::max(shift, options_.no_port_acceleration_um_s2);
  return {shift * kMicro, shift * kMicro, options_.turn_deg_s2 * kDegree, options_.zoom_s2};
}

Signals RetinaPredictor::signalsFor(std::size_t axis, const Signals& port) const noexcept
{
  return axis <= kY ? port : Signals::Zero();
}

RetinaPredictor::Sight RetinaPredictor::sight(const SeenPose& seen) const noexcept
{
  const retina::Pose2& pose = seen.view_T_retina;
  const double theta = filters_[kTheta].position() + retina::wrapAngle(pose.theta - filters_[kTheta].position());
  const double shift = square(std::max(seen.sigma, options_.noise_um * kMicro));
  return {
      {pose.x, pose.y, theta, std::log(pose.scale)},
      {shift, shift, square(std::max(seen.sigma_theta, options_.noise_deg * kDegree)), square(options_.noise_scale)},
      port_.at(seen.utime)};
}

void RetinaPredictor::advance(Filters& filters, double time_s) const noexcept
{
  const Numbers acceleration = accelerations();
  for (std::size_t i = 0; i < kAxes; ++i) filters[i].advance(time_s, acceleration[i], options_.gain_walk);
}

RetinaPredictor::Verdict RetinaPredictor::judge(const Filters& filters, const Sight& sight) const noexcept
{
  Numbers surprise{};
  Numbers sigma{};
  for (const std::size_t axis : {kX, kY, kTheta}) {
    const Signals signals = signalsFor(axis, sight.signals);
    surprise[axis] = filters[axis].surprise(sight.measured[axis], signals);
    sigma[axis] = std::sqrt(filters[axis].surpriseVariance(sight.variance[axis], signals));
  }
  const double shift = std::hypot(surprise[kX], surprise[kY]);
  const double shift_gate = options_.gate_um * kMicro + options_.gate_sigmas * std::max(sigma[kX], sigma[kY]);
  const double turn_gate = options_.gate_deg * kDegree + options_.gate_sigmas * sigma[kTheta];
  return {shift, !options_.gated || (shift <= shift_gate && std::abs(surprise[kTheta]) <= turn_gate)};
}

void RetinaPredictor::update(Filters& filters, const Sight& sight) const noexcept
{
  for (std::size_t i = 0; i < kAxes; ++i)
    filters[i].update(sight.measured[i], sight.variance[i], signalsFor(i, sight.signals));
}

RetinaPredictor::Filters RetinaPredictor::jumped(const Filters& filters, const Sight& sight) const noexcept
{
  Filters after = filters;
  for (std::size_t i = 0; i < kAxes; ++i) {
    const double extra = i <= kY ? square(options_.jump_um * kMicro) : 0.0;
    after[i].jump(sight.measured[i], sight.variance[i] + extra, signalsFor(i, sight.signals));
  }
  return after;
}

// The next frame decides whether a jump was one. Until then: where frames are slow the jump is believed, because the
// tip would stay behind; where they are fast it is not, because outliers are more frequent than jumps. But a frame that
// was missing just before, refused for its blur, speaks for a jump, and so does another jump a moment ago.
Reason RetinaPredictor::decide(const Sight& sight, std::int64_t utime, double passed) noexcept
{
  const Verdict here = judge(filters_, sight);
  surprise_ = here.surprise;
  if (here.within) {
    update(filters_, sight);
    doubtful_ = false;
    return Reason::none;
  }
  if (doubtful_ && judge(other_, sight).within) {
    update(other_, sight);
    filters_ = other_;
    doubtful_ = false;
    return Reason::none;
  }
  const bool expected = passed > kMissing * interval_s_ || utime - jump_utime_ <= kCalm_us;
  const bool waits = !doubtful_ && !expected && interval_s_ < options_.doubt_ms * kMilli;
  other_ = jumped(filters_, sight);
  if (!waits) std::swap(filters_, other_);
  doubtful_ = true;
  jump_utime_ = utime;
  return Reason::pose_jumped;
}

void RetinaPredictor::begin(const Sight& sight) noexcept
{
  for (std::size_t i = 0; i < kAxes; ++i)
    filters_[i].begin(sight.measured[i], sight.variance[i], signalsFor(i, sight.signals));
  doubtful_ = false;
  surprise_ = 0.0;
  ready_ = true;
}

Reason RetinaPredictor::correct(const SeenPose& seen, std::int64_t now) noexcept
{
  const retina::Pose2& pose = seen.view_T_retina;
  const bool finite = std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.theta) &&
                      std::isfinite(pose.scale) && std::isfinite(seen.sigma) && std::isfinite(seen.sigma_theta);
  if (!finite || pose.scale <= 0.0) return Reason::pose_not_finite;
  if ((ready_ && seen.utime <= utime_) || seen.utime > now || seconds(now - seen.utime) > kHistory_s)
    return Reason::pose_late;
  dropSilentPort(now);
  const double passed = seconds(seen.utime - utime_);
  const bool starts = !ready_ || passed > kHistory_s;
  utime_ = seen.utime;
  if (starts) {
    begin(sight(seen));
    return Reason::none;
  }
  if (passed < kLongestInterval * interval_s_) interval_s_ += kIntervalShare * (passed - interval_s_);
  advance(filters_, passed);
  if (doubtful_) advance(other_, passed);
  return decide(sight(seen), seen.utime, passed);
}

PredictedPose RetinaPredictor::at(std::int64_t utime) const noexcept
{
  if (!ready_) return {};
  const double age = seconds(utime - utime_);
  const double moved = fadedTime(age, options_.fade_from_ms * kMilli, options_.fade_ms * kMilli);
  const Signals port = port_.at(utime);
  const Numbers acceleration = accelerations();
  Numbers there{};
  Numbers variance{};
  for (std::size_t i = 0; i < kAxes; ++i) {
    const MotionFilter& filter = filters_[i];
    there[i] = filter.position() + filter.velocity() * moved + filter.gains().dot(signalsFor(i, port));
    variance[i] = filter.varianceAfter(age, acceleration[i]);
  }
  return {{there[kX], there[kY], retina::wrapAngle(there[kTheta]), std::exp(there[kScale])},
          {filters_[kX].velocity(), filters_[kY].velocity()},
          std::sqrt(std::max(variance[kX], variance[kY])),
          std::sqrt(variance[kTheta]),
          age};
}

}  // namespace eyeslam::servo
