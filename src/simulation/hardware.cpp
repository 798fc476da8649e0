// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/hardware.h"

#include <cmath>
#include <limits>
#include <utility>

#include "eyeslam/retina/units.h"
#include "eyeslam/simulation/loop_period.h"

namespace eyeslam::simulation {

using messaging::LaserState;
using messaging::ReceiveTime;

namespace {

constexpr std::int64_t kLaserSteps = 10;           // LASER_STATE at 100 Hz
constexpr std::int64_t kClockStep_us = 1'000'000;  // HardwareFault::clock_step
const Eigen::Vector3d kOffset(0.03, -0.02, 0.05);  // m: of the world in the manipulator's frame; none of them is 0

// z up, so x and y are mirrored against the image: a half turn about x, then the yaw.
Eigen::Vector3d shaftAtStart(const PlacementOptions& options)
{
  const double tilt = options.shaft_tilt_deg * kDegree;
  const double azimuth = options.shaft_azimuth_deg * kDegree;
  return {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), -std::cos(tilt)};
}

Eigen::Vector3d middleOfView(const EyeCameraOptions& camera, double um_per_px)
{
  const cv::Point2d centre = imageCentre(camera);
  return um_per_px * 1e-6 * Eigen::Vector3d(centre.x, centre.y, 0.0);
}

bool differs(const LaserState& a, const LaserState& b)
{
  return a.foot_switch != b.foot_switch || a.armed != b.armed || a.interlock_closed != b.interlock_closed ||
         a.aiming != b.aiming || a.emitting != b.emitting || a.pulse != b.pulse || a.pulse_done != b.pulse_done ||
         a.reason != b.reason;
}

}  // namespace

SurgeonTaskAt holdPlace(const Eigen::Vector3d& place)
{
  return [place](double) {
    SurgeonTask task;
    task.target.position = place;
    return task;
  };
}

Eigen::Isometry3d manipulatorTWorld(const PlacementOptions& options)
{
  Eigen::Isometry3d manipulator_T_world = Eigen::Isometry3d::Identity();
  manipulator_T_world.translation() = kOffset;
  manipulator_T_world.rotate(Eigen::AngleAxisd(options.yaw_deg * kDegree, Eigen::Vector3d::UnitZ()));
  manipulator_T_world.rotate(Eigen::AngleAxisd(180.0 * kDegree, Eigen::Vector3d::UnitX()));
  return manipulator_T_world;
}

Hardware::Hardware(const HardwareOptions& options, SurgeonTaskAt task, messaging::Link& link, std::uint64_t seed)
    : link_(link),
      um_per_px_(simulation::umPerPx(options.camera, seed)),
      manipulator_T_world_(simulation::manipulatorTWorld(options.placement)),
      task_(std::move(task)),
      hand_(options.hand, task_(0.0).target.position, seed, kPeriod_s),
      retina_(options.motion, seed, middleOfView(options.camera, um_per_px_), kPeriod_s),
      controller_(options.controller, manipulator_T_world_, seed, kPeriod_s),
      laser_(options.laser, kPeriod_s),
      shutter_(options.camera, seed, kPeriod_s),
      port_at_rest_(hand_.state().null + options.placement.port_mm * 1e-3 * shaftAtStart(options.placement)),
      micron_commands_(std::in_place, link),
      laser_commands_(link),
      micron_states_(std::in_place, link),
      laser_states_(link)
{}

void Hardware::step(const ReceiveTime& now)
{
  truth_.t_s = static_cast<double>(steps_) * kPeriod_s;
  const SurgeonTask task = task_(truth_.t_s);
  moveHand(task);
  controller_.setPowered(!has(HardwareFault::power_off));
  controller_.step(held(), heardOn(*micron_commands_, now.monotonic));
  lookAround();
  fire(task.switches, now);
  expose(now);
  publish(now);
  ++steps_;
}

void Hardware::moveHand(const SurgeonTask& task)
{
  const RetinaPose& before = retina_.state().world_T_retina;
  const Eigen::Vector3d& null = hand_.state().null;
  const Eigen::Vector3d& tip = task.steers_null || steps_ == 0 ? null : controller_.tip();
  const SurgeonView view = {before.toWorld(task.target.position), before.rotation() * task.target.velocity, tip, null};
  truth_.hand = hand_.step(view, task.support);
  truth_.eye = retina_.step(truth_.hand);
  truth_.port = port_at_rest_ + Eigen::Vector3d(truth_.eye.port.x(), truth_.eye.port.y(), 0.0);
}

