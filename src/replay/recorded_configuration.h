// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include "eyeslam/configuration/assignment.h"
#include "eyeslam/mark_t.hpp"
#include "eyeslam/replay/recomputed_part.h"

namespace eyeslam::replay {

/// What `read` makes of a MARK START's configuration.
/// @throws ReplayError  it is not understood; names the version that wrote it, for that is the log's fault and not the
///                      user's
template <class Read>
auto recordedConfiguration(const mark_t& mark, const Read& read)
{
  try {
    return read(mark.configuration);
  } catch (const configuration::ConfigurationError& error) {
    throw ReplayError(fmt::format("MARK START of version {}: {}", mark.version, error.what()));
  }
}

}  // namespace eyeslam::replay
