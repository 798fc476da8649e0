// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "eyeslam/files/video_file.h"
#include "eyeslam/tracking/overlay.h"
#include "track/frame_observer.h"

namespace eyeslam::apps {

/// `overlay.mp4`: the four panels, a picture a frame.
class OverlayWriter : public FrameObserver {
 public:
  /// @param path  where to write; `shown` names the file in messages
  OverlayWriter(const std::string& path, const std::string& shown, double frames_per_second,
                const tracking::OverlayOptions& options)
      : overlay_(options), video_(path, shown, files::VideoCoding::h264, frames_per_second)
  {}

  void onFrame(const files::VideoFrame& frame, const tracking::TrackResult& result, baselines::Method& method) override;
  void finish() override { video_.close(); }

 private:
  tracking::Overlay overlay_;
  files::VideoFile video_;
  baselines::Mosaic mosaic_;  // the last one fetched
  std::int64_t pictures_ = 0;
};

}  // namespace eyeslam::apps
