// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/reason.h"

namespace eyeslam::servo {

struct CameraRegistrationOptions {
  double forgetting = 0.999;
  double least_step_um = 20.0;
  double least_spread_um = 300.0;
  double outlier_sigmas = 4.0;
  double least_samples = 20.0;
  double worst_residual_px = 4.0;
  double worst_error_um = 20.0;
  double drift_um = 60.0;
  double scale_tolerance = 0.03;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("forgetting", self.forgetting, Range{0.9, 1.0}, "",
                  "weight that a sample keeps when a new one comes; source: facts E2, 0.95 to 1; 33 s at 30 Hz and 8 s "
                  "at 120 Hz: "
                  "zoom and focus change slowly, and what drifts faster is the trim's");
    visitor.field("least_step_um", self.least_step_um, Range{0.0, 1000.0}, "um",
                  "a tip that moved less brings nothing new and would only make the filter forget; source: facts E2");
    visitor.field("least_spread_um", self.least_spread_um, Range{0.0, 5000.0}, "um",
                  "below it (standard deviation across the narrower way) what is known of the camera is not forgotten "
                  "for tips in the middle of it; source: facts E2, without excitation the covariance blows up");
    visitor.field("outlier_sigmas", self.outlier_sigmas, Range{2.0, 20.0}, "sigma",
                  "a sample further from the fit is refused; source: loop study 2.4");
    visitor.field("least_samples", self.least_samples, Range{8.0, 1e4}, "",
                  "fewer do not serve; source: facts E1, four at least, hundreds better");
    visitor.field("worst_residual_px", self.worst_residual_px, Range{0.1, 100.0}, "full-resolution px",
                  "a fit with a larger RMS residual is refused; source: tip seen with 1 px, loop study 1");
    visitor.field(
        "worst_error_um", self.worst_error_um, Range{1.0, 1000.0}, "um",
        "95 % error within a mm of the tip that may still be servoed; source: the settle gate, loop study 2.8");
    visitor.field(
        "drift_um", self.drift_um, Range{5.0, 1000.0}, "um",
        "a lasting offset of the newest samples beyond it is a drift; source: the picture wanders by 15 um RMS "
        "of itself, which the trim takes out, loop study 1");
    visitor.field("scale_tolerance", self.scale_tolerance, Range{0.001, 0.5}, "",
                  "largest share by which a declared um per px may differ; source: contracts 1, 3 %");
  }
};

/// The tip, at one instant, as the manipulator measures it and as the camera sees it.
struct TipSample {
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();       ///< manipulator frame, m
  Eigen::Vector2d image_px = Eigen::Vector2d::Zero();  ///< full-resolution px
  double sigma_px = 1.0;                               ///< of each coordinate, the tip's own error included
};

/// The surface of the retina in the manipulator frame: points p with normal . p = distance.
struct RetinaPlane {
  Eigen::Vector3d normal = -Eigen::Vector3d::UnitZ();  ///< unit, away from the retina, towards the instrument
  double distance = 0.0;                               ///< m
  double residual = 0.0;                               ///< m, RMS of the points that it was fitted to

  double height(const Eigen::Vector3d& point) const { return normal.dot(point) - distance; }  ///< m above the retina
};

/// An affine camera, image = A p + b: under a microscope perspective is weak (facts E1).
struct Registration {
  Eigen::Matrix<double, 2, 4> image_T_base = Eigen::Matrix<double, 2, 4>::Zero();  ///< px/m in columns 0-2, px in 3
  Eigen::Matrix4d row_covariance = Eigen::Matrix4d::Zero();  ///< of either row; the two are independent
  double residual_px = 0.0;                                  ///< RMS of either coordinate
  double condition = 0.0;  ///< of the centred tips, largest to smallest lateral spread
  int samples = 0;
  retina::Reason reason = retina::Reason::not_registered;  ///< why it must not be servoed with; none when good

  bool good() const { return reason == retina::Reason::none; }
  Eigen::Vector2d toImage(const Eigen::Vector3d& tip) const { return image_T_base * tip.homogeneous(); }
  /// One sigma of a projected tip, px.
  double sigmaOf(const Eigen::Vector3d& tip) const;
  /// The point of the plane that the image shows there; none where the camera looks along the plane.
  std::optional<Eigen::Vector3d> toPlane(const Eigen::Vector2d& image_px, const RetinaPlane& plane) const;
  /// um of the plane per full-resolution px, the mean of both directions; none where it has none.
  std::optional<double> umPerPx(const RetinaPlane& plane) const;
};

/// Estimates the camera from tips: all at once after a calibration, or one by one with forgetting, because zoom, focus
/// and the eye's own lens change (facts E2). Refuses to be used when it is bad, and says why. Measured with 200 samples
/// of 4 um and 1 px noise over 3 x 3 x 0.4 mm: 1.3 um against truth (tests/servo/camera_registration_test.cpp).
///
///   CameraRegistration registration;
///   registration.fit(samples);
///   if (registration.result().good()) goal_px = registration.result().toImage(tip);
class CameraRegistration {
 public:
  explicit CameraRegistration(const CameraRegistrationOptions& options = {});

  /// Starts anew from many samples, robustly: a wrong tip detection in ten does no harm. Allocates; not for the loop.
  retina::Reason fit(const std::vector<TipSample>& samples);
  /// Goes on from what was estimated before, as if its samples had just been taken. A result that cannot be is refused.
  retina::Reason resume(const Registration& known);
  /// Takes one more sample; never throws, never allocates. @return why it was not taken, none when it was
  retina::Reason add(const TipSample& sample);
  /// What somebody else believes, such as a plan: a scale that differs makes the registration bad.
  void expectScale(double um_per_px, const RetinaPlane& plane);

  const Registration& result() const { return result_; }
  int refused() const { return refused_; }

 private:
  using Row = Eigen::Vector4d;

  Eigen::Matrix4d toOwn() const;
  Row regressor(const Eigen::Vector3d& tip) const;
  void noteDrift(const Eigen::Vector2d& innovation_px);
  void absorb(const TipSample& sample, double weight);
  void solve();
  retina::Reason verdict() const;
  void forget();
  bool bringsNothing(const Eigen::Vector3d& tip) const;

  CameraRegistrationOptions options_;
  // Normal equations of both rows, in mm about the first tip: metres would make the matrix ill conditioned.
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Matrix4d information_ = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 2> moments_ = Eigen::Matrix<double, 4, 2>::Zero();
  double squares_ = 0.0;  // weighted squares of residuals, for the noise as it really is
  double weights_ = 0.0;
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();  // of the tips, mm about the origin
  double spread_ = 0.0;                             // mm, their standard deviation across the narrower way
  Eigen::Vector3d last_tip_ = Eigen::Vector3d::Zero();
  Eigen::Vector2d drift_um_ = Eigen::Vector2d::Zero();  // mean of the newest innovations, on the retina
  std::optional<double> expected_um_per_px_;
  RetinaPlane expected_plane_;
  Registration result_;
  int refused_ = 0;
};

}  // namespace eyeslam::servo
