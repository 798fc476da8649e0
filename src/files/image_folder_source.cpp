// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/image_folder_source.h"

#include <fmt/format.h>

#include <opencv2/imgcodecs.hpp>

#include "eyeslam/files/image_damage.h"
#include "eyeslam/files/pixel_format.h"
#include "eyeslam/files/whole_file.h"

namespace eyeslam::files {

ImageFolderSource::ImageFolderSource(std::vector<std::string> paths, const VideoSourceOptions& options)
    : paths_(std::move(paths)), options_(options)
{
  const auto wanted = static_cast<std::size_t>(options.last_frame + 1);
  if (options.last_frame >= 0 && wanted < paths_.size()) paths_.resize(wanted);  // damage after it is none
  checkAll();
  options_.checking = nullptr;  // what it refers to lasts no longer
}

cv::Mat ImageFolderSource::load(const std::string& path, std::string& converted) const
{
  const std::vector<std::uint8_t> bytes = readWholeFile(path);
  if (const std::string damage = damageIn(bytes); !damage.empty()) throw FileError(path + ": " + damage);
  cv::Mat image = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  if (image.empty()) throw FileError(path + ": cannot be decoded; it is damaged or no image");
  const std::string found = describe(image);
  converted = makeUsable(image);
  if (image.empty()) throw FileError(path + ": is " + found + "; 8 or 16 bit is wanted");
  return image;
}

void ImageFolderSource::checkAll()
{
  cv::Mat first;
  std::string converted;
  bool all_grey = true, any_lit = false;
  std::int64_t checked = 0;
  for (const std::string& path : paths_) {
    std::string note;
    const cv::Mat image = load(path, note);
    if (first.empty()) first = image;
    if (image.size() != first.size() || image.type() != first.type()) {
      throw FileError(fmt::format("{}: is {}, but {} is {}; images of one size and type are wanted", path,
                                  describe(image), paths_.front(), describe(first)));
    }
    if (converted.empty() && !note.empty()) converted = fmt::format("{}: {}, as in all images like it", path, note);
    all_grey = all_grey && hasEqualChannels(image);
    any_lit = any_lit || isLit(image);
    sayChecked(++checked);
  }
  grey_ = all_grey && any_lit;
  if (!converted.empty()) notices_.push_back(converted);
  if (grey_) notices_.push_back(paths_.front() + ": all channels are equal; taken as grey");
}

// Thousands of images take minutes, in which nobody should wonder whether the program still lives.
void ImageFolderSource::sayChecked(std::int64_t count) const
{
  const auto all = static_cast<std::int64_t>(paths_.size());
  if (!options_.checking || options_.checking(count, all)) return;
  throw FileError(
      fmt::format("{}: interrupted after checking {} of {} images; nothing written", paths_.front(), count, all));
}

bool ImageFolderSource::read(VideoFrame& frame)
{
  if (next_ >= static_cast<std::int64_t>(paths_.size())) return false;
  std::string note;
  frame.image = load(paths_[static_cast<std::size_t>(next_)], note);
  if (grey_) cv::extractChannel(frame.image, frame.image, 1);
  frame.number = next_++;
  frame.t = static_cast<double>(frame.number) / options_.frames_per_second;
  return true;
}

}  // namespace eyeslam::files
