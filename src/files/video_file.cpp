// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/video_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <system_error>

#include "eyeslam/files/file_error.h"

namespace eyeslam::files {
namespace {

// The container's count first; where it is only an estimate, the frames themselves.
std::int64_t framesIn(const std::string& path, std::int64_t expected)
{
  cv::VideoCapture capture(path, cv::CAP_FFMPEG);
  if (!capture.isOpened()) return 0;
  if (static_cast<std::int64_t>(capture.get(cv::CAP_PROP_FRAME_COUNT)) == expected) return expected;
  std::int64_t count = 0;
  while (capture.grab()) ++count;
  return count;
}

}  // namespace

VideoFile::VideoFile(std::string path, std::string shown, VideoCoding coding, double frames_per_second)
    : path_(std::move(path)), shown_(std::move(shown)), coding_(coding), rate_(frames_per_second)
{}

void VideoFile::open(const cv::Mat& image)
{
  if (image.depth() != CV_8U) throw FileError(shown_ + ": a video holds 8-bit frames only, these have 16 bit");
  // OpenCV's writer rounds down to even sizes, without a word.
  size_ = {image.cols & ~1, image.rows & ~1};
  if (coding_ == VideoCoding::lossless && size_ != image.size()) {
    throw FileError(fmt::format("{}: frames of {} x {} cannot be kept without loss; even sizes are wanted", shown_,
                                image.cols, image.rows));
  }
  const int code = coding_ == VideoCoding::h264 ? cv::VideoWriter::fourcc('a', 'v', 'c', '1')
                                                : cv::VideoWriter::fourcc('H', 'F', 'Y', 'U');
  if (size_.empty() || !writer_.open(path_, cv::CAP_FFMPEG, code, rate_, size_)) {
    throw FileError(fmt::format("{}: the encoder does not take {} x {} frames", shown_, image.cols, image.rows));
  }
}

void VideoFile::add(const cv::Mat& image)
{
  if (count_ == 0) open(image);
  if (image.cols < size_.width || image.rows < size_.height || image.depth() != CV_8U) {
    throw FileError(shown_ + ": a frame differs in size or type from the first");
  }
  const cv::Mat part = image(cv::Rect({0, 0}, size_));
  if (image.channels() == 1) cv::cvtColor(part, colour_, cv::COLOR_GRAY2BGR);
  writer_.write(image.channels() == 1 ? colour_ : part);
  ++count_;
  if (coding_ == VideoCoding::lossless) checkGrowth();
}

// OpenCV's writer does not tell that the disk is full. A frame has a bit a sample at least, and its bytes wait in a
// buffer of FFmpeg's for a while.
void VideoFile::checkGrowth()
{
  constexpr std::int64_t kBuffer = 256 * 1024;  // bytes; FFmpeg has 32 KiB
  std::error_code none;
  const std::uintmax_t bytes = std::filesystem::file_size(path_, none);
  const bool grew = !none && bytes > bytes_;
  frames_unseen_ = grew ? 0 : frames_unseen_ + 1;
  if (grew) bytes_ = bytes;
  if (frames_unseen_ * 3 * size_.area() / 8 <= kBuffer) return;
  throw FileError(fmt::format("{}: cannot be written beyond {} bytes; is the disk full?", shown_, bytes_));
}

void VideoFile::close()
{
  if (count_ == 0) return;
  writer_.release();
  const std::int64_t found = framesIn(path_, count_);
  if (found != count_) {
    throw FileError(fmt::format("{}: only {} of {} frames arrived; is the disk full?", shown_, found, count_));
  }
}

}  // namespace eyeslam::files
