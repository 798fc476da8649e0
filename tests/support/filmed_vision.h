// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "eyeslam/files/video_file.h"
#include "eyeslam/messaging/event_tap.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/vision/lock_step_tracker.h"
#include "support/moving_retina.h"
#include "support/written_log.h"

namespace eyeslam::support {

/// A camera over a moving retina, its tracker in lock step, the log of what that said, and the video beside it: 256 x
/// 192 px at 120 Hz with up to four frames on their way at a time, one of them a picture twice, and a registration that
/// says in the middle how large a px is.
class FilmedVision {
 public:
  static constexpr int kFrames = 180;
  static constexpr int kRepeated = 70;  ///< the same picture as the one before
  static constexpr double kRate = 120.0;
  static constexpr std::int64_t kSession = 9;

  static tracking::TrackerOptions options()
  {
    tracking::TrackerOptions options;
    options.frame.scale = 1.0;
    return options;
  }
  /// Steps of 2 to 3 px a frame that never repeat.
  static cv::Point place(int frame)
  {
    const double t = frame;
    return {
        cvRound(14.0 * std::sin(0.11 * t) + 5.0 * std::sin(0.53 * t * std::sqrt(2.0)) + 2.0 * std::sin(0.002 * t * t)),
        cvRound(11.0 * std::cos(0.09 * t) - 11.0 + 4.0 * std::sin(0.37 * t * std::sqrt(3.0)))};
  }

  FilmedVision()
  {
    const cv::Size size(256, 192);
    const MovingRetina retina(16.0);
    for (int k = 0; k < kFrames; ++k)
      pictures.push_back(k == kRepeated ? pictures.back().clone()
                                        : retina.view(size, place(k), static_cast<unsigned>(k)));
    run();
  }

  /// A video of some of the pictures.
  std::string film(const std::string& name, const std::vector<cv::Mat>& some) const
  {
    const std::string file = log.path(name);
    files::VideoFile video(file, name, files::VideoCoding::lossless, kRate);
    for (const cv::Mat& picture : some) video.add(picture);
    video.close();
    return file;
  }

  std::vector<cv::Mat> pictures;
  WrittenLog log;
  std::string path;  ///< of the log

 private:
  // Exposures are 4 ms; latencies differ from frame to frame and none overtakes another.
  void run()
  {
    messaging::Link link("memq://", kSession, std::nullopt);
    std::int64_t now = kLogStart;
    messaging::EventTap tap(link, [&](const messaging::TappedEvent& event) {
      log.add(std::string(event.channel), Bytes(event.data, event.data + event.size), event.utime);
    });
    vision::LockStepTracker tracker(options(), link, 0.0, kRate);
    messaging::Publisher<registration_t> registrations(link, "REGISTRATION", kSession + 1);
    int frame = 0;
    for (int ms = 0; ms < 1550; ++ms) {
      now = kLogStart + 1000 * ms;
      tap.setTime(now);
      const std::int64_t middle = kLogStart + std::llround(1e6 * frame / kRate);
      if (frame < kFrames && now >= middle + 2000) {
        const std::int64_t latency = 16000 + 900 * ((frame * 7) % 16);
        tracker.look(pictures[static_cast<std::size_t>(frame)], {middle, frame, 0.004}, middle + latency);
        ++frame;
      }
      tracker.send(now);
      if (ms == 700) {
        messaging::PublishedRegistration scale;
        scale.valid = true;
        scale.um_per_px = 4.5;
        registrations.publish(scale, now, now);
      }
      link.drain({now, now});
    }
    path = log.finish();
  }
};

}  // namespace eyeslam::support
