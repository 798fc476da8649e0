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
  /// @param result  of this frame; its pose speaks full-resolution px
  virtual void onFrame(const files::VideoFrame& frame, const tracking::TrackResult& result,
                       baselines::Method& method) = 0;
  /// After the last frame, before results are renamed into place. @throws FileError when what was written is not whole
  virtual void finish() {}
  /// With all other results in place.
  virtual void publish() {}
};

}  // namespace eyeslam::apps
