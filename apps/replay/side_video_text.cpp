// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/side_video_text.h"

#include <fmt/format.h>

#include <filesystem>

#include "command_line/program.h"

namespace eyeslam::apps {
namespace {

std::string namedOrBeside(const ReplayArguments& arguments)
{
  if (!arguments.video.empty()) return arguments.video;
  std::error_code none;
  return std::filesystem::is_regular_file(videoBeside(arguments), none) ? videoBeside(arguments) : "";
}

[[noreturn]] void refuse(const ReplayArguments& arguments, const char* what)
{
  throw UsageError(fmt::format("{}: there is no {}; --video FILE is wanted", what, videoBeside(arguments)));
}

}  // namespace

std::string videoBeside(const ReplayArguments& arguments)
{
  return (std::filesystem::path(arguments.log).parent_path() / "video.mkv").string();
}

std::string videoOf(const ReplayArguments& arguments)
{
  if (arguments.only == "servo") return "";
  std::string video = namedOrBeside(arguments);
  if (!video.empty() || (arguments.only.empty() && !arguments.offset)) return video;
  refuse(arguments, arguments.only == "tracker" ? "--only tracker" : "--offset");
}

std::string requiredVideoOf(const ReplayArguments& arguments)
{
  std::string video = namedOrBeside(arguments);
  if (video.empty()) refuse(arguments, "overlay");
  return video;
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
