// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/error_text.h"

#include <fmt/format.h>

#include <utility>

#include "eyeslam/retina/units.h"

namespace eyeslam::apps {

trials::ErrorFigures inMicrometres(const std::vector<double>& errors_m)
{
  std::vector<double> um;
  um.reserve(errors_m.size());
  for (const double error : errors_m) um.push_back(error / kMicro);
  return trials::errorFigures(std::move(um));
}

std::string said(const trials::SeedFigures& figures)
{
  return fmt::format("{:.1f} ± {:.1f} / {:.1f} / {:.0f}", figures.mean.rms, figures.rms_spread, figures.mean.median,
                     figures.mean.p95);
}

}  // namespace eyeslam::apps
