// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/goal_distances.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/messaging/decoding.h"
#include "eyeslam/micron_command_t.hpp"

namespace eyeslam::replay {
namespace {

constexpr double kFarthest_nm = 1e12;  // what is farther, or no number, is as far

}  // namespace

void GoalDistances::add(const files::LogEvent& recorded, const files::LogEvent& recomputed)
{
  micron_command_t was{}, is{};
  if (!messaging::decode(recorded.data, recorded.size, was)) return;
  if (!messaging::decode(recomputed.data, recomputed.size, is)) return;
  if (was.mode != micron_command_t::FOLLOW || is.mode != was.mode || is.reference != was.reference) return;
  const double metres = std::hypot(is.goal[0] - was.goal[0], is.goal[1] - was.goal[1], is.goal[2] - was.goal[2]);
  const double nanometres = 1e9 * metres;
  nanometres_.add(std::llround(nanometres <= kFarthest_nm ? nanometres : kFarthest_nm));
}

}  // namespace eyeslam::replay
