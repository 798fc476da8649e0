// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/cycle_pairs.h"

#include <algorithm>

namespace eyeslam::replay {

void CyclePairs::recompute(const files::LogEvent& event)
{
  const auto found = std::find_if(recorded_.begin(), recorded_.end(),
                                  [&event](const KeptMessage& kept) { return kept.channel == event.channel; });
  if (found == recorded_.end()) return comparison_.extra(event);
  comparison_.compare(found->event(), event);
  if (event.channel == "MICRON_COMMAND") goals_.add(found->event(), event);
  recorded_.erase(found);
}

void CyclePairs::settle()
{
  for (const KeptMessage& kept : recorded_) comparison_.missing(kept.event());
  recorded_.clear();
}

}  // namespace eyeslam::replay
