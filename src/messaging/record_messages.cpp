// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/record_messages.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/messaging/field_copy.h"

namespace eyeslam::messaging {
namespace {

using retina::Reason;

constexpr std::int64_t kHeaderBytes = 4 * 8;

bool isFinite(const burn_target_t& target)
{
  return std::isfinite(target.x_px) && std::isfinite(target.y_px) && std::isfinite(target.spot_um) &&
         std::isfinite(target.burn_um) && std::isfinite(target.duration) && std::isfinite(target.power) &&
         std::isfinite(target.clearance_um);
}

bool isPossible(const burn_target_t& target)
{
  return target.id >= 0 && target.state >= 0 && target.state <= burn_target_t::REFUSED && target.reason >= 0 &&
         target.tile >= 0 && std::abs(target.x_px) <= kImage_px.highest && std::abs(target.y_px) <= kImage_px.highest &&
         target.spot_um > 0.0 && target.burn_um >= target.spot_um && target.duration > 0.0 && target.duration <= 1.0 &&
         target.power >= 0.0 && target.power <= 10.0;
}

}  // namespace

bool Conversion<burn_plan_t>::hasItsLengths(ByteWalk walk)
{
  constexpr std::int64_t kBeforeTargets = kHeaderBytes + 2 + 32 + 32 + 8 + 3 * 8;
  constexpr std::int64_t kTargetBytes = 4 + 2 + 2 + 4 + 7 * 8;
  std::int64_t targets = 0;
  walk.fields(kBeforeTargets).count(targets, 0, kMostTargets);
  return walk.fields(targets * kTargetBytes).isAtEnd();
}

Reason Conversion<burn_plan_t>::read(const burn_plan_t& message, burn_plan_t& plan)
{
  const std::vector<burn_target_t>& targets = message.target;
  const auto last = targets.begin() + message.targets;
  const bool finite = std::isfinite(message.um_per_px) && std::isfinite(message.margin_um) &&
                      std::isfinite(message.localization_um) && std::all_of(targets.begin(), last, isFinite);
  if (!finite) return Reason::not_finite;
  const bool possible = message.state >= 0 && message.state <= burn_plan_t::IN_FORCE && message.um_per_px > 0.0 &&
                        message.um_per_px <= kUmPerPx.highest && message.margin_um >= 0.0 &&
                        message.localization_um >= 0.0 && std::all_of(targets.begin(), last, isPossible);
  if (!possible) return Reason::out_of_range;
  plan = message;
  plan.target.resize(static_cast<std::size_t>(plan.targets));  // without targets the decoder leaves the last ones
  return Reason::none;
}

bool Conversion<mark_t>::hasItsLengths(ByteWalk walk)
{
  constexpr std::int64_t kLine = 256, kPage = 1 << 16;
  walk.fields(kHeaderBytes + 2).text(kLine).text(kLine).text(kPage).text(kLine).text(kPage);
  return walk.isAtEnd();
}

Reason Conversion<mark_t>::read(const mark_t& message, mark_t& mark)
{
  if (message.kind < 0 || message.kind > mark_t::NOTE) return Reason::out_of_range;
  mark = message;
  return Reason::none;
}

}  // namespace eyeslam::messaging
