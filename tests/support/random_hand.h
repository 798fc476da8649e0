// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace eyeslam::support {

/// A hand at 1 kHz that wanders smoothly towards ever new places, trembling; m. Rougher than a surgeon's, so that tests
/// meet in seconds what takes him hours.
class RandomHand {
 public:
  /// @param reach  how far it goes from `home`, m; @param speed  of its travel, m/s; @param tremor  amplitude, m
  RandomHand(std::mt19937& random, const Eigen::Vector3d& home, double reach, double speed, double tremor)
      : random_(random), home_(home), reach_(reach), speed_(speed), tremor_(tremor), at_(home), target_(home)
  {}

  Eigen::Vector3d step(double dt)
  {
    if ((target_ - at_).norm() < 2.0 * speed_ * dt)
      target_ = home_ + reach_ * Eigen::Vector3d(unit_(random_), unit_(random_), 0.3 * unit_(random_));
    at_ += (target_ - at_).normalized() * speed_ * dt;
    t_ += dt;
    const auto wave = [this](double hz, double phase) { return std::sin(2.0 * M_PI * hz * t_ + phase); };
    return at_ + tremor_ * Eigen::Vector3d(wave(9.1, 0.0), wave(8.3, 1.0), 0.3 * wave(10.2, 2.0));
  }
  /// Goes on from another place.
  void moveTo(const Eigen::Vector3d& place) { home_ = at_ = target_ = place; }

 private:
  std::mt19937& random_;
  Eigen::Vector3d home_;
  double reach_, speed_, tremor_;
  Eigen::Vector3d at_, target_;
  double t_ = 0.0;
  std::uniform_real_distribution<double> unit_{-1.0, 1.0};
};

/// A retina that drifts and turns at up to a speed (m/s) about a place; manipulator_T_retina.
class WanderingRetina {
 public:
  WanderingRetina(std::mt19937& random, double speed) : speed_(speed)
  {
    std::uniform_real_distribution<double> phase(0.0, 2.0 * M_PI);
    for (double& one : phase_) one = phase(random);
    tilt_ =
        Eigen::AngleAxisd(0.2 * std::sin(phase_[0]), Eigen::Vector3d(std::cos(phase_[1]), std::sin(phase_[1]), 0.0));
  }

  Eigen::Isometry3d step(double dt)
  {
    t_ += dt;
    // Lissajous at speed_ at most: two axes of speed / 2 and a turn that adds little within some mm.
    const double hz = 1.3, amplitude = speed_ / (2.0 * M_PI * hz) / 2.0;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(Eigen::Vector3d(amplitude * std::sin(2.0 * M_PI * hz * t_ + phase_[0]),
                                   amplitude * std::sin(2.0 * M_PI * hz * t_ + phase_[1]),
                                   0.1 * amplitude * std::sin(2.0 * M_PI * 0.3 * t_ + phase_[2])));
    pose.rotate(tilt_);
    pose.rotate(Eigen::AngleAxisd(0.05 * std::sin(2.0 * M_PI * 0.2 * t_ + phase_[2]), Eigen::Vector3d::UnitZ()));
    return pose;
  }

 private:
  double speed_;
  double phase_[3] = {};
  Eigen::AngleAxisd tilt_ = Eigen::AngleAxisd::Identity();
  double t_ = 0.0;
};

}  // namespace eyeslam::support
