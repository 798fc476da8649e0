// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

namespace eyeslam::apps {

/// Lets only numbers of an interval pass. CLI11's own ranges let NaN pass, and show themselves in the help text.
CLI::Validator within(double lowest, double highest);

/// Lets only 0, 1, ... pass.
CLI::Validator frameNumber();

}  // namespace eyeslam::apps
