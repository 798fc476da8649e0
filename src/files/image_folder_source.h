// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/files/video_source.h"

namespace eyeslam::files {

/// Image files as a video. All are decoded once on construction, so that a bad one is found before any work.
class ImageFolderSource : public VideoSource {
 public:
  /// @throws FileError naming the first image that is damaged, of a type that cannot be used, or unlike the first;
  ///                   or when `options.checking` ends it
  ImageFolderSource(std::vector<std::string> paths, const VideoSourceOptions& options);

  bool read(VideoFrame& frame) override;
  void skipTo(std::int64_t first) override { next_ = first; }
  std::optional<std::int64_t> announcedFrames() const override { return static_cast<std::int64_t>(paths_.size()); }
  double framesPerSecond() const override { return options_.frames_per_second; }
  std::vector<std::string> paths() const override { return paths_; }

 private:
  void checkAll();
  void sayChecked(std::int64_t count) const;
  cv::Mat load(const std::string& path, std::string& converted) const;

  std::vector<std::string> paths_;
  VideoSourceOptions options_;
  std::int64_t next_ = 0;
  bool grey_ = false;
};

}  // namespace eyeslam::files
