// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace eyeslam::servo {

constexpr double square(double x) { return x * x; }

}  // namespace eyeslam::servo
