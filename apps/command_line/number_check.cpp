// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/number_check.h"

#include <fmt/format.h>

#include <cstdint>

namespace eyeslam::apps {
namespace {

// CLI11 takes a number that does not fit for the largest that does, to which nothing can be added.
constexpr std::int64_t kLargestFrame = 1000000000000;

}  // namespace

CLI::Validator within(double lowest, double highest)
{
  return CLI::Validator(
      [lowest, highest](const std::string& text) {
        double value = 0.0;
        const bool good = CLI::detail::lexical_cast(text, value) && value >= lowest && value <= highest;
        return good ? std::string() : fmt::format("{} is no number in [{}, {}]", text, lowest, highest);
      },
      "");
}

CLI::Validator frameNumber()
{
  return CLI::Validator(
      [](const std::string& text) {
        std::int64_t value = -1;
        const bool good = CLI::detail::lexical_cast(text, value) && value >= 0 && value <= kLargestFrame;
        return good ? std::string() : text + " is no frame number (0, 1, ...)";
      },
      "");
}

}  // namespace eyeslam::apps
