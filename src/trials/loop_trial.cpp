// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/loop_trial.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "eyeslam/simulation/loop_period.h"
#include "eyeslam/trials/lock_step_time.h"

namespace eyeslam::trials {

using servo::ServoCycle;
using simulation::TrackedFrame;

namespace {

std::int64_t utimeOf(double t_s) { return kStart_us + std::llround(1e6 * t_s); }

servo::ViewPlacement placement(const LoopTrialSetting& setting, std::uint64_t seed)
{
  servo::ViewPlacement placed;
  const Eigen::Matrix<double, 2, 3> map = simulation::wrongRegistration(setting.registration, seed, placed.centre);
  placed.manipulator_T_view.linear().topLeftCorner<2, 2>() = map.leftCols<2>();
  placed.manipulator_T_view.translation().head<2>() = map.col(2);
  return placed;
}

/// One seed's world and servo, a millisecond a step.
class Bench {
 public:
  Bench(const LoopTrialSetting& setting, const LoopTask& task, std::uint64_t seed)
      : setting_(setting),
        task_(task),
        hand_(setting.hand, task.target(0.0).position, seed),
        retina_(setting.motion, seed),
        micron_(setting.micron, seed),
        tracker_(setting.camera, setting.tracker, setting.registration, seed, Eigen::Vector2d::Zero()),
        cycle_(setting.servo, placement(setting, seed)),
        judge_(setting.settling_s)
  {
    cycle_.setLead(micron_.lead());
  }

  LoopResult run()
  {
    const auto steps = std::llround((setting_.settling_s + setting_.duration_s) / simulation::kPeriod_s);
    for (std::int64_t i = 1; i <= steps; ++i) step(static_cast<double>(i) * simulation::kPeriod_s);
    static_cast<TipErrors&>(result_) = judge_.result();
    result_.refusals = cycle_.refusals();
    return std::move(result_);
  }

 private:
  void step(double t_s)
  {
    const simulation::PathTarget target = task_.target(t_s);
    const simulation::RetinaPose& before = retina_.state().world_T_retina;
    hand_.step({before.toWorld(target.position), before.rotation() * target.velocity, tip(), hand_.state().null},
               setting_.aided ? simulation::HandTremor::Support::fixture : simulation::HandTremor::Support::none);
    const simulation::RetinaState& eye = retina_.step(hand_.state());
    micron_.step(hand_.state().null, eye.port);
    tracker_.expose(t_s, eye.world_T_retina, micron_.tip());
    if (setting_.aided) steer(t_s, eye);
    judge(t_s, eye);
  }

  Eigen::Vector3d tip() const { return setting_.aided ? micron_.tip() : hand_.state().null; }

  void steer(double t_s, const simulation::RetinaState& eye)
  {
    servo::CycleInput input = heard(t_s);
    if (setting_.true_poses) {
      Eigen::Vector3d shift = eye.world_T_retina.toWorld(Eigen::Vector3d::Zero());
      shift.head<2>() += tracker_.picture();
      input.pose = servo::SeenPose{utimeOf(t_s), {shift.x(), shift.y(), eye.world_T_retina.theta, 1.0}, 0.0, 0.0};
    }
    const servo::Outlook& outlook = cycle_.observe(input);
    const Eigen::Vector3d last_goal = goal_;
    const servo::ServoCommand& command = cycle_.command(task_.fixture(outlook));
    goal_ = command.goal;
    if (goals_++ > 0)
      result_.highest_goal_speed =
          std::max(result_.highest_goal_speed, (goal_ - last_goal).norm() / simulation::kPeriod_s);
    if (setting_.servo.null_at == "controller") {
      micron_.commandTip(command.position);
    } else {
      micron_.commandDeflection(command.position);
    }
  }

  servo::CycleInput heard(double t_s)
  {
    servo::CycleInput input;
    input.now = utimeOf(t_s);
    const simulation::MicronReading& reading = micron_.state();
    if (reading.periods > 0) {
      servo::ManipulatorState state{utimeOf(static_cast<double>(reading.periods) * simulation::kPeriod_s), reading.null,
                                    reading.tip, std::nullopt};
      if (setting_.port_measured) state.port = reading.port;
      input.state = state;
    }
    if (const std::optional<TrackedFrame> frame = tracker_.ready(t_s)) {
      const std::int64_t utime = utimeOf(frame->mid_exposure_s);
      if (frame->tracked && !setting_.true_poses) input.pose = servo::SeenPose{utime, frame->view_T_retina, 0.0, 0.0};
      if (!frame->tracked || frame->outlier) judge_.spoilt(frame->mid_exposure_s);
      input.tip = servo::SeenTip{utime, tracker_.exposure(), frame->tip, 0.0};
    }
    return input;
  }

  void judge(double t_s, const simulation::RetinaState& eye)
  {
    const Eigen::Vector3d tip_retina = eye.world_T_retina.toRetina(tip());
    const double error = task_.error(tip_retina, t_s);
    const simulation::EyeJerks& jerks = retina_.jerks();
    judge_.step({t_s, tip_retina, error, jerks.inProgress(), jerks.ownWay() + jerks.toolWay(), micron_.isSaturated()});
  }

  const LoopTrialSetting& setting_;
  const LoopTask& task_;
  simulation::Hand hand_;
  simulation::RetinaMotion retina_;
  simulation::MicronModel micron_;
  simulation::TrackerModel tracker_;
  ServoCycle cycle_;
  TipJudge judge_;
  Eigen::Vector3d goal_ = Eigen::Vector3d::Zero();
  std::int64_t goals_ = 0;
  LoopResult result_;
};

}  // namespace

Eigen::Vector3d workingPlace() { return {0.8e-3, -0.6e-3, 0.0}; }

LoopTask holdTask(const Eigen::Vector3d& place)
{
  return {[place](double) {
            return simulation::PathTarget{place, Eigen::Vector3d::Zero()};
          },
          [place](const servo::Outlook&) { return place; },
          [place](const Eigen::Vector3d& tip_retina, double) { return (tip_retina - place).head<2>().norm(); }};
}

LoopResult runLoopTrial(const LoopTrialSetting& setting, const LoopTask& task, std::uint64_t seed)
{
  return Bench(setting, task, seed).run();
}

}  // namespace eyeslam::trials
