// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/files/partial_file.h"
#include "eyeslam/files/video_file.h"
#include "track/frame_observer.h"

namespace eyeslam::apps {

/// `--record`: each processed frame in a lossless video.
class Recorder : public FrameObserver {
 public:
  Recorder(const std::string& path, double frames_per_second)
      : file_(path), video_(file_.partialPath(), path, files::VideoCoding::lossless, frames_per_second)
  {}

  void onFrame(const files::VideoFrame& frame, const tracking::TrackResult&, baselines::Method&) override
  {
    video_.add(frame.image);
  }
  void finish() override { video_.close(); }
  void publish() override { file_.publish(); }

 private:
  files::PartialFile file_;
  files::VideoFile video_;
};

}  // namespace eyeslam::apps
