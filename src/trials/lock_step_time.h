// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace eyeslam::trials {

/// When lock step begins, us since 1970; any that is not 0 (contracts, section 1).
constexpr std::int64_t kStart_us = 1'700'000'000'000'000;

}  // namespace eyeslam::trials
