// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/random.h"

#include <cmath>

namespace eyeslam::simulation {

namespace {

std::uint64_t mixed(std::uint64_t z)
{
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

constexpr std::uint64_t kGoldenStep = 0x9E3779B97F4A7C15ULL;

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t stream)
    : state_(mixed(mixed(seed + kGoldenStep) + stream * kGoldenStep))
{}

std::uint64_t Random::bits()
{
  state_ += kGoldenStep;
  return mixed(state_);
}

double Random::uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }

double Random::normal()
{
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  double a = 0.0;
  double b = 0.0;
  double square = 0.0;
  do {
    a = uniform(-1.0, 1.0);
    b = uniform(-1.0, 1.0);
    square = a * a + b * b;
  } while (square >= 1.0 || square == 0.0);
  const double factor = std::sqrt(-2.0 * std::log(square) / square);
  spare_ = b * factor;
  has_spare_ = true;
  return a * factor;
}

}  // namespace eyeslam::simulation
