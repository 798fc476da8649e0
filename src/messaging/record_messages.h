// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/burn_plan_t.hpp"
#include "eyeslam/mark_t.hpp"
#include "eyeslam/messaging/byte_walk.h"
#include "eyeslam/messaging/conversion.h"

namespace eyeslam::messaging {

/// Most targets of a plan in a message: 137 kB, which passes with an ordinary receive buffer.
constexpr int kMostTargets = 2048;

/// Messages of variable size that no controller needs. They are their own values; `read` checks and copies them.
template <>
struct Conversion<burn_plan_t> {
  using Value = burn_plan_t;
  static bool hasItsLengths(ByteWalk walk);
  static retina::Reason read(const burn_plan_t& message, burn_plan_t& plan);
};

template <>
struct Conversion<mark_t> {
  using Value = mark_t;
  static bool hasItsLengths(ByteWalk walk);
  static retina::Reason read(const mark_t& message, mark_t& mark);
};

}  // namespace eyeslam::messaging
