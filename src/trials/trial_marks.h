// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace eyeslam::trials {

/// Notes of MARK in a trial's log.
constexpr const char* kCountsFromHere = "counts from here";
constexpr const char* kNeverBegan = "what was asked for never began";

}  // namespace eyeslam::trials
