// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <optional>
#include <regex>
#include <string>
#include <string_view>

#include "eyeslam/replay/sorted_log.h"

namespace eyeslam::replay {

/// A part of a log: some channels, from one time to another.
struct LogPart {
  std::optional<double> from;  ///< s since the log's first event, included; none = its beginning
  std::optional<double> to;    ///< s, not included: [0, 5) and [5, 10) are all of [0, 10); none = its end
  std::string channels;  ///< regular expression (ECMAScript) of whole names, as LCM's own programs take; empty = all
};

class LogSelection {
 public:
  /// @throws std::invalid_argument  the times are no interval, or the channels no expression
  explicit LogSelection(const LogPart& part);

  bool takes(const SortedEvent& event);

 private:
  bool takesChannel(std::string_view channel);

  std::int64_t from_us_, to_us_;
  std::optional<std::regex> channels_;
  std::map<std::string, bool, std::less<>> known_;  // an expression takes longer than a name
};

}  // namespace eyeslam::replay
