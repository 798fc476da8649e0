// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/picture_file.h"

#include <fmt/format.h>

#include <opencv2/imgcodecs.hpp>

#include "eyeslam/files/file_error.h"

namespace eyeslam::files {

cv::Mat readPicture(const std::string& what, const std::string& path, int mode, const std::string& wanted)
{
  cv::Mat image;
  try {
    image = cv::imread(path, mode);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty())
    throw FileError(fmt::format("{} {}: not a picture that can be read; {} is wanted", what, path, wanted));
  return image;
}

}  // namespace eyeslam::files
