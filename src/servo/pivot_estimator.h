// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>

#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/retina/options.h"
#include "eyeslam/retina/reason.h"

namespace eyeslam::servo {

struct PivotEstimatorOptions {
  double forgetting = 0.9995;
  double least_turn_mrad = 0.5;
  double least_samples = 50.0;
  double least_residual_um = 15.0;
  double shafts_alike = 20.0;
  double worst_error_um = 350.0;
  double outlier_um = 1000.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("forgetting", self.forgetting, Range{0.9, 1.0}, "",
                  "weight that a shaft keeps when a new one comes; source: 2000 shafts, some 10 s of a hand's tremor");
    visitor.field("least_turn_mrad", self.least_turn_mrad, Range{0.0, 100.0}, "mrad",
                  "a shaft that turned less brings nothing new; source: some three times its noise, 3 um over 20 mm");
    visitor.field("least_samples", self.least_samples, Range{3.0, 1e4}, "", "fewer do not serve; source: our choice");
    visitor.field("least_residual_um", self.least_residual_um, Range{0.1, 1000.0}, "um",
                  "of the shafts from the pivot, whatever they say: their errors last; source: noise of 3 um, bending "
                  "of 6 um, loop study 1");
    visitor.field("shafts_alike", self.shafts_alike, Range{1.0, 1000.0}, "",
                  "as many in a row share one error, for play and bending are slow; source: our simulation, errors in "
                  "units of sigma");
    visitor.field(
        "worst_error_um", self.worst_error_um, Range{1.0, 10000.0}, "um",
        "95 % error, mostly along the shaft, that still serves: the reach of 2 mm turns the shaft by 0.1 rad, "
        "which makes 40 um of it at the port; source: under half of the 100 um that are allowed there");
    visitor.field("outlier_um", self.outlier_um, Range{10.0, 10000.0}, "um",
                  "a shaft that passes the pivot at this distance is refused; source: beyond the play of a port");
  }
};

/// Where the shaft goes through the sclera: the point that is nearest to all shafts of the hand's null, by least
/// squares with forgetting. The surgeon turns the instrument about the port, so his own motion shows it; as long as the
/// shafts are too parallel to fix it along them, there is no pivot. A tool that entered elsewhere starts it anew.
///
///   PivotEstimator estimator;
///   each cycle: estimator.observe(state.null, state.port_displacement);
///   command.keep_pivot = estimator.pivot().has_value();
///
/// Manipulator frame, m. Never throws, never allocates, below 1 us. Remote centre of motion: facts B2.
class PivotEstimator {
 public:
  explicit PivotEstimator(const PivotEstimatorOptions& options = {}) noexcept;

  /// @param null  its z axis is the shaft
  /// @param port_displacement  of the port from its rest, m; zero where it is not measured
  /// @return why it was not taken: not_finite, tip_at_rest, outlier; none when it was
  retina::Reason observe(const messaging::ToolPose& null,
                         const Eigen::Vector3d& port_displacement = Eigen::Vector3d::Zero()) noexcept;

  /// Where the port is now, at its newest displacement; none where it is not known well enough.
  std::optional<Eigen::Vector3d> pivot() const noexcept;
  /// One sigma in the worst direction, nearly always along the shaft, m; infinity before the first solution.
  double sigma() const noexcept { return sigma_; }
  /// RMS distance of the shafts from the pivot, m.
  double residual() const noexcept { return residual_; }

 private:
  bool isKnown() const noexcept;
  bool isNew(const Eigen::Vector3d& axis) const noexcept;
  void absorb(const Eigen::Vector3d& point, const Eigen::Vector3d& axis) noexcept;
  void solve() noexcept;
  void startAnew() noexcept;

  PivotEstimatorOptions options_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  // the first tip; sums are in mm about it
  Eigen::Vector3d last_axis_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d moment_ = Eigen::Vector3d::Zero();
  double squares_ = 0.0;
  double weight_ = 0.0;
  int samples_ = 0;
  int refused_in_a_row_ = 0;
  Eigen::Vector3d rest_ = Eigen::Vector3d::Zero();          // of the pivot
  Eigen::Vector3d displacement_ = Eigen::Vector3d::Zero();  // the newest
  double sigma_;
  double residual_ = 0.0;
};

}  // namespace eyeslam::servo
