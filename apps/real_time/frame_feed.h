// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>

#include "eyeslam/files/frame_ring.h"
#include "eyeslam/retina/pose2.h"
#include "eyeslam/simulation/eye_camera.h"
#include "real_time/exchange.h"
#include "real_time/real_time_loop.h"

namespace eyeslam::apps {

/// The camera: a thread that renders what the shutter recorded and writes it into shared memory. Where it is slower
/// than the frames come, the older ones are left out, as a camera's driver would.
class FrameFeed {
 public:
  /// @throws files::FileError  the ring cannot be made
  FrameFeed(simulation::EyeCamera camera, const std::string& name, double frames_per_second);

  /// For the hardware's thread, each cycle: hands over a frame without waiting; none: none is new.
  void show(std::optional<simulation::FrameDue> due);
  /// Frames written so far.
  std::int64_t frames() const { return frames_; }
  /// Whether rendering has failed; end() then says why.
  bool failed() const { return thread_.ended(); }
  /// @throws what rendering threw
  void end();

  /// Where the camera truly looked in the frame of that mid-exposure; none where it is no longer, or not yet, known.
  std::optional<retina::Pose2> truth(std::int64_t utime) const;

 private:
  struct Seen {
    std::int64_t utime = 0;
    retina::Pose2 map_T_frame;
  };
  static constexpr std::size_t kRemembered = 256;

  bool work();
  void remember(const Seen& seen);

  simulation::EyeCamera camera_;
  files::FrameRingWriter ring_;
  Exchange<std::unique_ptr<simulation::FrameDue>> place_;
  std::unique_ptr<simulation::FrameDue> pending_;  // the hardware's thread could not hand it over yet
  std::atomic<std::int64_t> frames_{0};
  mutable std::mutex mutex_;  // of seen_
  std::deque<Seen> seen_;
  RealTimeLoop thread_;  // last: it uses the others
};

}  // namespace eyeslam::apps
