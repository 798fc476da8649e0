// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "eyeslam/retina/options.h"
#include "eyeslam/servo/timed_ring.h"

namespace eyeslam::servo {

struct SpotAimOptions {
  double shaft_ms = 20.0;
  double share = 0.2;
  double limit_um = 150.0;
  double gate_um = 300.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("shaft_ms", self.shaft_ms, Range{0, 1000}, "ms",
                  "low-pass of the shaft's direction, whose noise acts over the whole standoff; source: settles within "
                  "a dwell");
    visitor.field("share", self.share, Range{0, 1}, "",
                  "of a spot's surprise that is believed at once, 0 = none; source: half of it in 100 ms at 30 Hz");
    visitor.field("limit_um", self.limit_um, Range{0, 2000}, "um",
                  "largest correction; source: tan 30 deg of the surface's largest residual, several times");
    visitor.field("gate_um", self.gate_um, Range{1, 5000}, "um",
                  "a spot seen farther from where it is expected is another one; source: twice the limit");
  }
};

/// Where the beam meets the retina: from tip and shaft, corrected by where the camera sees the spot (the image part of
/// the hybrid servo, facts E4). The correction has no loop through the plant: it compares a spot that was seen with the
/// one calculated for that very moment. Retina frame, m. Never throws, never allocates.
class SpotAim {
 public:
  explicit SpotAim(const SpotAimOptions& options = {}) noexcept;

  /// Each cycle. What is not finite, not later than the last, or a beam that runs along the retina is ignored.
  void observe(std::int64_t utime, const Eigen::Vector3d& tip, const Eigen::Vector3d& shaft) noexcept;
  /// A spot that was seen. @return whether it was believed
  bool correct(std::int64_t utime, const Eigen::Vector2d& seen) noexcept;
  /// Nothing is known any more.
  void reset() noexcept;

  bool isReady() const noexcept { return !spots_.empty(); }
  /// Of the newest beam; not before it is ready.
  std::int64_t utime() const noexcept { return spots_.utime(0); }
  /// Where the tip must be for the spot to lie on a place.
  Eigen::Vector3d tipFor(const Eigen::Vector2d& place, double standoff) const noexcept;
  /// Where the spot is, mean of 5 ms; not for a beam that is not ready.
  Eigen::Vector2d spot() const noexcept;
  const Eigen::Vector2d& correction() const noexcept { return correction_; }

 private:
  double shaft_s_, share_, limit_, gate_;
  Eigen::Vector2d slope_ = Eigen::Vector2d::Zero();  // lateral way of the beam per way into the retina
  Eigen::Vector2d correction_ = Eigen::Vector2d::Zero();
  TimedRing<Eigen::Vector2d, 512> spots_;  // as calculated, not corrected
  std::int64_t seen_utime_ = 0;
};

}  // namespace eyeslam::servo
