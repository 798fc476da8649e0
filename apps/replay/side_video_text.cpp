// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/side_video_text.h"

#include <fmt/format.h>

#include <filesystem>

#include "command_line/program.h"

namespace eyeslam::apps {

std::string videoOf(const ReplayArguments& arguments)
{
  if (arguments.only == "servo") return "";
  if (!arguments.video.empty()) return arguments.video;
  const std::filesystem::path beside = std::filesystem::path(arguments.log).parent_path() / "video.mkv";
  std::error_code none;
  if (std::filesystem::is_regular_file(beside, none)) return beside.string();
  const char* const option = arguments.only == "tracker" ? "--only tracker" : "--offset";
  if (arguments.only.empty() && !arguments.offset) return "";
  throw UsageError(fmt::format("{}: there is no {}; --video FILE is wanted", option, beside.string()));
}

std::string videoText(const replay::VideoReplay& video)
{
  std::string text;
  if (const auto& offset = video.offset()) {
    text = fmt::format(
        "video: {:+.1f} ms +- {:.1f} ms off ({:+.2f} frames), by {}; correlation {:.2f}, elsewhere {:.2f}\n",
        1e3 * offset->offset_s, 1e3 * offset->sigma_s, offset->frames(), offset->against, offset->correlation,
        offset->second);
  }
  for (const std::string& line : video.warnings()) text += fmt::format("warning: {}\n", line);
  return text;
}

}  // namespace eyeslam::apps
