// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/log_selection.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace eyeslam::replay {
namespace {

constexpr double kLongest = 1e12;  // s; more does not fit in us
constexpr std::size_t kMostKnown = 1000;

std::int64_t micros(std::optional<double> seconds, std::int64_t otherwise)
{
  if (!seconds) return otherwise;
  if (!(std::abs(*seconds) <= kLongest)) throw std::invalid_argument("a time of a log is wanted, in s");
  return std::llround(1e6 * *seconds);
}

}  // namespace

LogSelection::LogSelection(const LogPart& part)
    : from_us_(micros(part.from, std::numeric_limits<std::int64_t>::min())),
      to_us_(micros(part.to, std::numeric_limits<std::int64_t>::max()))
{
  if (to_us_ <= from_us_) throw std::invalid_argument("the end of the part is not after its beginning");
  try {
    if (!part.channels.empty()) channels_.emplace(part.channels);
  } catch (const std::regex_error&) {
    throw std::invalid_argument("'" + part.channels +
                                "' is no regular expression of channels, such as 'MICRON_.*|MARK'");
  }
}

bool LogSelection::takes(const SortedEvent& event)
{
  return event.since_us >= from_us_ && event.since_us < to_us_ && takesChannel(event.event.channel);
}

bool LogSelection::takesChannel(std::string_view channel)
{
  if (!channels_) return true;
  if (const auto found = known_.find(channel); found != known_.end()) return found->second;
  if (known_.size() >= kMostKnown) known_.clear();
  const bool takes = std::regex_match(channel.begin(), channel.end(), *channels_);
  known_.emplace(std::string(channel), takes);
  return takes;
}

}  // namespace eyeslam::replay
