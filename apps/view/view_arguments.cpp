// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/view_arguments.h"

#include <fmt/format.h>

#include "command_line/picture_size.h"
#include "command_line/program.h"

namespace eyeslam::apps {
namespace {

constexpr const char* kExamples =
    "  eyeslam-view --console\n"
    "  eyeslam-view --console --lcm udpm://239.255.76.67:7667?ttl=0 --key micron.key\n"
    "  eyeslam-view --console < lines.txt\n"
    "The line 'help' lists the console's commands. In a file or pipe, a line that cannot be obeyed ends it;\n"
    "its end, like that of the input, is standby.";

}  // namespace

void addOptions(CLI::App& app, ViewArguments& arguments)
{
  app.add_flag("--console", arguments.console, "Take commands from the keyboard, a pipe or a file, a line each");
  addLinkOptions(app, arguments.link);
  app.add_option("--size", arguments.size, "Size of the image, px")->type_name("WIDTHxHEIGHT")->capture_default_str();
  app.add_flag("--quiet", arguments.quiet, "Say nothing but answers and what the servo does");
  addStandardOptions(app, kExamples);
}

Eigen::Vector2d centreOf(const ViewArguments& arguments)
{
  const PictureSize size = pictureSize("--size", arguments.size);
  return {0.5 * (size.width - 1), 0.5 * (size.height - 1)};
}

}  // namespace eyeslam::apps
