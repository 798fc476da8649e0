// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/trial_world.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "eyeslam/configuration/listing.h"
#include "eyeslam/simulation/hardware_fault.h"
#include "eyeslam/trials/trial_marks.h"

namespace eyeslam::trials {

namespace {

constexpr double kLatest_s = 40.0;     // what never began by then, settling and mapping apart, begins no more
constexpr double kAfterwards_s = 0.3;  // that a log shows of what comes after the last burn

}  // namespace

std::string TrialName::json() const
{
  return nlohmann::ordered_json{{"scenario", scenario}, {"variant", variant}, {"seed", seed}}.dump();
}

std::optional<TrialName> TrialName::parse(const std::string& note)
{
  const auto json = nlohmann::json::parse(note, nullptr, false);
  if (!json.is_object() || !json.contains("scenario") || !json.contains("seed")) return std::nullopt;
  try {
    return TrialName{json.at("scenario").get<std::string>(), json.value("variant", ""),
                     json.at("seed").get<std::uint64_t>()};
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

TrialWorld::TrialWorld(const TrialSetting& setting, const TrialName& name, const std::string& version,
                       const TrialScene& scene, messaging::Link& link)
    : setting_(setting),
      scene_(scene),
      name_(name),
      version_(version),
      marks_(link),
      surgeon_(setting, scene, link),
      hardware_(
          setting.hardware, [this](double t_s) { return surgeon_.task(t_s); }, link, name.seed),
      truths_(link, hardware_.umPerPx())
{
  if (needsVision()) {
    operator_.emplace(setting, scene, link);
    return;
  }
  hardware_.inject(simulation::HardwareFault::power_off);  // the bare hand
  if (setting.scenario.isLaser()) manual_.emplace(setting, scene, link);
}

std::optional<simulation::FrameDue> TrialWorld::advance(const messaging::ReceiveTime& now)
{
  if (!started_) mark(mark_t::START, name_.json(), now.utime);
  started_ = true;
  breakThings();
  hardware_.step(now);
  std::optional<simulation::FrameDue> due = hardware_.frameDue();
  if (due) truths_.expose(*due);
  return due;
}

void TrialWorld::tellTruth(const messaging::ReceiveTime& now) { truths_.publish(hardware_.truth(), now.utime); }

void TrialWorld::act(const messaging::ReceiveTime& now)
{
  if (operator_) operator_->step(time(), now);
  aim();
  if (manual_) manual_->step(hardware_.truth().spotRetina().head<2>(), now);
  decide(now);
}

// Over a pattern he keeps the beam of the instrument at rest in its middle.
void TrialWorld::aim()
{
  if (!setting_.scenario.isLaser()) return;
  const Eigen::Vector3d spot_from_tip = hardware_.truth().spotRetina() - hardware_.truth().tipRetina();
  surgeon_.aimAt(manual_ ? manual_->target() : Eigen::Vector2d(scene_.middle().head<2>()), spot_from_tip.head<2>());
}

// When what counts begins and ends.
void TrialWorld::decide(const messaging::ReceiveTime& now)
{
  const Scenario& scenario = setting_.scenario;
  const double settling = scenario.isLaser() ? 0.0 : scenario.settling_s;
  const bool begins = operator_ ? operator_->asked() && time() >= operator_->askedAt() + settling : time() >= settling;
  if (!counts_s_ && begins) {
    counts_s_ = time();
    mark(mark_t::NOTE, kCountsFromHere, now.utime);
  }
  const bool done = manual_ ? manual_->done() : operator_ && operator_->planDone();
  if (!done_s_ && done && scenario.isLaser()) done_s_ = time();
  if (isOver()) mark(mark_t::STOP, counts_s_ ? "" : kNeverBegan, now.utime);
}

bool TrialWorld::isOver() const
{
  const Scenario& scenario = setting_.scenario;
  if (!counts_s_) return time() >= kLatest_s + scenario.settling_s + (scenario.isLaser() ? scenario.laser.map_s : 0.0);
  const double end = *counts_s_ + scenario.duration_s;
  return time() >= (done_s_ ? std::min(end, *done_s_ + kAfterwards_s) : end);
}

void TrialWorld::breakThings()
{
  const ScenarioFaultOptions& fault = setting_.scenario.fault;
  if (fault.kind == "none" || !counts_s_) return;
  const double since = time() - *counts_s_ - fault.at_s;
  const bool broken = since >= 0.0 && since < fault.for_s;
  if (broken == broken_) return;
  broken_ = broken;
  setFault(broken);
}

void TrialWorld::setFault(bool broken)
{
  const std::string& kind = setting_.scenario.fault.kind;
  if (kind == "motion") return;  // the eye does it by itself
  if (kind == "operator_lost") return operator_->setLinked(!broken);
  if (kind == "blackout" || kind == "tool_over_everything") {
    const Obstruction kinds = kind == "blackout" ? Obstruction::dark : Obstruction::covered;
    obstruction_ = broken ? kinds : Obstruction::none;
    return;
  }
  const simulation::HardwareFault fault = simulation::hardwareFault(kind);
  broken ? hardware_.inject(fault) : hardware_.mend(fault);
}

void TrialWorld::mark(std::int16_t kind, const std::string& note, std::int64_t utime)
{
  mark_t message{};
  message.utime = utime;
  message.kind = kind;
  message.sender = "eyeslam-trial";
  message.version = version_;
  message.note = note;
  if (kind == mark_t::START) {
    message.configuration = configuration::yamlOf(setting_, configuration::YamlComments::left_out);
    message.configuration_hash = configuration::hashOf(setting_);
  }
  marks_.publish(message, utime);
}

}  // namespace eyeslam::trials
