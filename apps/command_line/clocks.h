// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace eyeslam::apps {

/// Monotonic time, s.
double monotonicSeconds();

/// CPU time of the calling thread, ms: other threads (decoding) do not count.
double threadCpuMilliseconds();

/// Wall time as messages carry it: us since 1970.
std::int64_t utimeNow();

}  // namespace eyeslam::apps
