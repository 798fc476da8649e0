// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace eyeslam::apps {

/// How far a tip was from where it should be, sample by sample.
class TipErrors {
 public:
  struct Figures {
    double rms = 0.0, median = 0.0, p95 = 0.0;  ///< m
  };

  void add(double error_m) { errors_.push_back(static_cast<float>(error_m)); }
  std::size_t samples() const { return errors_.size(); }
  /// Zeros without a sample.
  Figures figures() const;

 private:
  std::vector<float> errors_;  // m
};

}  // namespace eyeslam::apps
