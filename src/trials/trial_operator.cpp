// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/trial_operator.h"

#include <algorithm>
#include <iterator>

#include "eyeslam/fixtures/burn_order.h"
#include "eyeslam/servo/plan_messages.h"
#include "eyeslam/simulation/eye_camera_options.h"
#include "eyeslam/trials/lock_step_time.h"

namespace eyeslam::trials {

using messaging::FixtureKind;
using messaging::ServoState;
using messaging::WantedMode;

namespace {

constexpr std::int64_t kWishPeriods = 50;         // 20 Hz (contracts, section 4)
constexpr double kEvaluated_s = 2.0;              // after its sweep a calibration is there, or comes no more
constexpr double kPause_s = 0.5;                  // until the servo has heard that he wants none
constexpr double kLooks_s = 1.5;                  // at the map, before he chooses
constexpr double kRearm_s = 1.0;                  // until he has understood that the servo holds
constexpr std::int64_t kSession = 1'000'000'000;  // apart from the servo's, whose channel he shares
constexpr int kPending = 0;                       // burn_target_t

Eigen::Vector2d imageCentre(const TrialSetting& setting)
{
  const cv::Point2d centre = simulation::imageCentre(setting.hardware.camera);
  return {centre.x, centre.y};
}

// Tremor alone is told from motion without any camera.
bool needsCamera(const Scenario& scenario) { return scenario.aid != "filter"; }

FixtureKind fixtureKind(const Scenario& scenario)
{
  if (scenario.aid == "filter") return FixtureKind::filter;
  if (scenario.aid == "scaling") return FixtureKind::scaling;
  if (scenario.task == "trace") return FixtureKind::vessel;
  if (scenario.task == "standoff") return FixtureKind::standoff;
  return scenario.task == "hold" ? FixtureKind::point : FixtureKind::none;
}

}  // namespace

TrialOperator::TrialOperator(const TrialSetting& setting, const TrialScene& scene, messaging::Link& link)
    : setting_(setting),
      scene_(scene),
      truths_(imageCentre(setting), link),
      tiles_(link, [this](const vessel_map_t& tile, const messaging::MessageHeader&) { maps_.add(tile); }),
      registrations_(link),
      statuses_(link),
      heard_plans_(link,
                   [this](const burn_plan_t& plan, const messaging::MessageHeader&) {
                     if (plan.state == burn_plan_t::IN_FORCE) in_force_ = plan;
                   }),
      wishes_(link, messaging::channelOf<operator_t>(), link.session() + kSession),
      plans_(link, messaging::channelOf<burn_plan_t>(), link.session() + kSession)
{
  fixture_.kind = FixtureKind::calibration;
}

void TrialOperator::step(double t_s, const messaging::ReceiveTime& now)
{
  if (!linked_) return;
  goOn(t_s, now.utime);
  rearm(t_s);
  if (periods_ % kWishPeriods == 0) wishes_.publish(wish(), now.utime, now.utime);
  if (periods_ % kPlanPeriods == 0 && plan_.targets > 0) plans_.publish(plan_, now.utime);
  ++periods_;
}

// First a calibration where the camera is needed, then what the trial is about.
void TrialOperator::goOn(double t_s, std::int64_t utime)
{
  const messaging::PublishedRegistration* camera = registrations_.latest();
  if (phase_ == Phase::ready && t_s >= ready_until_s_) {
    phase_ = needsCamera(setting_.scenario) ? Phase::calibrates : Phase::waits;
    calibrates_from_s_ = t_s;
  }
  if (phase_ == Phase::calibrates && camera && camera->valid) {
    phase_ = Phase::waits;
    waits_from_s_ = t_s;
  }
  if (phase_ == Phase::calibrates && t_s >= calibrates_from_s_ + setting_.servo.sweep.duration_s + kEvaluated_s) {
    phase_ = Phase::ready;  // too few frames, or the servo held meanwhile: once more
    ready_until_s_ = t_s + kPause_s;
  }
  if (phase_ == Phase::waits && t_s >= waits_from_s_ + kLooks_s) choose(t_s, utime);
}

void TrialOperator::choose(double t_s, std::int64_t utime)
{
  const Scenario& scenario = setting_.scenario;
  if (scenario.isLaser()) {
    if (t_s < scenario.laser.map_s || !plan(utime)) return;
  } else {
    if (needsCamera(scenario) && !point(scene_.pointedAt().head<2>())) return;
    fixture_.kind = fixtureKind(scenario);
    if (fixture_.kind != FixtureKind::point && fixture_.kind != FixtureKind::vessel) fixture_.point_px.setZero();
    if (scenario.aid == "soft") fixture_.lambda = scenario.lambda;
    if (fixture_.kind == FixtureKind::standoff) fixture_.standoff = 1e-6 * scenario.standoff_um;
  }
  phase_ = Phase::guided;
  asked_s_ = t_s;
}

bool TrialOperator::point(const Eigen::Vector2d& place)
{
  const std::optional<Eigen::Vector2d> seen = truths_.seenAt(place);
  if (seen) fixture_.point_px = *seen;
  return seen.has_value();
}

// On the map as he has it, about the middle of the view at the start.
bool TrialOperator::plan(std::int64_t utime)
{
  const std::optional<Eigen::Vector2d> middle = truths_.seenAt(scene_.middle().head<2>());
  retina::VesselMap map = maps_.map();
  map.um_per_px = registrations_.latest()->um_per_px;
  if (!middle || !maps_.isComplete() || !(map.um_per_px > 0.0)) return false;
  plan_ = servo::planMessage(fixtures::orderedPlan(map, prescriptionAbout(setting_, *middle)), maps_.mapId());
  plan_.state = burn_plan_t::PROPOSED;
  plan_.utime = utime;
  fixture_ = {};
  return true;
}

void TrialOperator::rearm(double t_s)
{
  const messaging::ServoStatus* status = statuses_.latest();
  const bool stands = status && (status->state == ServoState::hold || status->state == ServoState::fault);
  const bool goes_on = phase_ != Phase::guided || setting_.scenario.fault.must == "go_on";
  if (!stands || !goes_on) {
    held_s_.reset();
    return;
  }
  if (!held_s_) held_s_ = t_s;
  if (t_s - *held_s_ < kRearm_s) return;
  ++rearmed_;
  held_s_.reset();
}

messaging::OperatorWish TrialOperator::wish() const
{
  messaging::OperatorWish wish;
  const bool works = phase_ == Phase::calibrates || phase_ == Phase::guided;
  wish.mode = works ? WantedMode::assist : WantedMode::ready;
  wish.rearmed = rearmed_;
  wish.map_id = truths_.mapId();
  if (works) wish.fixture = fixture_;
  if (phase_ != Phase::guided || !setting_.scenario.isLaser()) return wish;
  wish.mode = WantedMode::laser;
  wish.arm = wish.plan_approved = true;
  std::copy(std::begin(plan_.hash), std::end(plan_.hash), wish.plan_hash.begin());
  return wish;
}

bool TrialOperator::planDone() const
{
  return in_force_.targets > 0 && std::none_of(in_force_.target.begin(), in_force_.target.end(),
                                               [](const burn_target_t& target) { return target.state == kPending; });
}

}  // namespace eyeslam::trials
