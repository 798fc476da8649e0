// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// Other units in those of SI, for every layer: x_mm * kMilli is in m, x_deg * kDegree in rad. The way back has factors
/// of its own, for a quotient by kMicro is rounded otherwise than a product with kPerMicro.
namespace eyeslam {

inline constexpr double kPi = 3.14159265358979323846;  // rad, half a turn
inline constexpr double kTwoPi = 2.0 * kPi;            // rad, a whole turn; also rad/s in 1 Hz
inline constexpr double kDegree = kPi / 180.0;         // rad
inline constexpr double kDegreesPerRadian = 180.0 / kPi;

inline constexpr double kMilli = 1e-3;
inline constexpr double kMicro = 1e-6;
inline constexpr double kPerMilli = 1e3;  // mm in a m
inline constexpr double kPerMicro = 1e6;  // um in a m

}  // namespace eyeslam
