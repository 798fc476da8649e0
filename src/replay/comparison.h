// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "eyeslam/files/log_event.h"

namespace eyeslam::replay {

/// Where a channel differs first.
struct FirstDifference {
  std::int64_t utime = 0;  ///< us since 1970, of the recorded event; of the recomputed one where none was recorded
  std::int64_t event = 0;  ///< its number, in the log or among the recomputed ones
  /// As tables have it: "goal_x_m"; "message" where one side has none, "bytes" where one is no whole message of ours.
  std::string field;
  std::string recorded, recomputed;  ///< values as text, long ones cut; empty where that side has no message
};

/// How a field of a channel differs over all its messages.
struct FieldDifference {
  std::string field;
  std::int64_t messages = 0;  ///< in which it differs
  double largest = 0.0;       ///< of |recorded - recomputed|; 0 of texts and bytes, infinite where one is no number
  double rms = 0.0;           ///< of the same, over the messages in which it differs
};

struct ChannelComparison {
  std::string channel;
  std::int64_t compared = 0;   ///< messages of the log, each beside its recomputed one
  std::int64_t identical = 0;  ///< to the byte
  std::int64_t missing = 0;    ///< recorded, but not recomputed
  std::int64_t extra = 0;      ///< recomputed, but not recorded
  double largest = 0.0;        ///< of `largest` of all fields
  std::optional<FirstDifference> first;
  std::vector<FieldDifference> fields;  ///< that differ, in the order in which they were found to

  bool isIdentical() const { return identical == compared && missing == 0 && extra == 0; }
};

/// Holds what was computed again beside what was recorded, message by message, in memory that does not grow with them.
/// Which messages belong together is the caller's to know.
///
///   Comparison comparison;
///   for each pair: comparison.compare(recorded, recomputed);   // the channel is that of the recorded one
///   comparison.isIdentical();
class Comparison {
 public:
  /// A pair of the same channel. Fields are walked over only where bytes differ.
  void compare(const files::LogEvent& recorded, const files::LogEvent& recomputed);
  /// A recorded message that was not recomputed.
  void missing(const files::LogEvent& recorded);
  /// A recomputed message that was not recorded.
  void extra(const files::LogEvent& recomputed);
  /// From now on only messages of this part count; us since 1970, the end not included.
  void restrictTo(std::int64_t from_utime, std::int64_t to_utime);
  /// Lists a channel though nothing came on it.
  void expect(std::string_view channel) { of(channel); }

  /// By name.
  const std::vector<ChannelComparison>& channels() const { return channels_; }
  bool isIdentical() const;

 private:
  ChannelComparison& of(std::string_view channel);
  bool counts(const files::LogEvent& event) const { return event.utime >= from_ && event.utime < to_; }

  std::int64_t from_ = std::numeric_limits<std::int64_t>::min(), to_ = std::numeric_limits<std::int64_t>::max();
  std::vector<ChannelComparison> channels_;
};

}  // namespace eyeslam::replay
