// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sim/sim_arguments.h"

namespace eyeslam::apps {

/// `eyeslam-sim --out DIR`: a sequence with its truth (contracts, section 5). @throws UsageError, files::FileError
void renderSequence(const SimArguments& arguments);

}  // namespace eyeslam::apps
