// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace eyeslam::trials {

/// When lock step begins, us since 1970; any that is not 0 (contracts, section 1).
constexpr std::int64_t kStart_us = 1'700'000'000'000'000;
constexpr std::int64_t kPeriod_us = 1000;
/// Between two tellings of BURN_PLAN, which is told once a second (contracts, section 4).
constexpr std::int64_t kPlanPeriods = 1000;

}  // namespace eyeslam::trials
