// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/trials/error_figures.h"

namespace eyeslam::apps {

/// Figures of errors in m, in um.
trials::ErrorFigures inMicrometres(const std::vector<double>& errors_m);

/// "14.0 ± 0.9 / 11.4 / 25": RMS ± spread over seeds / median / 95 %.
std::string said(const trials::SeedFigures& figures);

}  // namespace eyeslam::apps
