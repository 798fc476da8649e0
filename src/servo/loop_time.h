// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>

namespace eyeslam::servo {

/// The loop counts in `utime`, us since 1970 (contracts, section 1), and calculates in seconds.
constexpr double seconds(std::int64_t duration_us) { return 1e-6 * static_cast<double>(duration_us); }
inline std::int64_t microseconds(double duration_s) { return std::llround(1e6 * duration_s); }

}  // namespace eyeslam::servo
