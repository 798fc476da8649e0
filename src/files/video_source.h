// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "eyeslam/files/file_error.h"

namespace eyeslam::files {

/// One picture of a video.
struct VideoFrame {
  cv::Mat image;            ///< 8 or 16 bit, one (grey) or three (BGR) channels; valid until the next frame is read
  std::int64_t number = 0;  ///< from 0, in the video
  double t = 0.0;           ///< s since frame 0
  std::int64_t utime = 0;   ///< us since 1970, middle of the exposure; 0 = the source does not know
  double exposure = 0.0;    ///< s; 0 = the source does not know
};

/// Frames one after another, all of one size and type.
class VideoSource {
 public:
  virtual ~VideoSource() = default;

  /// Reads the next frame into `frame`, whose memory is reused.
  /// @return false at the end
  /// @throws FileError when a frame is damaged, or missing although the file announces it
  virtual bool read(VideoFrame& frame) = 0;

  /// Goes on without decoding what can be left out; the next frame read is `first`.
  virtual void skipTo(std::int64_t first) = 0;

  /// How many frames the input announces, for a progress bar; nothing where it does not (a camera).
  virtual std::optional<std::int64_t> announcedFrames() const = 0;
  /// Nominal frames per second, for the overlay.
  virtual double framesPerSecond() const = 0;
  /// Whether frames come by themselves, so that one that repeats the last is a fault, and one that is late is lost.
  virtual bool isLive() const { return false; }
  /// Frames that came and went because the next one was there when they were asked for.
  virtual std::int64_t framesLeftOut() const { return 0; }
  /// Frames whose own time was none, or not after that of the frame before; `t` holds what was taken instead.
  virtual std::int64_t timesRepaired() const { return 0; }
  /// The files behind the source, for their hash; none for a camera.
  virtual std::vector<std::string> paths() const { return {}; }
  /// What was converted or looks doubtful, one line each; grows while reading.
  const std::vector<std::string>& notices() const { return notices_; }

 protected:
  std::vector<std::string> notices_;
};

struct VideoSourceOptions {
  double frames_per_second = 30.0;  ///< of images, which carry no time
  std::int64_t last_frame = -1;  ///< number of the last frame that will be asked for, -1 = all: damage after it is none
  std::function<double()> now;   ///< monotonic clock, s: the time of a camera's frames
  double patience = 5.0;         ///< s: how long a ring of frames, and each of its frames, is waited for
  std::function<bool()> stopped;  ///< asked while waiting for a ring's frame; true ends the source
  /// Called with how many images of a folder are checked, and how many there are; false ends the opening.
  std::function<bool(std::int64_t checked, std::int64_t all)> checking;
};

/// Opens a video file, an image folder, a glob of images, `camera:N`, or `shm:NAME`.
/// @throws FileError naming the input: missing, empty, no video, no images, images damaged or of differing size or
/// type,
///                   or ended by `checking`
std::unique_ptr<VideoSource> openVideoSource(const std::string& input, const VideoSourceOptions& options);

}  // namespace eyeslam::files
