// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "eyeslam/files/log_event.h"

namespace eyeslam::files {

/// What a reader had to do to a log.
struct LogDamage {
  std::int64_t skipped_bytes = 0;
  std::int64_t gaps = 0;           ///< places where bytes were skipped
  std::int64_t first_offset = -1;  ///< of the first of them; -1 = none
  bool cut_off = false;            ///< the file ends within an event
  std::int64_t out_of_order = 0;   ///< events whose time is before that of the event before them

  bool any() const { return gaps > 0 || cut_off || out_of_order > 0; }
};

/// Reads an LCM log of any length and in any state, in bounded memory. LCM's own reader crashes on absurd lengths and
/// stops silently at damage (measured: stack, 0.5); this one searches for the next whole event and counts what it left
/// out. An event is believed when its header is possible and the next one follows it, or the file ends there; after
/// damage, only when its time has gone on as well, for a payload may hold a whole log, or when all that follows is
/// earlier, as of a log that was joined. What is written to the file after it was opened is not read.
///
///   LogReader log("trial.lcm");
///   while (const std::optional<LogEvent> event = log.next()) use(*event);   // valid until the next call
///   report(log.damage());
class LogReader {
 public:
  static constexpr std::size_t kLargestData = std::size_t{1} << 26;  ///< bytes; a raw picture of 4000 x 4000 is smaller

  /// @throws FileError when the file cannot be opened
  explicit LogReader(const std::string& path);

  /// The next whole event; none at the end. Never throws on bad content.
  std::optional<LogEvent> next();

  const LogDamage& damage() const { return damage_; }
  std::int64_t events() const { return events_; }
  /// Bytes read so far and in all, for a progress bar.
  std::int64_t position() const { return offset_; }
  std::int64_t size() const { return size_; }

 private:
  struct Header {
    LogEvent event;
    std::size_t channel_bytes = 0, data_bytes = 0;
    std::size_t bytes() const { return kLogHeaderBytes + channel_bytes + data_bytes; }
  };

  bool fill(std::size_t wanted);
  static std::optional<Header> headerOf(const std::uint8_t* bytes);
  std::optional<Header> headerAt(std::size_t at) const;
  bool isFollowed(std::size_t end);
  bool isOfAnotherLog(const Header& first);
  bool holdsTheNext(const Header& header);
  bool isCutOff(const Header& header) const;
  std::optional<Header> whole();
  void skip();
  LogEvent taken(Header header);

  std::ifstream stream_;
  std::int64_t size_ = 0;
  std::int64_t offset_ = 0;  // in the file, of the buffer's first unread byte
  std::vector<std::uint8_t> buffer_;
  std::size_t first_ = 0, last_ = 0;  // unread bytes
  bool damaged_ = false;              // bytes are being skipped
  std::int64_t within_until_ = 0;     // in the file: so far earlier events are of a log within a payload
  std::int64_t searched_ = 0;         // bytes, for events within others
  std::int64_t last_number_ = -1;
  std::array<std::int64_t, 4> utimes_{};  // of the last events, the newest first: one alone may be damaged
  std::int64_t events_ = 0;
  LogDamage damage_;
};

}  // namespace eyeslam::files
