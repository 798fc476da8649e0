// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "eyeslam/burn_plan_t.hpp"
#include "eyeslam/fixtures/burn_plan.h"
#include "eyeslam/messaging/operator_messages.h"

namespace eyeslam::servo {

/// SHA-256 over all of a plan that decides what is burnt, little-endian: um_per_px, margin_um, localization_um (IEEE
/// 754 double), map_id (int64), map_hash, the number of targets (uint32); of each target id and tile (int32), x_px,
/// y_px, spot_um, burn_um, duration, power (double) and whether it is REFUSED (a byte), in their order. What changes
/// while a plan is executed (other states, reasons, clearances) is not part of it. This is what a human approves.
messaging::Hash planHash(const burn_plan_t& plan);

/// A plan as it is proposed, its hash filled in; the header is the publisher's.
/// @param map_id  of the live map that it was made on, as in retina_pose_t
/// @throws fixtures::PlanError  more targets than a message carries, or no possible target
burn_plan_t planMessage(const fixtures::BurnPlan& plan, std::int64_t map_id);

/// The plan of a message that was read; of the prescription it has margin and localization error alone, for zones and
/// pattern do not travel: what was refused stays refused.
fixtures::BurnPlan planOf(const burn_plan_t& message);

}  // namespace eyeslam::servo
