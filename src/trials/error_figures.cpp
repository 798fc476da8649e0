// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/error_figures.h"

#include <algorithm>
#include <cmath>

namespace eyeslam::trials {

ErrorFigures errorFigures(std::vector<double> errors)
{
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  double squares = 0.0;
  for (const double error : errors) squares += error * error;
  const auto share = [&](double part) {
    return errors[static_cast<std::size_t>(part * static_cast<double>(errors.size() - 1) + 0.5)];
  };
  return {std::sqrt(squares / static_cast<double>(errors.size())), share(0.5), share(0.95), share(0.99), errors.back()};
}

SeedFigures overSeeds(const std::vector<ErrorFigures>& seeds)
{
  SeedFigures result;
  if (seeds.empty()) return result;
  const double weight = 1.0 / static_cast<double>(seeds.size());
  for (const ErrorFigures& seed : seeds) {
    result.mean.rms += weight * seed.rms;
    result.mean.median += weight * seed.median;
    result.mean.p95 += weight * seed.p95;
    result.mean.p99 += weight * seed.p99;
    result.mean.max = std::max(result.mean.max, seed.max);
  }
  double square = 0.0;
  for (const ErrorFigures& seed : seeds) square += (seed.rms - result.mean.rms) * (seed.rms - result.mean.rms);
  result.rms_spread = std::sqrt(weight * square);
  return result;
}

}  // namespace eyeslam::trials
