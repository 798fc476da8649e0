// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/encoded_video.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <opencv2/videoio.hpp>
#include <utility>
#include <vector>

#include "eyeslam/files/file_error.h"

namespace eyeslam::files {
namespace {

// Starts `ffmpeg` with standard input from `input`; -1 when it does not start.
pid_t startEncoder(const std::vector<std::string>& arguments, int input)
{
  std::vector<char*> words;
  words.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t process = -1;
  const int error = posix_spawnp(&process, "ffmpeg", &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return error == 0 ? process : -1;
}

int exitStatus(pid_t process)
{
  int status = 0;
  while (waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) return -1;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

EncodedVideo::EncodedVideo(const std::string& path, std::string shown, cv::Size size, double frames_per_second, int crf)
    : path_(path), shown_(std::move(shown)), size_(size)
{
  // A socket pair and not a pipe: a write to it can be told not to raise SIGPIPE.
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) fail(std::strerror(errno));
  // As many threads on every machine: x264's choices depend on their number, and equal seeds shall give equal files.
  encoder_ = startEncoder({"ffmpeg",   "-v",
                           "error",    "-y",
                           "-f",       "rawvideo",
                           "-pix_fmt", "bgr24",
                           "-s",       fmt::format("{}x{}", size.width, size.height),
                           "-r",       fmt::format("{}", frames_per_second),
                           "-i",       "-",
                           "-c:v",     "libx264",
                           "-preset",  "medium",
                           "-crf",     fmt::format("{}", crf),
                           "-threads", "3",
                           "-pix_fmt", "yuv420p",
                           "-f",       "mp4",
                           path},
                          ends[0]);
  ::close(ends[0]);
  pipe_ = ends[1];
  if (encoder_ < 0) fail("the program ffmpeg does not start; install the package ffmpeg");
}

EncodedVideo::EncodedVideo(EncodedVideo&& other) noexcept
    : path_(std::move(other.path_)),
      shown_(std::move(other.shown_)),
      size_(other.size_),
      encoder_(std::exchange(other.encoder_, -1)),
      pipe_(std::exchange(other.pipe_, -1)),
      count_(other.count_)
{}

EncodedVideo::~EncodedVideo() { finish(); }

void EncodedVideo::add(const cv::Mat& image)
{
  CV_Assert(image.type() == CV_8UC3 && image.size() == size_);
  const std::size_t row_bytes = 3 * static_cast<std::size_t>(image.cols);
  const bool whole = image.isContinuous();
  const int pieces = whole ? 1 : image.rows;
  for (int piece = 0; piece < pieces; ++piece) {
    const std::uint8_t* bytes = image.ptr(piece);
    std::size_t left = whole ? row_bytes * static_cast<std::size_t>(image.rows) : row_bytes;
    while (left > 0) {
      const ssize_t sent = send(pipe_, bytes, left, MSG_NOSIGNAL);
      if (sent < 0 && errno == EINTR) continue;
      if (sent < 0) fail("the encoder ended early; is the disk full?");
      bytes += sent;
      left -= static_cast<std::size_t>(sent);
    }
  }
  ++count_;
}

void EncodedVideo::close()
{
  if (finish() != 0) fail("the encoder failed; is the disk full?");
  cv::VideoCapture capture(path_, cv::CAP_FFMPEG);
  const auto found = capture.isOpened() ? static_cast<std::int64_t>(capture.get(cv::CAP_PROP_FRAME_COUNT)) : 0;
  if (found != count_) fail(fmt::format("only {} of {} frames arrived; is the disk full?", found, count_));
}

int EncodedVideo::finish()
{
  if (pipe_ >= 0) ::close(pipe_);
  pipe_ = -1;
  const int status = encoder_ > 0 ? exitStatus(encoder_) : 0;
  encoder_ = -1;
  return status;
}

void EncodedVideo::fail(const std::string& cause) const { throw FileError(shown_ + ": " + cause); }

}  // namespace eyeslam::files
