// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "eyeslam/servo/calibration.h"
#include "eyeslam/servo/loop_time.h"
#include "eyeslam/servo/registration_desk.h"

namespace eyeslam::servo {

/// A calibration in the loop: while a human wants it and the servo may guide, the tip goes once through the pattern and
/// its frames are kept. Wanting something else in between ends it without a result; wanting it again begins anew.
/// Never throws, never allocates.
class CalibrationRun {
 public:
  explicit CalibrationRun(const CalibrationPatternOptions& options) : pattern_(options) {}

  enum class Phase { idle, sweeps, over };
  /// Each cycle. @param wanted  by the human, and the servo guides; @param now  us
  void update(bool wanted, std::int64_t now, const Eigen::Vector3d& shaft, RegistrationDesk& desk) noexcept
  {
    if (!wanted) {
      if (phase_ == Phase::sweeps) desk.endCalibration();
      phase_ = Phase::idle;
    } else if (phase_ == Phase::idle) {
      phase_ = Phase::sweeps;
      began_ = now;
      has_samples_ = false;
      pattern_.start(shaft);
      desk.beginCalibration();
    } else if (phase_ == Phase::sweeps && seconds(now - began_) >= pattern_.duration_s()) {
      phase_ = Phase::over;
      has_samples_ = true;
      desk.endCalibration();
    }
  }
  Phase phase() const noexcept { return phase_; }
  /// From the null; manipulator frame, m.
  Eigen::Vector3d deflection(std::int64_t now, const Eigen::Vector3d& shaft) const noexcept
  {
    return phase_ == Phase::sweeps ? pattern_.at(seconds(now - began_), shaft) : Eigen::Vector3d::Zero();
  }

  /// A whole sweep waits for somebody to evaluate it.
  bool hasSamples() const noexcept { return has_samples_; }
  void taken() noexcept { has_samples_ = false; }

 private:
  CalibrationPattern pattern_;
  Phase phase_ = Phase::idle;
  std::int64_t began_ = 0;
  bool has_samples_ = false;
};

}  // namespace eyeslam::servo
