// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace eyeslam::files {

/// Turns the position that a decoder reports after each frame into times that increase.
///
/// FFmpeg through OpenCV reports 0 for the last frames of H.264 with B-frames, and repeats a position where a container
/// rounds; such a frame follows its predecessor by the nominal period.
class FrameTimes {
 public:
  /// @param frames_per_second  nominal rate; 30 is taken for what is not positive
  explicit FrameTimes(double frames_per_second);

  /// @param position_ms  as reported after reading the frame
  /// @return time of the frame, s since the first one
  double next(double position_ms);
  /// Frames so far whose position was no time after the frame before.
  std::int64_t repaired() const { return repaired_; }

 private:
  double period_;
  double first_ = 0.0;
  double last_ = 0.0;
  std::int64_t count_ = 0, repaired_ = 0;
};

}  // namespace eyeslam::files
