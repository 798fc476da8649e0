// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/picture_size.h"

#include <fmt/format.h>

#include <charconv>

#include "command_line/program.h"

namespace eyeslam::apps {
PictureSize pictureSize(const std::string& option, const std::string& text)
{
  PictureSize size;
  const char* const end = text.data() + text.size();
  const auto [cross, width_error] = std::from_chars(text.data(), end, size.width);
  const bool has_cross = width_error == std::errc() && cross != end && *cross == 'x';
  const auto [last, height_error] = std::from_chars(has_cross ? cross + 1 : end, end, size.height);
  if (!has_cross || height_error != std::errc() || last != end) {
    throw UsageError(fmt::format("{} {}: WIDTHxHEIGHT is wanted, like 800x608", option, text));
  }
  if (size.width < 64 || size.height < 48 || size.width > 4096 || size.height > 4096) {
    throw UsageError(fmt::format("{} {}: 64x48 to 4096x4096 is wanted", option, text));
  }
  return size;
}

}  // namespace eyeslam::apps
