// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/reason.h"
#include "eyeslam/servo/camera_registration.h"
#include "eyeslam/servo/surface_fit.h"

namespace eyeslam::servo {

struct CalibrationPatternOptions {
  double lateral_mm = 1.0;
  double backwards_mm = 0.4;
  double duration_s = 8.0;
  double ramp_s = 1.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("lateral_mm", self.lateral_mm, Range{0.1, 1.0}, "mm",
                  "radius of the sweep across the shaft; source: half of the reach, facts B1");
    visitor.field("backwards_mm", self.backwards_mm, Range{0.0, 0.4}, "mm",
                  "farthest along the shaft, away from the retina only; source: study's volume, loop study 1");
    visitor.field("duration_s", self.duration_s, Range{6.0, 60.0}, "s",
                  "of the whole sweep; source: 240 frames of 30 Hz");
    visitor.field("ramp_s", self.ramp_s, Range{0.5, 2.0}, "s",
                  "in which it grows from nothing and fades; source: no step of the goal");
  }
};

/// A short safe sweep of the tip about the hand's null, as a function of the time since its start: a rosette across the
/// shaft and, slower, back along it, never towards the retina. Starts and ends at zero, at rest; outside [0, duration]
/// it is zero. 5 mm/s and 50 mm/s^2 at most for any options (tests). Never throws, never allocates.
class CalibrationPattern {
 public:
  explicit CalibrationPattern(const CalibrationPatternOptions& options = {});

  double duration_s() const noexcept { return duration_; }
  /// Fixes the sweep's first direction across the shaft. @param shaft  unit, from the handle towards the tip
  void start(const Eigen::Vector3d& shaft) noexcept;
  /// @param shaft  as it is now: the sweep turns with it
  /// @return deflection from the null, manipulator frame, m; zero before a start and for what is not finite
  Eigen::Vector3d at(double time_s, const Eigen::Vector3d& shaft) const noexcept;

 private:
  double lateral_, backwards_, duration_, ramp_;
  Eigen::Vector3d right_ = Eigen::Vector3d::Zero();
};

/// One frame of a calibration.
struct CalibrationSample {
  TipSample tip;
  Eigen::Vector3d shaft = Eigen::Vector3d::UnitZ();  ///< unit, towards the tip and so along the beam; manipulator frame
  bool spot_seen = false;
  Eigen::Vector2d spot_px = Eigen::Vector2d::Zero();  ///< of the aiming beam, full-resolution px
};

/// The newest frames, in a store of fixed size. Never allocates; copied as a whole to the thread that evaluates.
class CalibrationSamples {
 public:
  static constexpr std::size_t kMost = 500;

  void clear() noexcept { count_ = next_ = 0; }
  void add(const CalibrationSample& sample) noexcept
  {
    samples_[next_] = sample;
    next_ = (next_ + 1) % kMost;
    if (count_ < kMost) ++count_;
  }
  std::size_t size() const noexcept { return count_; }
  /// Oldest first.
  const CalibrationSample& operator[](std::size_t index) const noexcept
  {
    return samples_[(next_ + kMost - count_ + index) % kMost];
  }

 private:
  std::array<CalibrationSample, kMost> samples_{};
  std::size_t count_ = 0, next_ = 0;
};

struct CalibrationOptions {
  CameraRegistrationOptions camera;
  SurfaceFitOptions surface;
  double least_frames = 80.0;
  double farthest_spot_mm = 10.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.group("camera", self.camera);
    visitor.group("surface", self.surface);
    visitor.field("least_frames", self.least_frames, Range{20.0, 500.0}, "",
                  "fewer frames with a tip are no calibration; source: 200 give 1.5 um, 80 give 2.1 um; tests");
    visitor.field("farthest_spot_mm", self.farthest_spot_mm, Range{0.1, 50.0}, "mm",
                  "an aiming spot further down the beam is none; source: the eye's inner length is 17 mm, facts C5");
  }
};

/// What a calibration found.
struct CalibrationResult {
  CameraRegistration camera;
  std::optional<RetinaPlane> plane;
  std::size_t surface_points = 0;                          ///< that the plane rests on
  retina::Reason reason = retina::Reason::not_registered;  ///< of the registration; none when good
  retina::Reason plane_reason = retina::Reason::surface_unknown;

  bool good() const { return reason == retina::Reason::none && plane.has_value(); }
};

/// Registration and surface from one sweep, robustly. Allocates, some ms; not for the loop.
/// The tip itself is where the camera sees it; the spot is where its line of sight meets the beam.
CalibrationResult evaluate(const CalibrationSamples& samples, const CalibrationOptions& options = {});

/// Where a beam from the tip meets the line of sight of a pixel, by least squares along the beam; manipulator frame.
/// @return none where the beam runs along the line of sight, or the place is behind the tip or too far
std::optional<Eigen::Vector3d> placeOnBeam(const Registration& registration, const CalibrationSample& sample,
                                           double farthest);

}  // namespace eyeslam::servo
