// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/video_file_source.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <string_view>

#include "eyeslam/files/pixel_format.h"

namespace eyeslam::files {
namespace {

constexpr int kProbedFrames = 60;

// FFmpeg takes "2026-11-25T21:30.mp4" for a protocol and its address; a whole path it takes for a file.
cv::VideoCapture openFile(const std::string& path)
{
  return cv::VideoCapture(std::filesystem::absolute(path).string(), cv::CAP_FFMPEG);
}

bool isMp4(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  std::array<char, 8> head{};
  file.read(head.data(), head.size());
  return file && std::string_view(head.data() + 4, 4) == "ftyp";
}

// The decoder always gives BGR: whether a camera was grey shows in the first frames that are not dark.
bool showsGrey(const std::string& path)
{
  cv::VideoCapture capture = openFile(path);
  cv::Mat image;
  for (int i = 0; i < kProbedFrames && capture.read(image); ++i) {
    if (isLit(image)) return hasEqualChannels(image);
  }
  return false;
}

}  // namespace

VideoFileSource::VideoFileSource(const std::string& path, const VideoSourceOptions& options)
    : path_(path),
      options_(options),
      capture_(openFile(path)),
      rate_(capture_.get(cv::CAP_PROP_FPS)),
      count_is_evidence_(isMp4(path)),
      times_(rate_)
{
  if (!capture_.isOpened()) {
    throw FileError(path + ": is no video that FFmpeg can read (another format, or its end is cut off)");
  }
  announced_ = static_cast<std::int64_t>(capture_.get(cv::CAP_PROP_FRAME_COUNT));
  grey_ = showsGrey(path);
  if (grey_) notices_.push_back(path + ": all channels are equal; taken as grey");
}

bool VideoFileSource::grab()
{
  if (options_.last_frame >= 0 && grabbed_ > options_.last_frame) return false;
  if (!capture_.grab()) {
    checkCompleteness();
    return false;
  }
  time_ = times_.next(capture_.get(cv::CAP_PROP_POS_MSEC));
  ++grabbed_;
  return true;
}

bool VideoFileSource::read(VideoFrame& frame)
{
  if (!grab()) return false;
  frame.number = grabbed_ - 1;
  frame.t = time_;
  take(frame.image);
  return true;
}

void VideoFileSource::take(cv::Mat& image)
{
  cv::Mat& decoded = grey_ ? colour_ : image;
  if (!capture_.retrieve(decoded) || decoded.empty()) {
    throw FileError(fmt::format("{}: frame {} cannot be decoded; --to {} uses what is before it", path_, grabbed_ - 1,
                                grabbed_ - 2));
  }
  checkSize(decoded);
  if (grey_) cv::extractChannel(decoded, image, 1);
}

void VideoFileSource::checkSize(const cv::Mat& image)
{
  if (size_.empty()) size_ = image.size();
  if (image.size() == size_) return;
  throw FileError(fmt::format("{}: frame {} is {} x {}, those before it {} x {}; --to {} uses those", path_,
                              grabbed_ - 1, image.cols, image.rows, size_.width, size_.height, grabbed_ - 2));
}

void VideoFileSource::skipTo(std::int64_t first)
{
  while (grabbed_ < first && grab()) continue;
}

// A damaged packet ends decoding like a normal end; only the announced count tells.
void VideoFileSource::checkCompleteness()
{
  if (grabbed_ == 0) throw FileError(path_ + ": holds no frame; a video with at least one is wanted");
  if (grabbed_ >= announced_) return;
  if (count_is_evidence_) {
    throw FileError(fmt::format("{}: damaged: {} frames announced, the last good one is {}; --to {} uses those", path_,
                                announced_, grabbed_ - 1, grabbed_ - 1));
  }
  notices_.push_back(fmt::format("{}: {} frames could be read, about {} were announced; it may be cut off", path_,
                                 grabbed_, announced_));
}

std::optional<std::int64_t> VideoFileSource::announcedFrames() const
{
  if (announced_ <= 0) return std::nullopt;
  return announced_;
}

}  // namespace eyeslam::files
