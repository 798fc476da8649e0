// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace eyeslam::trials {

/// What is said of errors; in their unit.
struct ErrorFigures {
  double rms = 0.0;
  double median = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
  double max = 0.0;
};

/// Of no errors: zeros.
ErrorFigures errorFigures(std::vector<double> errors);

/// Figures over seeds: the mean of each, and how much the RMS differs between them.
struct SeedFigures {
  ErrorFigures mean;
  double rms_spread = 0.0;  ///< standard deviation
};
SeedFigures overSeeds(const std::vector<ErrorFigures>& seeds);

}  // namespace eyeslam::trials
