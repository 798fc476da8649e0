// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace eyeslam::simulation {

/// Seeded numbers that are the same on every platform: the standard leaves the algorithms of its distributions open.
/// Generator: splitmix64 (Steele, Lea, Flood 2014), 2^64 states, good enough for pictures.
class Random {
 public:
  /// Streams of one seed are independent: a change in one part of the scene leaves the others as they were.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0);

  std::uint64_t bits();
  /// Uniform in [0, 1).
  double uniform();
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Standard normal (Marsaglia's polar method).
  double normal();
  bool chance(double probability) { return uniform() < probability; }

 private:
  std::uint64_t state_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace eyeslam::simulation
