// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <sys/stat.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "eyeslam/messaging/authentication.h"
#include "eyeslam/simulation/hardware.h"

namespace eyeslam::support {

/// The camera and the retina's plane of a simulated hardware as they are, in the file that eyeslam-servo reads; what is
/// known of them is what 200 tips seen within a px about `middle` (world) would tell.
/// @return image <- manipulator, px of m
inline Eigen::Matrix<double, 2, 4> writeTrueRegistration(const simulation::Hardware& hardware,
                                                         const Eigen::Vector3d& middle, const std::string& path)
{
  const Eigen::Isometry3d& manipulator_T_world = hardware.manipulatorTWorld();
  Eigen::Matrix<double, 2, 4> image_T_world = Eigen::Matrix<double, 2, 4>::Zero();
  image_T_world(0, 0) = image_T_world(1, 1) = 1e6 / hardware.umPerPx();
  const Eigen::Matrix<double, 2, 4, Eigen::RowMajor> image = image_T_world * manipulator_T_world.inverse().matrix();
  const Eigen::Vector3d normal = -manipulator_T_world.linear().col(2);
  constexpr double kTips = 200.0, kSpread = 1e-3;  // m, an axis
  const Eigen::Vector4d mean = (manipulator_T_world * middle).homogeneous();
  Eigen::Matrix4d information = kTips * mean * mean.transpose();
  information.diagonal().head<3>().array() += kTips * kSpread * kSpread;
  const Eigen::Matrix4d covariance = information.inverse();
  nlohmann::ordered_json json;
  json["version"] = 1;
  json["samples"] = 200;
  json["image_T_manipulator"] = std::vector<double>(image.data(), image.data() + 8);
  json["row_covariance"] = std::vector<double>(covariance.data(), covariance.data() + 16);
  json["residual_px"] = 1.0;
  json["condition"] = 1.5;
  json["um_per_px"] = hardware.umPerPx();
  json["plane_normal"] = std::vector<double>{normal.x(), normal.y(), normal.z()};
  json["plane_offset_m"] = normal.dot(manipulator_T_world.translation());
  json["plane_residual_m"] = 1e-6;
  std::ofstream(path) << json.dump(1) << '\n';
  return image;
}

/// A key as programs read it.
inline void writeKey(const messaging::Key& key, const std::string& path)
{
  std::ofstream file(path);
  for (const std::uint8_t byte : key) file << "0123456789abcdef"[byte >> 4U] << "0123456789abcdef"[byte & 15U];
  file.close();
  chmod(path.c_str(), S_IRUSR | S_IWUSR);
}

}  // namespace eyeslam::support
