// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "eyeslam/fixtures/centerline_index.h"
#include "eyeslam/retina/vessel_map.h"
#include "eyeslam/simulation/fundus.h"
#include "eyeslam/trials/scenario.h"
#include "eyeslam/trials/trial_record.h"
#include "eyeslam/trials/vessel_choice.h"

namespace eyeslam::trials {

/// Where a trial takes place, by setting and seed alone: the retina with its true vessels, and what the surgeon is to
/// do there. Retina frame, m, z into the retina.
class TrialScene {
 public:
  /// Some 0.5 s. @throws files::FileError the photograph; std::invalid_argument too small, or no vessel to trace
  TrialScene(const TrialSetting& setting, std::uint64_t seed);

  const simulation::Fundus& fundus() const { return fundus_; }
  /// The setting's, with the place of the retina that the surgeon has put under the microscope.
  const simulation::EyeCameraOptions& camera() const { return camera_; }
  double umPerPx() const { return um_per_px_; }
  /// Of the view at the start, on the retina's surface.
  const Eigen::Vector3d& middle() const { return middle_; }
  /// What the tip is to follow, at the height of the standoff: a true vessel's centreline, a line for standoff; the
  /// place alone for hold and laser.
  const std::vector<Eigen::Vector3d>& path() const { return path_; }
  /// Where one points at the path to say which vessel is meant: far from all others.
  const Eigen::Vector3d& pointedAt() const { return path_[pointed_at_]; }
  /// From a place to the nearest centreline of any true vessel, m; infinite where none is within 2 mm.
  double centrelineDistance(const Eigen::Vector2d& place) const;
  const RetinaPicture& picture() const { return picture_; }
  /// Calibre of the widest true vessel within a disc, m; 0 where none is.
  double widestWithin(const Eigen::Vector2d& place, double radius) const;
  /// From a place to the nearest true vessel's edge, m; 0 on a vessel.
  double vesselDistance(const Eigen::Vector2d& place) const;
  /// The true vessels as a map that has seen everything; what a surgeon sees without any tracker.
  retina::VesselMap trueMap() const;

 private:
  Eigen::Vector2d pixelOf(const Eigen::Vector2d& place) const;

  void chooseVessel(double longest, bool follows_vessel, std::uint64_t seed);
  Eigen::Vector2d besideReflections(const ChosenVessel& chosen, const Eigen::Vector2d& half_view,
                                    std::uint64_t seed) const;

  simulation::Fundus fundus_;
  simulation::EyeCameraOptions camera_;
  double um_per_px_ = 0.0;
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> path_;
  std::size_t pointed_at_ = 0;
  fixtures::CenterlineIndex vessels_;  // true ones
  RetinaPicture picture_;
  cv::Mat_<float> calibre_px_, distance_px_;
};

}  // namespace eyeslam::trials
