// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/burn_ledger.h"

#include <algorithm>

namespace eyeslam::servo {

using retina::Reason;

void BurnLedger::open(const ProposedPlan& proposed) noexcept
{
  open_ = proposed.message != nullptr;
  hash_ = proposed.hash;
  count_ = open_ ? std::min(proposed.message->target.size(), records_.size()) : 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const burn_target_t& target = proposed.message->target[i];
    records_[i] = {static_cast<Fate>(target.state), static_cast<Reason>(target.reason), 0.0, 0};
    if (records_[i].fate == Fate::done) remember(proposed.map_id, {target.x_px, target.y_px});
  }
  ++changes_;
}

void BurnLedger::countAttempt(std::size_t index) noexcept
{
  if (index < count_) ++records_[index].attempts;
}

void BurnLedger::record(std::size_t index, Fate fate, Reason reason, double emitted_s) noexcept
{
  if (index >= count_) return;
  records_[index].fate = fate;
  records_[index].reason = reason;
  records_[index].emitted_s = emitted_s;
  ++changes_;
}

void BurnLedger::remember(std::int64_t map_id, const Eigen::Vector2d& place_px) noexcept
{
  if (places_ < burnt_.size()) burnt_[places_++] = {map_id, place_px};
}

bool BurnLedger::isBurnt(std::int64_t map_id, const Eigen::Vector2d& place_px, double within_px) const noexcept
{
  const auto end = burnt_.begin() + static_cast<std::ptrdiff_t>(places_);
  return std::any_of(burnt_.begin(), end, [&](const Place& place) {
    return place.map_id == map_id && (place.place_px - place_px).squaredNorm() < within_px * within_px;
  });
}

std::size_t BurnLedger::count(Fate fate) const noexcept
{
  const auto end = records_.begin() + static_cast<std::ptrdiff_t>(count_);
  return static_cast<std::size_t>(
      std::count_if(records_.begin(), end, [&](const TargetRecord& record) { return record.fate == fate; }));
}

bool BurnLedger::describe(const Preparation& preparation, burn_plan_t& message) const
{
  if (!preparation.proposed.message || !isOf(preparation.proposed.hash)) return false;
  message = *preparation.proposed.message;
  message.state = burn_plan_t::IN_FORCE;
  for (std::size_t i = 0; i < std::min(count_, message.target.size()); ++i) {
    Fate fate = records_[i].fate;
    Reason reason = records_[i].reason;
    if (i < preparation.verdicts.size()) {
      const TargetVerdict& verdict = preparation.verdicts[i];
      message.target[i].clearance_um = 1e6 * verdict.clearance;
      if (fate == Fate::pending && verdict.reason != Reason::none) {
        fate = Fate::refused;
        reason = verdict.reason;
      }
    }
    message.target[i].state = static_cast<std::int16_t>(fate);
    message.target[i].reason = static_cast<std::int16_t>(reason);
  }
  return true;
}

}  // namespace eyeslam::servo
