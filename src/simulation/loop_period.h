// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace eyeslam::simulation {

/// Of the control loop and so of hand, eye and manipulator, which are simulated with it: 1 kHz, in s.
inline constexpr double kPeriod_s = 1e-3;

}  // namespace eyeslam::simulation
