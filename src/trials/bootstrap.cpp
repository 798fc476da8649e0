// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/bootstrap.h"

#include <cmath>
#include <numeric>
#include <stdexcept>

#include "eyeslam/files/score.h"
#include "eyeslam/simulation/random.h"

namespace eyeslam::trials {

namespace {

constexpr std::size_t kResamples = 4000;    // moves a bound by about a fiftieth of the interval's width
constexpr double kLow = 2.5, kHigh = 97.5;  // percent of the resamples: 95 lie between

void draw(simulation::Random& random, std::vector<std::size_t>& chosen)
{
  const auto count = static_cast<double>(chosen.size());
  for (std::size_t& index : chosen) index = static_cast<std::size_t>(random.uniform() * count);
}

}  // namespace

OverSeeds meanOverSeeds(const std::vector<double>& values)
{
  if (values.empty()) return {};
  const auto count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, values.size() > 1 ? std::sqrt(squares / (count - 1.0)) : 0.0};
}

Estimate bootstrap(std::size_t count, const std::function<double(const std::vector<std::size_t>&)>& statistic,
                   std::uint64_t seed)
{
  std::vector<std::size_t> chosen(count);
  std::iota(chosen.begin(), chosen.end(), 0U);
  const double value = statistic(chosen);
  simulation::Random random(seed);
  std::vector<double> resampled(kResamples);
  for (double& figure : resampled) {
    draw(random, chosen);
    figure = statistic(chosen);
  }
  return {value, files::percentile(resampled, kLow), files::percentile(resampled, kHigh)};
}

PairedComparison comparePairs(const std::vector<double>& unaided, const std::vector<double>& aided, std::uint64_t seed)
{
  if (unaided.size() != aided.size()) throw std::invalid_argument("a pair lacks one of its trials");
  PairedComparison result;
  result.pairs = aided.size();
  if (aided.empty()) return result;
  result.unaided = meanOverSeeds(unaided);
  result.aided = meanOverSeeds(aided);
  for (std::size_t i = 0; i < aided.size(); ++i) result.worse.push_back(aided[i] > unaided[i]);
  const auto reduction = [&](const std::vector<std::size_t>& chosen) {
    double with = 0.0, without = 0.0;
    for (const std::size_t pair : chosen) {
      with += aided[pair];
      without += unaided[pair];
    }
    return without > 0.0 ? 100.0 * (1.0 - with / without) : 0.0;
  };
  result.reduction_percent = bootstrap(aided.size(), reduction, seed);
  return result;
}

}  // namespace eyeslam::trials
