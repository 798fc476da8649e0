// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/simulation/eye_motion.h"
#include "eyeslam/simulation/microscope.h"

namespace eyeslam::simulation {

/// Of the view for which the conditions state lengths in frame px; another view's are scaled by its own width.
inline constexpr double kUsualWidth_px = 800.0;

/// How the retina itself looks.
struct TissueOptions {
  double um_per_px = 5.3;
  double um_per_px_spread = 0.07;
  double contrast = 0.88;
  bool textured = true;
  double screen = 0.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("um_per_px", self.um_per_px, Range{0.5, 100}, "um",
                  "of a view 800 px wide; source: rendered sequences, 5-5.7, porcine 3.6");
    visitor.field("um_per_px_spread", self.um_per_px_spread, Range{0, 0.5}, "",
                  "by which seeds differ, up and down; source: our choice");
    visitor.field("contrast", self.contrast, Range{0, 2}, "",
                  "of vessels and texture against their surroundings; source: our choice, by eye");
    visitor.field("textured", self.textured, Range{0, 1}, "",
                  "whether there is anything to see between the vessels; source: our choice, for plain retinas");
    visitor.field("screen", self.screen, Range{0, 1}, "", "strength of a printer's screen; source: our choice, by eye");
  }
};

/// Everything that makes a kind of video.
struct Condition {
  std::string name;
  TissueOptions tissue;
  EyeMotionOptions motion;
  MicroscopeOptions microscope;
  double motion_factor = 1.0;      ///< multiplies the motion's lengths: the same eye at a higher magnification
  double jump_shortest_px = 60.0;  ///< by which the eye jumps while the light is out, px of a view 800 px wide
  double jump_longest_px = 160.0;
  int width = 800;  ///< usual size
  int height = 608;
};

/// The conditions that `--condition` knows: those of the sequences with truth (contracts, section 5).
const std::vector<const char*>& conditionNames();
/// @throws std::invalid_argument naming the word and those known
Condition condition(const std::string& name);

}  // namespace eyeslam::simulation
