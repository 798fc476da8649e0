// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/trial.h"

#include <utility>

#include "eyeslam/trials/lock_step_time.h"

namespace eyeslam::trials {

namespace {

std::int64_t sessionOf(const TrialName& name) { return static_cast<std::int64_t>(name.seed) + 1; }

}  // namespace

Trial::Trial(const TrialSetting& setting, const TrialName& name, const std::string& version, const TrialScene& scene,
             Each each)
    : link_("memq://", sessionOf(name), std::nullopt),
      tap_(link_,
           [each = std::move(each)](const messaging::TappedEvent& event) {
             each({event.number, event.utime, event.channel, event.data, event.size});
           }),
      world_(setting, name, version, scene, link_)
{
  if (!world_.needsVision()) return;
  vision_.emplace(setting.vision, scene.camera(), scene.fundus(), link_, name.seed);
  servo_.emplace(setting, link_);
}

bool Trial::step()
{
  const std::int64_t utime = kStart_us + steps_++ * kPeriod_us;
  const messaging::ReceiveTime now{utime, utime};
  tap_.setTime(utime);
  frame_ = nullptr;
  if (const auto due = world_.advance(now); due && vision_) look(*due);
  world_.tellTruth(now);
  if (vision_) vision_->step(now);
  world_.act(now);
  link_.drain(now);
  if (servo_) servo_->cycle(now);
  link_.drain(now);
  return !world_.isOver();
}

void Trial::look(const simulation::FrameDue& due)
{
  vision_->setObstruction(world_.obstruction());
  vision_->look(due);
  frame_ = &vision_->image();
}

}  // namespace eyeslam::trials
