// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Marks a free function whose loops are compiled twice, for AVX2 (x86-64-v3) and for any x86-64, and chosen when the
/// program loads. Debian's baseline has 16-byte vectors only; the clone halves the tracker's time without a flag that
/// would break older machines. Sanitizers run before the choice could be made, so they get the plain function.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define EYESLAM_VECTOR_KERNEL __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define EYESLAM_VECTOR_KERNEL
#endif
