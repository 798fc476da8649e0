// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/baselines/method.h"
#include "eyeslam/files/video_source.h"

namespace eyeslam::apps {

/// What is done with each frame after it was tracked: recording, overlay, window, messages.
class FrameObserver {
 public:
  virtual ~FrameObserver() = default;
  /// As soon as a frame was read, before it is tracked.
  virtual void onRead(const files::VideoFrame&) {}
  /// As soon as it was tracked, before its part of the map is worked on: for what somebody waits for.
  /// @param result  of this frame; its pose speaks full-resolution px
  virtual void onTracked(const files::VideoFrame&, const tracking::TrackResult&, baselines::Method&) {}
  /// With its part of the map worked on.
  virtual void onFrame(const files::VideoFrame& frame, const tracking::TrackResult& result,
                       baselines::Method& method) = 0;
  /// When what a frame gave cannot be written (disk full), so that the run ends without results.
  virtual void onFailure(const files::VideoFrame&, const tracking::TrackResult&, baselines::Method&) {}
  /// After the last frame, before results are renamed into place. @throws FileError when what was written is not whole
  virtual void finish() {}
  /// With all other results in place.
  virtual void publish() {}
};

}  // namespace eyeslam::apps
