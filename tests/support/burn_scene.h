// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "eyeslam/fixtures/burn_plan.h"
#include "eyeslam/messaging/laser_messages.h"
#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/servo/burn_run.h"
#include "eyeslam/servo/plan_messages.h"
#include "eyeslam/servo/preparation.h"

namespace eyeslam::support {

constexpr std::int64_t kBurnStart = 1'700'000'000'000'000;
constexpr std::int64_t kMap = 77;

/// Targets on a line, 300 um apart, all allowed; 5 um per px.
inline fixtures::BurnPlan linePlan(int targets, double um_per_px = 5.0)
{
  fixtures::BurnPlan plan;
  plan.um_per_px = um_per_px;
  for (int i = 0; i < targets; ++i) {
    fixtures::BurnTarget target;
    target.id = 10 + i;
    target.position_px = {300.0 / um_per_px * i, 20.0};
    target.spot_um = target.burn_um = 100.0;
    target.duration_ms = 20.0;
    target.power_mw = 150.0;
    target.clearance_um = 500.0;
    plan.targets.push_back(target);
  }
  return plan;
}

/// What a desk makes of a plan on a map that allows all of it.
inline std::shared_ptr<servo::Preparation> preparedFor(const fixtures::BurnPlan& plan)
{
  auto prepared = std::make_shared<servo::Preparation>();
  prepared->map_id = kMap;
  prepared->um_per_px = plan.um_per_px;
  const burn_plan_t message = servo::planMessage(plan, kMap);
  prepared->proposed = {std::make_shared<const fixtures::BurnPlan>(servo::planOf(message)), servo::planHash(message),
                        kMap, std::make_shared<const burn_plan_t>(message)};
  prepared->plan_reason = retina::Reason::none;
  for (const fixtures::BurnTarget& target : plan.targets) {
    prepared->verdicts.push_back({target.reason, 1e-6 * target.clearance_um});
  }
  return prepared;
}

/// A laser as the contract has it: obeys a held command, one pulse a number, and says so a millisecond later.
class SimpleLaser {
 public:
  void step(const messaging::LaserCommand& command, double dt)
  {
    using messaging::LaserAction;
    const bool fires =
        command.action == LaserAction::fire && state.foot_switch && state.armed && state.interlock_closed && !refuses;
    state.aiming = command.action != LaserAction::off;
    if (fires && command.pulse != state.pulse) {
      state.pulse = command.pulse;
      state.target = command.target;
      state.pulse_done = false;
      state.pulse_duration = 0.0;
      state.emitting = true;
      asked_ = command.duration;
      pulses.push_back(command.target);
    }
    if (!state.emitting) return;
    if (fires) state.pulse_duration = std::min(asked_, state.pulse_duration + dt);
    if (!fires || state.pulse_duration >= asked_ - 1e-9) {
      state.emitting = false;
      state.pulse_done = true;
    }
  }

  messaging::LaserState state;
  bool refuses = false;
  std::vector<int> pulses;  ///< targets, in the order of their pulses

 private:
  double asked_ = 0.0;
};

/// The world in which everything is as it should be: a tip that follows its goal at once, a spot that is seen, a frame
/// every 33 ms that comes 15 ms late. Tests change `change` to open one interlock.
class BurnScene {
 public:
  explicit BurnScene(const fixtures::BurnPlan& plan, const servo::BurnRunOptions& options = {})
      : run(std::make_unique<servo::BurnRun>(options)), prepared(preparedFor(plan))
  {
    wish.arm = wish.plan_approved = true;
    wish.plan_hash = prepared->proposed.hash;
    wish.map_id = kMap;
    laser.state.foot_switch = laser.state.armed = laser.state.interlock_closed = true;
    shaft_ = Eigen::Vector3d(0.5, 0.1, 0.85).normalized();
    tip_ = Eigen::Vector3d(0.0, 0.0, -1.2e-3);
  }

  /// One millisecond. @param change  of the input, before the run sees it
  template <class Change>
  const servo::BurnOutput& step(const Change& change)
  {
    now += 1000;
    see();
    servo::BurnInput input = this->input();
    change(input);
    const servo::BurnOutput& output = run->step(input);
    if (output.goal) tip_ = *output.goal;
    laser.step(output.command, 1e-3);
    return output;
  }
  const servo::BurnOutput& step()
  {
    return step([](servo::BurnInput&) {});
  }
  void run_ms(int milliseconds)
  {
    for (int i = 0; i < milliseconds; ++i) step();
  }

  servo::BurnInput input() const
  {
    servo::BurnInput in;
    in.now = now;
    in.step_s = 1e-3;
    in.laser_state = true;
    in.wish = &wish;
    in.operator_age = 0.02;
    in.laser = &laser.state;
    in.laser_age = 1e-3;
    in.preparation = prepared.get();
    in.map_id = kMap;
    in.registered = in.tracked = true;
    in.view.centre = {5e-3, 5e-3};
    in.view.view_T_retina.x = in.view.view_T_retina.y = 2e-3;
    in.view_size = 2.0 * in.view.centre;
    in.um_per_px = prepared->um_per_px;
    in.pose_utime = frame_utime_;
    in.pose_age = 1e-6 * static_cast<double>(now - frame_utime_);
    in.since_pose = in.pose_age - 1e-6 * kLatency_us;
    in.pose_error = 5e-6;
    in.innovation = 3e-6;
    in.since_jump = 10.0;
    in.retina_speed = 1e-3;
    in.tip = tip_;
    in.shaft = shaft_;
    in.tip_utime = now - 1000;
    in.null = {300e-6, 100e-6, -1e-3};
    in.reach = 2e-3;
    in.reach_left = 1e-3;
    in.sight_utime = frame_utime_;
    in.spot = spot_;
    return in;
  }
  Eigen::Vector2d spotNow() const { return tip_.head<2>() - shaft_.head<2>() / shaft_.z() * tip_.z() + spot_offset; }

  std::unique_ptr<servo::BurnRun> run;
  std::shared_ptr<servo::Preparation> prepared;
  messaging::OperatorWish wish;
  SimpleLaser laser;
  std::int64_t now = kBurnStart;
  Eigen::Vector2d spot_offset = Eigen::Vector2d::Zero();  ///< of the true spot from the one that tip and shaft give

 private:
  static constexpr std::int64_t kFrame_us = 33'000;
  static constexpr std::int64_t kLatency_us = 15'000;

  void see()
  {
    const std::int64_t exposed = (now - kBurnStart) / kFrame_us * kFrame_us + kBurnStart;
    if (exposed != exposed_utime_) {
      exposed_utime_ = exposed;
      exposed_spot_ = spotNow();
    }
    if (now - exposed_utime_ >= kLatency_us && frame_utime_ != exposed_utime_) {
      frame_utime_ = exposed_utime_;
      spot_ = exposed_spot_;
    }
  }

  Eigen::Vector3d tip_, shaft_;
  std::int64_t frame_utime_ = 0, exposed_utime_ = 0;
  Eigen::Vector2d exposed_spot_ = Eigen::Vector2d::Zero();
  std::optional<Eigen::Vector2d> spot_;
};

}  // namespace eyeslam::support
