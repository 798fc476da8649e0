// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/manual_laser.h"

#include <cmath>
#include <numeric>

#include "eyeslam/fixtures/burn_order.h"
#include "eyeslam/retina/units.h"
#include "eyeslam/servo/plan_messages.h"
#include "eyeslam/trials/lock_step_time.h"

namespace eyeslam::trials {

namespace {

// The error, with its direction, is a mean over it (loop study, 1): 0.72 burns a second in situ, as in the study; a
// mean of distances, to which tremor adds, gives 0.42.
constexpr std::size_t kSeenOver_ms = 100;
constexpr std::int16_t kDone = 1;  // burn_target_t

fixtures::BurnPlan planOnTruth(const TrialSetting& setting, const TrialScene& scene)
{
  const Eigen::Vector2d middle = scene.middle().head<2>() / (1e-6 * scene.umPerPx());
  return fixtures::orderedPlan(scene.trueMap(), prescriptionAbout(setting, middle));
}

}  // namespace

ManualLaser::ManualLaser(const TrialSetting& setting, const TrialScene& scene, messaging::Link& link)
    : options_(setting.scenario.laser),
      reaction_(static_cast<std::size_t>(setting.hardware.hand.surgeon.reaction_ms)),
      m_per_px_(1e-6 * scene.umPerPx()),
      plan_(servo::planMessage(planOnTruth(setting, scene), link.session())),
      commands_(link),
      plans_(link)
{
  plan_.state = burn_plan_t::IN_FORCE;
  for (std::size_t i = 0; i < plan_.target.size(); ++i)
    if (plan_.target[i].state == 0) order_.push_back(i);
}

Eigen::Vector2d ManualLaser::placeOf(std::size_t index) const
{
  return m_per_px_ * Eigen::Vector2d(plan_.target[index].x_px, plan_.target[index].y_px);
}

Eigen::Vector2d ManualLaser::target() const
{
  return order_.empty() ? Eigen::Vector2d::Zero() : placeOf(order_[std::min(current_, order_.size() - 1)]);
}

// What he sees is a reaction old, and a mean over a moment.
bool ManualLaser::decides(const Eigen::Vector2d& spot)
{
  errors_.push_back(spot - target());
  if (errors_.size() <= reaction_ + kSeenOver_ms) return false;
  errors_.pop_front();
  const auto end = errors_.begin() + static_cast<std::ptrdiff_t>(kSeenOver_ms);
  const Eigen::Vector2d sum = std::accumulate(errors_.begin(), end, Eigen::Vector2d(0.0, 0.0));
  return sum.norm() / static_cast<double>(kSeenOver_ms) < 1e-6 * options_.manual_within_um;
}

void ManualLaser::step(const Eigen::Vector2d& spot, const messaging::ReceiveTime& now)
{
  publishPlan(now.utime);
  if (done()) return;
  burn_target_t& target = plan_.target[order_[current_]];
  messaging::LaserCommand command;
  command.action = messaging::LaserAction::aim;
  if (firing_ == 0 && !until_fire_ && decides(spot)) until_fire_ = static_cast<int>(options_.manual_delay_ms);
  if (until_fire_ && --*until_fire_ <= 0) {
    until_fire_.reset();
    firing_ = static_cast<int>(std::ceil(target.duration / kMilli)) + 2;  // on its way there and back
    ++pulse_;
  }
  if (firing_ > 0) {
    command = {0, messaging::LaserAction::fire, target.id, pulse_, target.duration, target.power, command.expiry};
    if (--firing_ == 0) {
      target.state = kDone;
      changed_ = true;
      errors_.clear();
      ++current_;
    }
  }
  commands_.publish(command, now.utime, now.utime);
}

void ManualLaser::publishPlan(std::int64_t utime)
{
  if (periods_++ % kPlanPeriods != 0 && !changed_) return;
  changed_ = false;
  plan_.utime = utime;
  plans_.publish(plan_, utime);
}

}  // namespace eyeslam::trials
