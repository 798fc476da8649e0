// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/video_source.h"

#include <charconv>
#include <filesystem>

#include "eyeslam/files/camera_source.h"
#include "eyeslam/files/frame_ring_source.h"
#include "eyeslam/files/image_folder_source.h"
#include "eyeslam/files/image_names.h"
#include "eyeslam/files/video_file_source.h"

namespace eyeslam::files {
namespace {

namespace fs = std::filesystem;

bool hasPrefix(const std::string& text, const std::string& prefix)
{
  return text.compare(0, prefix.size(), prefix) == 0;
}

int cameraNumber(const std::string& input)
{
  const char* const first = input.data() + std::string("camera:").size();
  const char* const end = input.data() + input.size();
  int number = -1;
  const auto [rest, error] = std::from_chars(first, end, number);
  if (error != std::errc() || rest != end || number < 0) {
    throw FileError(input + ": a camera's number is wanted, as in camera:0");
  }
  return number;
}

void checkFile(const std::string& input)
{
  std::error_code error;
  if (!fs::exists(input, error))
    throw FileError(input + ": does not exist; a video file, image folder, glob, camera:N or shm:NAME is wanted");
  if (!fs::is_regular_file(input, error)) throw FileError(input + ": is neither a file nor a folder");
  if (fs::file_size(input, error) == 0) throw FileError(input + ": is empty");
}

}  // namespace

std::unique_ptr<VideoSource> openVideoSource(const std::string& input, const VideoSourceOptions& options)
{
  std::error_code error;
  if (hasPrefix(input, "camera:")) return std::make_unique<CameraSource>(cameraNumber(input), options);
  if (hasPrefix(input, "shm:")) return std::make_unique<FrameRingSource>(input, options);
  if (fs::is_directory(input, error) || isGlob(input)) {
    return std::make_unique<ImageFolderSource>(imagesOf(input), options);
  }
  checkFile(input);
  if (isImageName(input)) return std::make_unique<ImageFolderSource>(std::vector<std::string>{input}, options);
  return std::make_unique<VideoFileSource>(input, options);
}

}  // namespace eyeslam::files
