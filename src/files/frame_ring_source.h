// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/files/frame_ring.h"
#include "eyeslam/files/video_source.h"

namespace eyeslam::files {

/// The reading end of `shm:NAME`: always the newest frame, whole; what came in between is left out and counted. Waits
/// for the ring, and for frames, as long as `options.patience` says (not at all without `options.now`). Ends when the
/// writer ends, dies or is silent, and says so in a notice.
class FrameRingSource : public VideoSource {
 public:
  /// @param input    `shm:NAME`
  /// @param options  `stopped` ends waiting
  /// @throws FileError  there is none, or what is there is foreign, damaged or too small
  FrameRingSource(const std::string& input, const VideoSourceOptions& options);

  bool read(VideoFrame& frame) override;
  void skipTo(std::int64_t first) override { first_ = first; }
  std::optional<std::int64_t> announcedFrames() const override { return std::nullopt; }
  double framesPerSecond() const override { return shape_.frames_per_second; }
  bool isLive() const override { return true; }
  std::int64_t framesLeftOut() const override { return left_out_; }

 private:
  void open();
  bool tryOpen();
  const FrameRingHeader& header() const { return *reinterpret_cast<const FrameRingHeader*>(memory_.data()); }
  bool readNewest(VideoFrame& frame);
  bool copyNewest(VideoFrame& frame);
  bool isOver();
  bool isStopped() const { return options_.stopped && options_.stopped(); }

  std::string input_;
  VideoSourceOptions options_;
  SharedMemory memory_;
  FrameRingShape shape_;
  std::uint64_t read_ = 0;  // frames of the ring, read or left out
  std::int64_t left_out_ = 0;
  std::int64_t first_ = 0;
  std::int64_t first_utime_ = 0;
  std::int64_t last_number_ = -1;
};

}  // namespace eyeslam::files
