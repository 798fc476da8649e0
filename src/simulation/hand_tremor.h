// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "eyeslam/retina/options.h"
#include "eyeslam/simulation/shaped_noise.h"

namespace eyeslam::simulation {

/// What a hand does without meaning to, per axis. Pairs (low, high) are drawn once per seed.
struct HandTremorOptions {
  double tremor_hz = 10.0;
  double tremor_width_hz = 4.0;
  double tremor_low_um = 50.0;
  double tremor_high_um = 100.0;
  double drift_hz = 0.5;
  double drift_low_um = 40.0;
  double drift_high_um = 90.0;
  double lean_hz = 0.15;
  double lean_um = 150.0;
  double lean_rise_s = 2.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("tremor_hz", self.tremor_hz, Range{1, 50}, "Hz",
                  "middle of the tremor's band; source: facts, C4: 8-12 Hz");
    visitor.field("tremor_width_hz", self.tremor_width_hz, Range{0.1, 40}, "Hz",
                  "width of each of two band-passes in a row; source: loop study, 1");
    visitor.field("tremor_low_um", self.tremor_low_um, Range{0, 1000}, "um",
                  "smallest RMS per axis; source: loop study, 1, facts, C4");
    visitor.field("tremor_high_um", self.tremor_high_um, Range{0, 1000}, "um",
                  "largest RMS per axis; source: loop study, 1, facts, C4");
    visitor.field("drift_hz", self.drift_hz, Range{0.01, 5}, "Hz", "highest frequency of the drift; source: facts, C4");
    visitor.field("drift_low_um", self.drift_low_um, Range{0, 1000}, "um",
                  "smallest RMS per axis; source: loop study, 1");
    visitor.field("drift_high_um", self.drift_high_um, Range{0, 1000}, "um",
                  "largest RMS per axis; source: loop study, 1");
    visitor.field("lean_hz", self.lean_hz, Range{0.01, 5}, "Hz",
                  "highest frequency of the lean against a fixture; source: loop study, 1");
    visitor.field("lean_um", self.lean_um, Range{0, 2000}, "um",
                  "RMS per axis of the lean against a fixture; source: loop study, 1");
    visitor.field("lean_rise_s", self.lean_rise_s, Range{0, 60}, "s",
                  "how long a hand takes to lean on a fixture, and to stop; source: assumption");
  }
};

/// Tremor, drift and lean of one hand: what is added to where the surgeon means to hold the instrument.
///
///   HandTremor tremor({}, seed);
///   const HandTremor::Displacement& moved = tremor.step(HandTremor::Support::fixture);  // every 1 ms
///   null = surgeon + moved.sum();
///
/// Three axes, stationary from the first sample on; never allocates. Source: loop study, section 1; facts, C4.
class HandTremor {
 public:
  enum class Support {
    none,    ///< the hand holds the tip itself
    fixture  ///< a fixture holds the tip, so the hand leans on it unnoticed
  };

  /// All in metres.
  struct Displacement {
    Eigen::Vector3d tremor = Eigen::Vector3d::Zero();
    Eigen::Vector3d drift = Eigen::Vector3d::Zero();
    Eigen::Vector3d lean = Eigen::Vector3d::Zero();

    Eigen::Vector3d sum() const { return tremor + drift + lean; }
  };

  HandTremor(const HandTremorOptions& options, std::uint64_t seed, double period_s = 1e-3);

  /// One period later.
  const Displacement& step(Support support);

  /// What this seed's hand has, RMS per axis, m.
  double tremorRms() const { return tremor_rms_; }
  double driftRms() const { return drift_rms_; }

 private:
  struct Axis {
    ShapedNoise tremor, drift, lean;
  };

  static Axis axis(const HandTremorOptions& options, std::uint64_t seed, int number, double period_s);

  double tremor_rms_, drift_rms_, lean_rms_;
  double lean_step_;        // share of the lean that comes or goes in a period
  double lean_part_ = 0.0;  // how far the hand leans, [0, 1]
  std::array<Axis, 3> axes_;
  Displacement displacement_;
};

}  // namespace eyeslam::simulation
