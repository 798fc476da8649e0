// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "eyeslam/trials/loop_trial.h"

namespace eyeslam::trials {

/// Trace the loop study's vessel back and forth at 0.4 mm/s along a curve fixture; its phases are drawn from the seed.
/// The error is the distance to the nearest place of the centreline. A task serves one trial: the fixture remembers.
/// @param lambda  0: hard
LoopTask traceTask(std::uint64_t seed, double lambda);

}  // namespace eyeslam::trials
