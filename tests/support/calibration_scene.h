// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <functional>
#include <memory>
#include <random>

#include "eyeslam/servo/calibration.h"
#include "eyeslam/servo/camera_registration.h"

namespace eyeslam::support {

/// A camera above a flat retina and an instrument that comes in 30 deg from the line of sight, in a manipulator's frame
/// of its own. Noise of the loop study: 4 um on the measured tip, 1 px on what is seen.
class CalibrationScene {
 public:
  explicit CalibrationScene(unsigned seed) : random_(seed)
  {
    manipulator_T_world_.linear() =
        Eigen::Quaterniond(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized().matrix();
    manipulator_T_world_.translation() = Eigen::Vector3d(uniform(-0.1, 0.1), uniform(-0.1, 0.1), uniform(-0.1, 0.1));
    um_per_px_ = uniform(3.0, 8.0);
    Eigen::Matrix<double, 2, 4> image_T_world = Eigen::Matrix<double, 2, 4>::Zero();
    image_T_world.leftCols<2>() = Eigen::Matrix2d::Identity() * 1e6 / um_per_px_;
    image_T_world.col(3) = Eigen::Vector2d(400.0, 300.0);
    // A camera that looks a little askew.
    image_T_world.col(2) = Eigen::Vector2d(uniform(-0.05, 0.05), uniform(-0.05, 0.05)) * 1e6 / um_per_px_;
    camera_ = image_T_world * manipulator_T_world_.inverse().matrix();
    const double turn = uniform(-3.0, 3.0), tilt = uniform(0.5, 0.6);
    shaft_world_ = {std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt)};
    null_world_ = {uniform(-1e-3, 1e-3), uniform(-1e-3, 1e-3), -uniform(0.6e-3, 1.2e-3)};  // above the retina
  }

  using Change = std::function<void(servo::CalibrationSample&, int frame)>;

  /// The default pattern, evenly sampled.
  std::unique_ptr<servo::CalibrationSamples> sweep(int frames, const Change& change = {})
  {
    servo::CalibrationPattern pattern;
    pattern.start(shaft());
    auto samples = std::make_unique<servo::CalibrationSamples>();
    for (int frame = 0; frame < frames; ++frame) {
      servo::CalibrationSample sample =
          sampleAt(nullTip() + pattern.at(pattern.duration_s() * (frame + 0.5) / frames, shaft()));
      if (change) change(sample, frame);
      samples->add(sample);
    }
    return samples;
  }

  /// One frame with the tip there.
  servo::CalibrationSample sampleAt(const Eigen::Vector3d& tip)
  {
    servo::CalibrationSample sample;
    sample.tip.tip = tip + 4e-6 * Eigen::Vector3d(normal(), normal(), normal());
    sample.tip.image_px = imageOf(tip) + Eigen::Vector2d(normal(), normal());
    sample.shaft = (shaft() + 1e-3 * Eigen::Vector3d(normal(), normal(), normal())).normalized();
    sample.spot_seen = true;
    sample.spot_px = imageOf(spotOf(tip)) + Eigen::Vector2d(normal(), normal());
    return sample;
  }

  Eigen::Vector2d imageOf(const Eigen::Vector3d& point) const { return camera_ * point.homogeneous(); }
  Eigen::Vector3d spotOf(const Eigen::Vector3d& tip) const
  {
    const Eigen::Vector3d world = manipulator_T_world_.inverse() * tip;
    return manipulator_T_world_ * Eigen::Vector3d(world - shaft_world_ * (world.z() / shaft_world_.z()));
  }
  Eigen::Vector3d nullTip() const { return manipulator_T_world_ * null_world_; }
  Eigen::Vector3d shaft() const { return manipulator_T_world_.linear() * shaft_world_; }
  double umPerPx() const { return um_per_px_; }

  /// RMS over the sweep's volume, um on the retina.
  double registrationErrorUm(const servo::Registration& registration)
  {
    double squares = 0.0;
    constexpr int kPlaces = 200;
    for (int i = 0; i < kPlaces; ++i) {
      const Eigen::Vector3d tip =
          nullTip() + manipulator_T_world_.linear() *
                          Eigen::Vector3d(uniform(-0.7e-3, 0.7e-3), uniform(-0.7e-3, 0.7e-3), uniform(-0.35e-3, 0.0));
      squares += (registration.toImage(tip) - imageOf(tip)).squaredNorm();
    }
    return um_per_px_ * std::sqrt(squares / kPlaces);
  }

  /// RMS over the circle on which most spots lie, m.
  double planeError(const servo::RetinaPlane& plane) const
  {
    const Eigen::Vector3d middle = spotOf(nullTip());
    double squares = 0.0;
    constexpr int kPlaces = 32;
    for (int i = 0; i < kPlaces; ++i) {
      const double angle = 2.0 * M_PI * i / kPlaces;
      const Eigen::Vector3d way(std::cos(angle), std::sin(angle), 0.0);
      const double height = plane.height(middle + 0.7e-3 * manipulator_T_world_.linear() * way);
      squares += height * height;
    }
    return std::sqrt(squares / kPlaces);
  }

 private:
  double uniform(double lowest, double highest)
  {
    return std::uniform_real_distribution<double>(lowest, highest)(random_);
  }
  double normal() { return normal_(random_); }

  std::mt19937 random_;
  std::normal_distribution<double> normal_{0.0, 1.0};
  Eigen::Isometry3d manipulator_T_world_ = Eigen::Isometry3d::Identity();  // world: x, y on the retina, z into it
  Eigen::Matrix<double, 2, 4> camera_;
  double um_per_px_ = 5.0;
  Eigen::Vector3d shaft_world_, null_world_;
};

}  // namespace eyeslam::support
