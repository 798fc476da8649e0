// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/trial_surgeon.h"

namespace eyeslam::trials {

using messaging::FixtureKind;
using messaging::ServoState;
using simulation::SurgeonTask;

namespace {

// What a hand can lean on.
bool holdsTheTip(const Scenario& scenario) { return scenario.aid == "soft" || scenario.aid == "hard"; }

}  // namespace

TrialSurgeon::TrialSurgeon(const TrialSetting& setting, const TrialScene& scene, messaging::Link& link)
    : setting_(setting), scene_(scene), wishes_(link), statuses_(link)
{
  if (scene.path().size() > 1) path_.emplace(scene.path(), 1e-3 * setting.scenario.speed_mm_s);
}

bool TrialSurgeon::isAided() const
{
  const messaging::OperatorWish* wish = wishes_.latest();
  const messaging::ServoStatus* status = statuses_.latest();
  if (!wish || !status || wish->fixture.kind == FixtureKind::calibration) return false;
  return status->state == ServoState::assist || status->state == ServoState::laser;
}

void TrialSurgeon::aimAt(const Eigen::Vector2d& target, const Eigen::Vector2d& spot_from_tip)
{
  const Eigen::Vector2d tip = target - spot_from_tip;
  aim_ = Eigen::Vector3d(tip.x(), tip.y(), scene_.path().front().z());
}

SurgeonTask TrialSurgeon::task(double t_s)
{
  using Support = simulation::HandTremor::Support;
  const Scenario& scenario = setting_.scenario;
  const bool aided = isAided();
  if (!began_s_ && (aided || scenario.isManual())) began_s_ = t_s;
  SurgeonTask task;
  task.target = {scene_.path().front(), Eigen::Vector3d::Zero()};
  if (began_s_ && path_) task.target = path_->at(t_s - *began_s_);
  if (aim_) task.target.position = *aim_;
  // While the tip sweeps, or goes from target to target, he looks at the handle.
  task.steers_null = !began_s_ || scenario.aid == "automated";
  task.support = aided && holdsTheTip(scenario) ? Support::fixture : Support::none;
  task.switches.foot_switch = scenario.isManual() || aided;
  return task;
}

}  // namespace eyeslam::trials
