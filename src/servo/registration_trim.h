// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/reason.h"
#include "eyeslam/servo/timed_ring.h"

namespace eyeslam::servo {

/// Source, unless said: loop study, section 2.4.
struct RegistrationTrimOptions {
  double offset_walk_um2_s = 150.0;
  double offset_um = 50.0;
  double matrix = 0.03;
  double matrix_walk = 0.0005;
  double seen_um = 5.0;
  double measured_um = 3.0;
  double gate_sigmas = 4.0;
  double gate_um = 10.0;
  double reopen_frames = 15.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("offset_walk_um2_s", self.offset_walk_um2_s, Range{0, 1e6}, "um^2/s",
                  "random walk of the offset; 400 where the spot is seen instead of the tip");
    visitor.field("offset_um", self.offset_um, Range{0.1, 1e4}, "um", "standard deviation of the offset at first");
    visitor.field("matrix", self.matrix, Range{0, 1}, "", "standard deviation of each entry of the matrix at first");
    visitor.field("matrix_walk", self.matrix_walk, Range{0, 0.1}, "per sqrt(s)",
                  "by which those change; source: almost constant");
    visitor.field("seen_um", self.seen_um, Range{0.01, 1000}, "um",
                  "RMS per axis of a tip that is seen, unless it says more itself; source: 1 px");
    visitor.field("measured_um", self.measured_um, Range{0, 1000}, "um",
                  "RMS per axis of a measured tip; source: facts, B1");
    visitor.field("gate_sigmas", self.gate_sigmas, Range{1, 20}, "sigma",
                  "a surprise beyond these and gate_um is refused");
    visitor.field("gate_um", self.gate_um, Range{0, 5000}, "um", "see gate_sigmas");
    visitor.field("reopen_frames", self.reopen_frames, Range{2, 1000}, "",
                  "so many refused in a row: the registration itself has changed; source: half a second of a camera");
  }
};

/// A tip that the camera saw.
struct SeenTip {
  std::int64_t utime = 0;  ///< mid-exposure
  double exposure_s = 0.0;
  Eigen::Vector2d view = Eigen::Vector2d::Zero();  ///< view frame, m
  double sigma = 0.0;                              ///< m, per axis; 0: not known
};

/// What is wrong with the registration: an observer of six affine corrections, fed by where the manipulator puts the
/// tip and where the camera sees it. No integrator of the image error: it has no loop through the plant, so it cannot
/// wind up in a jump of the retina, and it runs while the retina is lost.
///   measured = seen + offset + matrix (seen - centre)
/// View frame, m. Source: loop study, section 2.4. Never throws, never allocates.
class RegistrationTrim {
 public:
  /// @param centre  of the image, view frame
  RegistrationTrim(const RegistrationTrimOptions& options, const Eigen::Vector2d& centre);

  /// The tip as the manipulator measures it, carried into the view by the registration; each cycle.
  retina::Reason observe(std::int64_t utime, const Eigen::Vector2d& measured) noexcept;
  /// The tip as it was seen. @return none; tip_late, tip_not_finite, tip_far: refused
  retina::Reason correct(const SeenTip& seen) noexcept;

  /// The registration was replaced: what it measured at `old` it measures at `new_T_old old` now. The sum of both
  /// stays what it was.
  void rebase(const Eigen::Affine2d& new_T_old) noexcept;

  /// Where the registration puts what is truly here, and back.
  Eigen::Vector2d toMeasured(const Eigen::Vector2d& seen) const noexcept;
  Eigen::Vector2d toSeen(const Eigen::Vector2d& measured) const noexcept;

  const Eigen::Vector2d& offset() const noexcept { return offset_; }
  /// One sigma of the correction at a place of the view, m, per axis.
  double sigmaAt(const Eigen::Vector2d& seen) const noexcept;

 private:
  using Row = Eigen::Vector3d;  // 1 and the place in units of kLever

  Row row(const Eigen::Vector2d& seen) const noexcept;
  bool meanOver(const SeenTip& seen, Eigen::Vector2d& mean) const noexcept;
  void advance(std::int64_t utime) noexcept;
  void reopen() noexcept;
  void keepSolution() noexcept;

  RegistrationTrimOptions options_;
  Eigen::Vector2d centre_;
  TimedRing<Eigen::Vector2d, 512> measured_;
  Eigen::Matrix<double, 3, 2> corrections_ = Eigen::Matrix<double, 3, 2>::Zero();  // a column per axis, m
  Eigen::Matrix3d covariance_;  // of either column: both see the same rows
  Eigen::Vector2d offset_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d linear_ = Eigen::Matrix2d::Identity(), inverse_ = Eigen::Matrix2d::Identity();
  std::int64_t utime_ = 0;
  int refused_in_a_row_ = 0;
};

}  // namespace eyeslam::servo
