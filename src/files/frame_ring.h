// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/frame_ring_layout.h"
#include "eyeslam/files/shared_memory.h"

namespace eyeslam::files {

/// What all frames of a ring have in common.
struct FrameRingShape {
  cv::Size size;                    ///< px, 1 to 16384 each way
  int type = CV_8UC3;               ///< 8 or 16 bit, one (grey) or three (BGR) channels
  double frames_per_second = 30.0;  ///< nominal
  int slots = 8;                    ///< a reader has slots - 1 frame periods for its copy
};

/// What a camera knows of one frame.
struct FrameStampInRing {
  std::int64_t number = 0;       ///< from 0, growing; what the camera dropped is left out
  std::int64_t utime = 0;        ///< us since 1970, middle of the exposure
  std::int64_t exposure_us = 0;  ///< 0 = unknown
};

/// The writing end of `shm:NAME` (contracts, section 2): a ring of raw frames in POSIX shared memory, of which any
/// number of readers each take the newest. It never waits for a reader.
///
///   FrameRingWriter ring("eye", {image.size(), image.type(), 30.0});
///   while (grab(image)) ring.write(image, {number, utime, exposure_us});
class FrameRingWriter {
 public:
  /// Makes the ring; one that a dead writer left behind is replaced.
  /// @throws FileError  the name is unusable or used by another, the shape impossible, or memory short
  FrameRingWriter(const std::string& name, const FrameRingShape& shape);
  /// Tells the readers that this is the end, and removes the name.
  ~FrameRingWriter();
  FrameRingWriter(const FrameRingWriter&) = delete;
  FrameRingWriter& operator=(const FrameRingWriter&) = delete;

  /// A copy of the picture, 0.1 ms for 800 x 608; never waits, allocates or throws.
  /// @return false where the picture is not of the ring's size and type, or the stamp is impossible; nothing is written
  bool write(const cv::Mat& image, const FrameStampInRing& stamp) noexcept;

  const FrameRingShape& shape() const { return shape_; }

 private:
  std::string name_;
  FrameRingShape shape_;
  SharedMemory memory_;
  FrameRingHeader* header_ = nullptr;
  std::uint64_t frames_ = 0;
};

/// Part of the ring that both ends use.
namespace frame_ring {

/// The name of `shm:NAME`. @throws FileError when it is none
std::string nameOf(const std::string& input);
/// Bytes of a picture, and from one slot to the next.
std::size_t pictureBytes(const FrameRingShape& shape);
std::size_t slotBytes(const FrameRingShape& shape);
std::size_t ringBytes(const FrameRingShape& shape);
/// What is wrong with the shape; empty when nothing is.
std::string complaintAbout(const FrameRingShape& shape);

}  // namespace frame_ring
}  // namespace eyeslam::files
