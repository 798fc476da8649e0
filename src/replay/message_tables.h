// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "eyeslam/replay/message_csv.h"
#include "eyeslam/replay/sorted_log.h"

namespace eyeslam::replay {

/// What became of a channel.
struct TableCounts {
  std::string channel;
  std::string file;  ///< empty where there is none
  std::int64_t rows = 0;
  std::int64_t changed_type = 0;  ///< left out: not today's type of the channel
  std::int64_t undecodable = 0;   ///< left out: of a wrong length
  std::int64_t foreign = 0;       ///< left out: other people's
};

/// A log as CSV files, one a channel: CHANNEL.csv, and BURN_PLAN.targets.csv with a line a target. A file is begun by
/// the first message of a type of ours; other people's channels are counted. The numbers in columns are described at
/// MessageCsv; `log_utime_us` is the log's time of the event, `log_s` its place, s since the log's first event.
///
///   MessageTables tables([&folder](const std::string& name) { return folder.staged(name); });
///   while (const auto event = log.next()) tables.add(*event);
///   tables.finish();
class MessageTables {
 public:
  static constexpr std::size_t kMostChannels = 200;  ///< more are counted together, under the name "..."

  /// @param path_of  where a file of this name is to be written
  explicit MessageTables(std::function<std::string(const std::string&)> path_of);
  ~MessageTables();
  MessageTables(const MessageTables&) = delete;
  MessageTables& operator=(const MessageTables&) = delete;

  /// @throws files::FileError when a file cannot be written
  void add(const SortedEvent& event);
  /// Writes out what is buffered. @throws files::FileError
  void finish();

  /// By name.
  std::vector<TableCounts> counts() const;
  /// All files that a log can give, but those of channels with names of their own.
  static std::vector<std::string> usualFiles();

 private:
  class CsvFile;
  struct Channel {
    TableCounts counts;
    MessageCsv csv;
    std::unique_ptr<CsvFile> file, targets;
  };

  Channel& channelOf(std::string_view name);
  void open(Channel& channel, const MessageType& type);
  void write(Channel& channel, const SortedEvent& event);
  void writeTargets(Channel& channel, const SortedEvent& event);

  std::function<std::string(const std::string&)> path_of_;
  std::map<std::string, Channel, std::less<>> channels_;
  fmt::memory_buffer line_;
};

/// The file of a channel: letters, digits, '_', '-' and '.' stay, other bytes become %XX.
std::string tableFileOf(std::string_view channel);

}  // namespace eyeslam::replay
