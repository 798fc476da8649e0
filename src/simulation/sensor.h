// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "eyeslam/retina/options.h"
#include "eyeslam/simulation/random.h"

namespace eyeslam::simulation {

struct SensorOptions {
  double read_noise = 1.3;
  double shot_noise = 0.19;
  double black = 2.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    using retina::Range;
    visitor.field("read_noise", self.read_noise, Range{0, 64}, "grey levels",
                  "standard deviation in the dark; source: our choice, by eye");
    visitor.field("shot_noise", self.shot_noise, Range{0, 4}, "grey levels per root grey level",
                  "noise that grows with the root of the light; source: our choice, by eye");
    visitor.field("black", self.black, Range{0, 64}, "grey levels",
                  "offset of the darkest place; source: rendered sequences, 1-3");
  }
};

/// Turns light into an 8-bit picture with noise.
class Sensor {
 public:
  Sensor(const SensorOptions& options, std::uint64_t seed);

  /// @param light   CV_32FC4, BGR in its first three channels, 1 = white
  /// @param passed  share of it that comes through, of its size; times `on`, share of the time
  void read(const cv::Mat& light, const cv::Mat_<float>& passed, float on, cv::Mat_<cv::Vec3b>& picture);

 private:
  void repeatTable(std::size_t length);

  SensorOptions options_;
  Random random_;
  std::vector<float> table_;      // normal numbers; each row begins at a place of its own
  std::vector<float> deviation_;  // by grey level
  std::vector<float> levels_;     // of one row
};

}  // namespace eyeslam::simulation
