// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

// g++ says by a macro that a sanitizer is at work, clang by a feature.
#if defined(__has_feature)
#define EYESLAM_FEATURE(name) __has_feature(name)
#else
#define EYESLAM_FEATURE(name) 0
#endif

namespace eyeslam::support {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || EYESLAM_FEATURE(address_sanitizer) || \
    EYESLAM_FEATURE(thread_sanitizer)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

/// Cases of a property: all in the release build, a twentieth under a sanitizer, which makes each some sixty times as
/// slow.
constexpr int cases(int all) { return kSanitized ? std::max(1, all / 20) : all; }

}  // namespace eyeslam::support