// The handle's shaft always goes through the port: the hand turns about it.
HeldManipulator Hardware::held() const
{
  return {truth_.hand.null, (truth_.port - truth_.hand.null).normalized(), truth_.eye.port};
}

void Hardware::lookAround()
{
  truth_.tip = controller_.tip();
  truth_.shaft = controller_.shaft();
  // The beam goes on along the shaft until it meets the surface; a tip within the retina lights where it is.
  const double surface = truth_.eye.world_T_retina.shift.z();
  const double way = std::max(0.0, (surface - truth_.tip.z()) / std::max(1e-3, -truth_.shaft.z()));
  truth_.spot = truth_.tip - way * truth_.shaft;
  truth_.pivot_error = controller_.pivotError();
  truth_.port_error = (truth_.port - truth_.tip).cross(truth_.shaft).norm();
  truth_.saturated = controller_.isSaturated();
  truth_.jerk = retina_.jerks().inProgress();
  truth_.jerked = retina_.jerks().ownWay() + retina_.jerks().toolWay();
}

void Hardware::fire(LaserSwitches switches, const ReceiveTime& now)
{
  if (has(HardwareFault::interlock_open)) switches.interlock_closed = false;
  const std::int64_t before = laser_.state().pulse_done ? 0 : laser_.state().pulse;
  const LaserState& state = laser_.step(switches, heardOn(laser_commands_, now.monotonic));
  truth_.aiming = state.aiming;
  truth_.emitting = state.emitting;
  const Eigen::Vector3d spot = truth_.spotRetina();
  if (state.emitting && before != state.pulse) {
    pulses_.push_back({state.pulse, state.target, truth_.t_s, 0.0, laser_.power(), spot, spot, spot});
    burns_map_.emplace_back();
    pulse_steps_ = 0.0;
  }
  if (!state.emitting && before == 0) return;
  PulseTruth& pulse = pulses_.back();
  pulse_steps_ += 1.0;
  pulse.spot_retina += (spot - pulse.spot_retina) / pulse_steps_;
  pulse.last_retina = spot;
  pulse.duration = state.pulse_duration;
  const Eigen::Vector3d place = pulse.spot_retina / (um_per_px_ * 1e-6);
  burns_map_.back() = {place.x(), place.y()};
}

void Hardware::expose(const ReceiveTime& now)
{
  shutter_.expose({truth_.eye.world_T_retina, truth_.tip, truth_.shaft, truth_.spot, truth_.aiming, truth_.emitting});
  truth_.picture = shutter_.picture();
  due_ = shutter_.due();
  if (!due_) return;
  due_->utime = now.utime - std::llround(1e6 * (truth_.t_s - due_->t_s));
  due_->burns_map = burns_map_;
  if (truth_.emitting) due_->burns_map.pop_back();
  due_->repeats = has(HardwareFault::camera_freezes);
  if (has(HardwareFault::camera_stops)) due_.reset();
}

std::optional<FrameDue> Hardware::frameDue() { return std::exchange(due_, std::nullopt); }

void Hardware::publish(const ReceiveTime& now)
{
  const std::int64_t utime = now.utime + (has(HardwareFault::clock_step) ? kClockStep_us : 0);
  if (!has(HardwareFault::states_stop)) publishMicron(utime);
  const bool due = steps_ % kLaserSteps == 0 || differs(laser_.state(), last_laser_);
  if (due && !has(HardwareFault::laser_silent)) publishLaser(utime);
}

void Hardware::publishMicron(std::int64_t utime)
{
  if (!has(HardwareFault::tip_not_finite)) {
    micron_states_->publish(controller_.state(), utime - controller_.stateAge_us(), utime);
    return;
  }
  micron_state_t message{};
  messaging::write(controller_.state(), message);
  message.utime = utime - controller_.stateAge_us();
  for (double& number : message.tip_position) number = std::numeric_limits<double>::quiet_NaN();
  micron_states_->publish(message, utime);
}

void Hardware::publishLaser(std::int64_t utime)
{
  last_laser_ = laser_.state();
  laser_states_.publish(last_laser_, utime, utime);
}

void Hardware::inject(HardwareFault fault)
{
  if (fault == HardwareFault::restart) return restart();
  faults_[static_cast<std::size_t>(fault)] = true;
}

void Hardware::mend(HardwareFault fault) { faults_[static_cast<std::size_t>(fault)] = false; }

void Hardware::restart()
{
  ++restarts_;
  micron_commands_.reset();
  micron_commands_.emplace(link_);
  micron_states_.emplace(link_, messaging::channelOf<micron_state_t>(), link_.session() + restarts_);
}

}  // namespace eyeslam::simulation
