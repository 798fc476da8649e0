// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "eyeslam/files/log_reader.h"
#include "eyeslam/replay/channel_survey.h"
#include "eyeslam/replay/sorted_log.h"

namespace eyeslam::replay {

/// A MARK of a log.
struct LoggedMark {
  std::int64_t since_us = 0;  ///< since the log's first event
  mark_t mark{};
};

/// Everything that a log says without anything being computed again.
struct LogSurvey {
  std::int64_t file_bytes = 0;
  std::int64_t events = 0;
  std::int64_t start = 0, end = 0;        ///< us since 1970 of the first event and the latest one, strays left out
  std::vector<ChannelFindings> channels;  ///< by name
  std::int64_t left_out = 0;              ///< events on channels beyond kMostChannels
  std::vector<LoggedMark> marks;          ///< the first kMostMarks
  std::int64_t marks_left_out = 0;
  LongestGap gap;  ///< without any event
  files::LogDamage damage;
  SortFindings times;

  /// Channels with messages that are refused because their type has changed.
  std::vector<ChannelFindings> refused() const;
};

/// Surveys a log, event by event, in bounded memory.
class LogSurveyor {
 public:
  static constexpr std::size_t kMostChannels = 500;
  static constexpr std::size_t kMostMarks = 200;

  void add(const SortedEvent& event);
  /// @param log  that the events came from, read to its end
  LogSurvey survey(const SortedLog& log) const;

 private:
  void timeOf(const SortedEvent& event);
  ChannelSurvey* channelOf(std::string_view name);
  void note(const SortedEvent& event);

  LogSurvey survey_;
  std::map<std::string, ChannelSurvey, std::less<>> channels_;
  std::int64_t last_since_ = 0;
};

/// The migration of a message of this type from an older version: what would have to be done to use it.
/// @return one line for people
std::string migrationOf(const std::string& type);

}  // namespace eyeslam::replay
