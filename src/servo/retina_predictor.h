// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "eyeslam/retina/pose2.h"
#include "eyeslam/retina/reason.h"
#include "eyeslam/servo/motion_filter.h"
#include "eyeslam/servo/port_signals.h"
#include "eyeslam/servo/retina_predictor_options.h"

namespace eyeslam::servo {

/// A pose that the tracker found.
struct SeenPose {
  std::int64_t utime = 0;       ///< mid-exposure
  retina::Pose2 view_T_retina;  ///< m, about the image centre
  double sigma = 0.0;           ///< m, per axis; 0: not known
  double sigma_theta = 0.0;     ///< rad; 0: not known
};

/// Where the retina is expected to be.
struct PredictedPose {
  retina::Pose2 view_T_retina;                         ///< m, about the image centre
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< m/s, of what the port does not explain
  double sigma = 0.0;                                  ///< m, of the less certain axis; grows with the age
  double sigma_theta = 0.0;                            ///< rad
  double age_s = 0.0;                                  ///< from the newest pose's exposure to the time predicted
};

/// The retina at any time from poses that come late and seldom: a Kalman filter per axis at the capture times, fed with
/// the port's displacement, which tells what the instrument does to the eye before a camera sees it. A surprise that is
/// too large is a jump: the position is taken, its speed is not. Angle and scale are filtered alike, without the port.
///
///   RetinaPredictor retina({});
///   each cycle: retina.observePort(state.utime, state.port);
///               if (pose) retina.correct(*pose, now);
///               const PredictedPose there = retina.at(now + lead);
///
/// Source: loop study, sections 2.2, 2.3. Never throws, never allocates.
class RetinaPredictor {
 public:
  explicit RetinaPredictor(const RetinaPredictorOptions& options);

  /// One measured displacement of the port; m, in a frame that stays.
  /// @return none; state_late, state_not_finite: refused
  retina::Reason observePort(std::int64_t utime, const Eigen::Vector2d& port) noexcept;
  /// Takes a pose. @param now  not before any exposure
  /// @return none; pose_jumped: taken, or waiting for a second frame; pose_late, pose_not_finite: refused
  retina::Reason correct(const SeenPose& seen, std::int64_t now) noexcept;

  bool isReady() const noexcept { return ready_; }
  /// Exposure of the newest pose that was not refused.
  std::int64_t utime() const noexcept { return utime_; }
  /// How far that pose was from where it was expected, m.
  double surprise() const noexcept { return surprise_; }
  /// When the newest jump was taken; 0 before any.
  std::int64_t jumpUtime() const noexcept { return jump_utime_; }
  /// Identity before the first pose.
  PredictedPose at(std::int64_t utime) const noexcept;

 private:
  enum Axis : std::size_t { kX, kY, kTheta, kScale, kAxes };
  using Filters = std::array<MotionFilter, kAxes>;
  using Numbers = std::array<double, kAxes>;

  struct Sight {
    Numbers measured, variance;
    MotionFilter::Signals signals;  // of the port at the exposure
  };
  struct Verdict {
    double surprise = 0.0;  // m
    bool within = true;
  };

  Numbers accelerations() const noexcept;
  MotionFilter::Signals signalsFor(std::size_t axis, const MotionFilter::Signals& port) const noexcept;
  Sight sight(const SeenPose& seen) const noexcept;
  void advance(Filters& filters, double time_s) const noexcept;
  Verdict judge(const Filters& filters, const Sight& sight) const noexcept;
  void update(Filters& filters, const Sight& sight) const noexcept;
  Filters jumped(const Filters& filters, const Sight& sight) const noexcept;
  retina::Reason decide(const Sight& sight, std::int64_t utime, double passed) noexcept;
  void begin(const Sight& sight) noexcept;
  void dropSilentPort(std::int64_t now) noexcept;

  RetinaPredictorOptions options_;
  PortSignals port_;
  Filters filters_;
  Filters other_;          // after a jump what is not believed: without it, or, while it is in doubt, with it
  bool doubtful_ = false;  // the newest pose was a jump, so the next one decides
  double interval_s_;      // between frames, running mean
  std::int64_t utime_ = 0;
  std::int64_t jump_utime_ = 0;
  double surprise_ = 0.0;
  bool ready_ = false;
};

}  // namespace eyeslam::servo
