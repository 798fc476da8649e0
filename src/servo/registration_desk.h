// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/retina/options.h"
#include "eyeslam/retina/reason.h"
#include "eyeslam/servo/calibration.h"
#include "eyeslam/servo/camera_registration.h"
#include "eyeslam/servo/timed_ring.h"
#include "eyeslam/servo/view_placement.h"

namespace eyeslam::servo {

struct RegistrationDeskOptions {
  CameraRegistrationOptions camera;
  double measured_um = 4.0;
  double seen_px = 1.0;
  double declared_um_per_px = 0.0;
  bool refines = true;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.group("camera", self.camera);
    visitor.field("measured_um", self.measured_um, Range{0.0, 1000.0}, "um",
                  "RMS per axis of a measured tip; source: facts B1, with the needle's bending");
    visitor.field("seen_px", self.seen_px, Range{0.1, 100.0}, "full-resolution px",
                  "RMS per axis of a tip that is seen, unless it says more itself; source: loop study 1");
    visitor.field("declared_um_per_px", self.declared_um_per_px, Range{0.0, 1000.0}, "um",
                  "scale of the picture where it is known: a registration that differs is bad; 0 = not known");
    visitor.field("refines", self.refines, Range{0, 1}, "",
                  "whether tips seen during work go on improving it; source: zoom and focus change, facts E2");
  }
};

/// Owns the camera's registration and the retina's plane in the loop: pairs each tip that the camera saw with where the
/// manipulator had it during that exposure. A registration that is bad says why, and nothing may be servoed by it.
/// Never throws, never allocates.
///
///   desk.observe(state_utime, state.tip.position, shaft);      // each MICRON_STATE whose pose is measured
///   desk.see(sight);                                           // each TOOL_TIP
///   if (desk.good()) placement = desk.placement(scale);
class RegistrationDesk {
 public:
  explicit RegistrationDesk(const RegistrationDeskOptions& options = {});

  /// The tip as measured; manipulator frame, m. @param shaft  unit, from the handle towards the tip
  void observe(std::int64_t utime, const Eigen::Vector3d& tip, const Eigen::Vector3d& shaft) noexcept;
  /// A frame. @return why it brought nothing, none when it did: tip_late (not within the states kept, or not later than
  /// the last), not_finite, no_tip, and those of CameraRegistration::add
  retina::Reason see(const messaging::InstrumentSight& sight) noexcept;

  /// From now on frames are kept for `evaluate`, besides.
  void beginCalibration() noexcept;
  void endCalibration() noexcept { calibrating_ = false; }
  bool isCalibrating() const noexcept { return calibrating_; }
  const CalibrationSamples& samples() const noexcept { return samples_; }

  /// What a calibration or a file brought takes the place of what was known. A result without a plane keeps the plane.
  /// @param utime  us since 1970: when it was estimated
  void adopt(const CalibrationResult& result, std::int64_t utime) noexcept;
  void adopt(const CameraRegistration& camera, const std::optional<RetinaPlane>& plane, std::int64_t utime) noexcept;

  /// Camera and plane are known and good.
  bool good() const noexcept { return reason() == retina::Reason::none; }
  retina::Reason reason() const noexcept;
  const Registration& registration() const noexcept { return camera_.result(); }
  const std::optional<RetinaPlane>& plane() const noexcept { return plane_; }
  /// Of the plane; 0 = unknown.
  double umPerPx() const noexcept;
  /// One sigma of the registration at the newest tip, m on the retina; a large number before any.
  double sigma() const noexcept;
  /// None unless good.
  std::optional<ViewPlacement> placement(const ViewScale& scale) const noexcept;

  /// What REGISTRATION says.
  messaging::PublishedRegistration published() const noexcept;
  /// us since 1970: when it changed last; 0 before.
  std::int64_t utime() const noexcept { return utime_; }
  /// Grows when camera and plane are replaced (not when they are refined): then the placement must be made anew.
  std::int64_t adoptions() const noexcept { return adoptions_; }

 private:
  using TipAndShaft = Eigen::Matrix<double, 6, 1>;

  std::optional<CalibrationSample> sampleOf(const messaging::InstrumentSight& sight) const noexcept;
  double measuredSigmaPx() const noexcept;

  RegistrationDeskOptions options_;
  CameraRegistration camera_;
  std::optional<RetinaPlane> plane_;
  TimedRing<TipAndShaft, 512> measured_;
  std::int64_t seen_utime_ = 0;
  std::int64_t utime_ = 0;
  std::int64_t adoptions_ = 0;
  bool calibrating_ = false;
  CalibrationSamples samples_;
};

/// The registration that a REGISTRATION message or a file tells of, to start from.
CameraRegistration resumed(const messaging::PublishedRegistration& published,
                           const CameraRegistrationOptions& options = {});
std::optional<RetinaPlane> planeOf(const messaging::PublishedRegistration& published);
/// Both, as if a calibration had just brought them.
CalibrationResult calibrationOf(const messaging::PublishedRegistration& published,
                                const CameraRegistrationOptions& options = {});

}  // namespace eyeslam::servo
