// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace eyeslam::apps {

/// Monotonic time, s.
double monotonicSeconds();

/// CPU time of the calling thread, ms: other threads (decoding) do not count.
double threadCpuMilliseconds();

}  // namespace eyeslam::apps
