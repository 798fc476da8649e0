// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace eyeslam::servo {

/// In the place of an age, an error, a distance or a speed that nobody knows (s, m, m/s): beyond every limit, so that
/// it never speaks for a pulse.
inline constexpr double kUnknown = 1e9;

}  // namespace eyeslam::servo
