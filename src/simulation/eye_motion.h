// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/pose2.h"
#include "eyeslam/simulation/random.h"
#include "eyeslam/simulation/view_motion.h"

namespace eyeslam::simulation {

/// How the retina moves under the microscope. Lengths in frame px of a view 800 px wide; `EyeMotion` scales them.
struct EyeMotionOptions {
  double drift_px = 25.0;
  double drift_hz = 0.15;
  double rotation_deg = 2.0;
  double tremor_px = 0.15;
  double tremor_hz = 5.0;
  double breath_px = 0.0;
  double pulse_px = 0.0;
  double jerk_interval_s = 0.0;
  double jerk_shortest_px = 20.0;
  double jerk_longest_px = 60.0;
  double jerk_ms = 130.0;
  double jerk_rotation_deg = 0.4;
  double reach_px = 160.0;
  double excursion_px = 0.0;
  double excursion_period_s = 7.0;
  double scale_change = 0.0;
  double scale_period_s = 12.0;
  double warp_px = 0.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("drift_px", self.drift_px, Range{0, 1000}, "px",
                  "amplitude of the slow drift; source: rendered sequences, 40-150 px of travel");
    visitor.field("drift_hz", self.drift_hz, Range{0.01, 2}, "Hz",
                  "middle frequency of the drift; source: rendered sequences, 1-5 px a frame");
    visitor.field("rotation_deg", self.rotation_deg, Range{0, 45}, "deg",
                  "amplitude of the slow rotation; source: rendered sequences, 2-11 deg");
    visitor.field("tremor_px", self.tremor_px, Range{0, 20}, "px",
                  "amplitude of the fine tremor; source: our choice, below what a view shows");
    visitor.field("tremor_hz", self.tremor_hz, Range{1, 15}, "Hz",
                  "middle frequency of the tremor; source: our choice, under half the frame rate");
    visitor.field("breath_px", self.breath_px, Range{0, 100}, "px",
                  "amplitude at 0.25 Hz; source: facts, D: 50-300 um proposed");
    visitor.field("pulse_px", self.pulse_px, Range{0, 100}, "px", "amplitude at 1.1 Hz; source: facts, D");
    visitor.field("jerk_interval_s", self.jerk_interval_s, Range{0, 100}, "s",
                  "mean time between jerks, 0 = none; source: rendered sequences, 1-2 s");
    visitor.field("jerk_shortest_px", self.jerk_shortest_px, Range{0, 2000}, "px",
                  "smallest jerk; source: 20 px in vivo, 40 px ex vivo, saccades 100 px");
    visitor.field("jerk_longest_px", self.jerk_longest_px, Range{0, 2000}, "px",
                  "largest jerk; source: 60 px in vivo, 120 px ex vivo, saccades 260 px");
    visitor.field("jerk_ms", self.jerk_ms, Range{5, 2000}, "ms",
                  "how long a jerk lasts; source: rendered sequences, 4 frames, saccades 1-2");
    visitor.field("jerk_rotation_deg", self.jerk_rotation_deg, Range{0, 45}, "deg",
                  "largest turn of a jerk; source: our choice");
    visitor.field(
        "reach_px", self.reach_px, Range{0, 5000}, "px",
        "jerks beyond this distance from the start go back; source: our choice, keeps the view on the retina");
    visitor.field("excursion_px", self.excursion_px, Range{0, 5000}, "px",
                  "how far the view leaves and returns, 0 = never; source: rendered sequences, 600 px");
    visitor.field("excursion_period_s", self.excursion_period_s, Range{0.5, 1000}, "s",
                  "one way out and back; source: our choice");
    visitor.field("scale_change", self.scale_change, Range{0, 0.5}, "",
                  "amplitude of the magnification; source: rendered sequences, 0.06");
    visitor.field("scale_period_s", self.scale_period_s, Range{0.5, 1000}, "s",
                  "one period of the magnification; source: our choice");
    visitor.field(
        "warp_px", self.warp_px, Range{0, 50}, "px",
        "smooth warp at half the view's width from its centre, where it vanishes with its slope; source: our choice");
  }
};

/// The motions that `--motion` knows.
const std::vector<const char*>& eyeMotionNames();
/// @throws std::invalid_argument naming the word and those known
EyeMotionOptions eyeMotionOptions(const std::string& name);

/// The pose of the view as a function of time, map_T_frame in frame px (contracts, section 1), the identity at t = 0.
/// A continuous function: a renderer may ask for any instant within an exposure. Repeatable to the byte per seed.
/// For videos in which no hand acts on the eye. Where one does, at 1 kHz and in metres, `RetinaMotion` is the model.
class EyeMotion : public ViewMotion {
 public:
  /// @param px_scale  width of the view / 800 px, times further magnification
  EyeMotion(const EyeMotionOptions& options, double px_scale, double duration_s, std::uint64_t seed);

  retina::Pose2 at(double t_s) const override;
  /// Adds a jump of `length_px` towards `angle` (rad) at an instant after the start.
  void addJump(double t_s, double length_px, double angle);
  std::array<double, 6> warpAt(double t_s) const override;

 private:
  struct Wave {
    double amplitude, hz, phase;
    double at(double t) const;
  };
  struct Jerk {
    double start_s, duration_s, x, y, theta;
  };

  void addWaves(std::vector<Wave>& waves, double amplitude, double hz, int count, Random& random);
  void planJerks(double duration_s, Random& random);
  retina::Pose2 raw(double t_s) const;

  EyeMotionOptions options_;
  double px_scale_;
  double excursion_angle_ = 0.0;
  std::vector<Wave> x_, y_, theta_;
  std::array<Wave, 6> warp_{};
  std::vector<Jerk> jerks_;
  retina::Pose2 start_;
};

}  // namespace eyeslam::simulation
