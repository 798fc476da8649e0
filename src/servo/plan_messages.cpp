// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/plan_messages.h"

#include <algorithm>
#include <string>
#include <type_traits>

#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/retina/sha256.h"
#include "eyeslam/retina/units.h"

namespace eyeslam::servo {
namespace {

using fixtures::BurnPlan;
using fixtures::BurnTarget;
using retina::Reason;

void add(retina::Sha256& sha, const burn_target_t& target)
{
  sha.addNumber(static_cast<std::uint32_t>(target.id));
  sha.addNumber(static_cast<std::uint32_t>(target.tile));
  for (const double number :
       {target.x_px, target.y_px, target.spot_um, target.burn_um, target.duration, target.power}) {
    sha.addDouble(number);
  }
  sha.addNumber(static_cast<std::uint8_t>(target.state == burn_target_t::REFUSED));
}

burn_target_t messageOf(const BurnTarget& target)
{
  burn_target_t message{};
  message.id = target.id;
  message.state = target.valid() ? burn_target_t::PENDING : burn_target_t::REFUSED;
  message.reason = static_cast<std::int16_t>(target.reason);
  message.tile = target.tile;
  message.x_px = target.position_px.x();
  message.y_px = target.position_px.y();
  message.spot_um = target.spot_um;
  message.burn_um = target.burn_um;
  message.duration = target.duration_ms / kPerMilli;
  message.power = target.power_mw / kPerMilli;
  message.clearance_um = target.clearance_um;
  return message;
}

BurnTarget targetOf(const burn_target_t& message)
{
  BurnTarget target;
  target.id = message.id;
  target.position_px = {message.x_px, message.y_px};
  target.spot_um = message.spot_um;
  target.burn_um = message.burn_um;
  target.duration_ms = message.duration * kPerMilli;
  target.power_mw = message.power * kPerMilli;
  target.tile = message.tile;
  target.clearance_um = message.clearance_um;
  if (message.state == burn_target_t::REFUSED) {
    target.reason = message.reason == 0 ? Reason::target_invalid : static_cast<Reason>(message.reason);
  }
  return target;
}

}  // namespace

messaging::Hash planHash(const burn_plan_t& plan)
{
  retina::Sha256 sha;
  for (const double number : {plan.um_per_px, plan.margin_um, plan.localization_um}) sha.addDouble(number);
  sha.addNumber(static_cast<std::uint64_t>(plan.map_id));
  sha.add(plan.map_hash, std::extent_v<decltype(plan.map_hash)>);
  sha.addNumber(static_cast<std::uint32_t>(plan.target.size()));
  for (const burn_target_t& target : plan.target) add(sha, target);
  return sha.digest();
}

burn_plan_t planMessage(const BurnPlan& plan, std::int64_t map_id)
{
  if (plan.targets.size() > static_cast<std::size_t>(messaging::kMostTargets)) {
    throw fixtures::PlanError("targets: more than " + std::to_string(messaging::kMostTargets) +
                              " in one plan; cut it in parts");
  }
  burn_plan_t message{};
  message.state = burn_plan_t::PROPOSED;
  message.map_id = map_id;
  message.um_per_px = plan.um_per_px;
  message.margin_um = plan.prescription.safety.margin_um;
  message.localization_um = plan.prescription.safety.localization_um;
  const retina::Sha256::Digest map = retina::digestOf(plan.map.hash);
  std::copy(map.begin(), map.end(), message.map_hash);
  for (const BurnTarget& target : plan.targets) message.target.push_back(messageOf(target));
  message.targets = static_cast<std::int32_t>(message.target.size());
  const messaging::Hash hash = planHash(message);
  std::copy(hash.begin(), hash.end(), message.hash);
  burn_plan_t read{};
  if (messaging::read(message, read) != Reason::none) {
    throw fixtures::PlanError("targets: a number is not finite or out of the range of burn_plan_t");
  }
  return message;
}

BurnPlan planOf(const burn_plan_t& message)
{
  BurnPlan plan;
  plan.um_per_px = message.um_per_px;
  plan.prescription.safety.margin_um = message.margin_um;
  plan.prescription.safety.localization_um = message.localization_um;
  retina::Sha256::Digest map{};
  std::copy(std::begin(message.map_hash), std::end(message.map_hash), map.begin());
  plan.map.hash = retina::hexOf(map);
  for (const burn_target_t& target : message.target) plan.targets.push_back(targetOf(target));
  return plan;
}

}  // namespace eyeslam::servo
