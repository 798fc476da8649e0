// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/messaging/conversion.h"
#include "eyeslam/truth_t.hpp"

namespace eyeslam::messaging {

/// The simulation's truth is its own value; `read` checks and copies it.
template <>
struct Conversion<truth_t> {
  using Value = truth_t;
  static retina::Reason read(const truth_t& message, truth_t& truth);
};

}  // namespace eyeslam::messaging
