// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>
#include <visp3/gui/vpDisplayX.h>

#include "track/frame_observer.h"

namespace eyeslam::apps {

/// `--display`: each frame in a window, with the map's vessels and the instrument.
class TrackWindow : public FrameObserver {
 public:
  /// @throws UsageError when there is no screen
  TrackWindow();

  void onFrame(const files::VideoFrame& frame, const tracking::TrackResult& result, baselines::Method& method) override;

 private:
  void open();

  vpImage<vpRGBa> image_;
  vpDisplayX window_;
};

}  // namespace eyeslam::apps
