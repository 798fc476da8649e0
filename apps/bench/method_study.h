// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

#include "eyeslam/files/score.h"

namespace eyeslam::apps {

/// Runs a tracking method over a sequence (contracts, section 5) and scores it by the judge's formulas.
/// @param frames  at most so many, 0 = all
/// @param step    called after each frame with its number
/// @throws files::FileError; std::invalid_argument for an unknown method
files::PoseScore scoreMethod(const std::string& method, const std::string& sequence, int frames,
                             const std::function<void(std::int64_t)>& step);

}  // namespace eyeslam::apps
