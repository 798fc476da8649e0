// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace eyeslam::support {

/// Calls of operator new, malloc, calloc, realloc and the aligned kinds, from any thread, since the program began; so
/// cv::Mat and Eigen are counted too. Compile support/allocation_counter.cpp into the test. Under a sanitizer, which
/// has its own malloc, operator new alone is counted.
///
///   const std::int64_t before = allocations();
///   step.update(frame);
///   EXPECT_EQ(allocations(), before);
std::int64_t allocations();

}  // namespace eyeslam::support
