// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

namespace eyeslam::trials {

/// A jump of the eye, and how long the tip took to be back.
struct Jump {
  double onset_s = 0.0;
  double way = 0.0;         ///< m, of the retina
  bool whole = true;        ///< no frame was refused or wrong until the deadline
  bool disturbed = false;   ///< another jump began before the deadline
  double recovery_s = 0.0;  ///< from the onset until the error was within the bound again; infinite: not in time
};

/// Follows errors and jumps, a sample a millisecond.
class JumpRecovery {
 public:
  /// @param bound  m, that counts as back; @param window_s  longest time looked at
  JumpRecovery(double bound, double window_s) : bound_(bound), window_s_(window_s) {}

  /// @param jumping  the eye jumps now; @param eye_x, eye_y  what its jumps have moved so far, m
  void step(double t_s, bool jumping, double eye_x, double eye_y, double error);
  /// A frame exposed at this instant was refused, or wrong.
  void spoilt(double t_s);

  /// Those whose window is over.
  const std::vector<Jump>& jumps() const { return done_; }

 private:
  double bound_, window_s_;
  bool jumping_ = false, open_ = false, exceeded_ = false, back_ = false;
  double from_x_ = 0.0, from_y_ = 0.0;
  Jump current_;
  std::vector<Jump> done_;
};

}  // namespace eyeslam::trials
