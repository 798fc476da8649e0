// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eyeslam/files/log_reader.h"

namespace eyeslam::replay {

/// How far events may be from their place in time; what is farther away is delivered where it stands, and counted.
struct SortWindow {
  std::int64_t span_us = 1'000'000;          ///< > 0; loggers of several threads are off by milliseconds
  std::size_t events = 20'000;               ///< held at most, >= 1; six times a second of a trial
  std::size_t bytes = std::size_t{1} << 25;  ///< held at most, but one event always
};

/// An event at its place in time.
struct SortedEvent {
  files::LogEvent event;      ///< as it stands in the file; its bytes live until the next call
  std::int64_t utime = 0;     ///< us since 1970: its place, which is event.utime unless it is stray
  std::int64_t since_us = 0;  ///< utime since the log's first event; negative only where a log steps back
  std::int64_t part = 0;      ///< rises where time steps back: of another log, which was joined
  bool stray = false;         ///< its time cannot be true, so it stands where it stood in the file
  bool late = false;          ///< farther from its place than the window; it follows later ones
};

/// What had to be done about the times of a log.
struct SortFindings {
  std::int64_t strays = 0;
  std::int64_t late = 0;
  std::int64_t latest_us = 0;   ///< the worst of them, behind the event before it
  std::int64_t steps_back = 0;  ///< places where time steps back beyond the window and stays there: joined logs
};

/// The events of a log by time, each once, nothing left out, in bounded memory. Events of equal times keep their order,
/// for in lock step that is the order of sending. Other people's channels pass as all do.
///
///   SortedLog log("trial.lcm");
///   while (const std::optional<SortedEvent> event = log.next()) use(*event);   // valid until the next call
///
/// Events that are more than kJump_us away from those before, or behind them by more than the window, are doubted until
/// the log goes on where it was: then they were late, or, so far away, cannot be true (stray). Where kMostDoubted do
/// not bring it back, or the file ends, that was a pause or, backwards, a log that was joined to another or a clock
/// that was set: all of the first part comes before all of the second.
class SortedLog {
 public:
  static constexpr std::int64_t kJump_us = 3'600'000'000;
  static constexpr std::size_t kMostDoubted = 32;

  /// @throws files::FileError when the file cannot be opened; std::invalid_argument: a window of nothing
  explicit SortedLog(const std::string& path, SortWindow window = {});

  /// The next event; none at the end. Never throws on bad content.
  std::optional<SortedEvent> next();

  const SortFindings& findings() const { return findings_; }
  /// us since 1970 of the first event; 0 before it.
  std::int64_t start() const { return start_.value_or(0); }
  /// Damage, counts and the position in the file. It is ahead by what is held.
  const files::LogReader& reader() const { return reader_; }

 private:
  struct Held {
    SortedEvent sorted;
    std::int64_t order = 0;  // in the file
    std::vector<std::uint8_t> bytes;
  };
  using Holder = std::unique_ptr<Held>;
  static bool isAfter(const Holder& a, const Holder& b);

  void findTheStart();
  bool read();
  Holder holderOf(const files::LogEvent& event);
  void place(Holder held);
  bool isDoubtful(std::int64_t utime) const;
  void judgeFirstDoubted();
  void passDoubted(Holder held);
  void settle(std::int64_t utime);
  void hold(Holder held, std::int64_t utime);
  bool mayRelease() const;
  void release();
  void recycle();

  files::LogReader reader_;
  SortWindow window_;
  SortFindings findings_;
  std::vector<Holder> heap_;  // the next one on top
  std::vector<Holder> spare_;
  Holder current_;               // what was delivered last
  std::vector<Holder> doubted_;  // in the order of the file
  std::size_t held_bytes_ = 0;
  std::int64_t order_ = 0;
  std::int64_t part_ = 0;
  std::array<std::int64_t, 2> settled_{};  // times of the last two believed events in the file, the newest first
  std::optional<std::int64_t> start_;
  std::int64_t delivered_ = 0, delivered_part_ = 0;  // the latest time delivered, and its part
  bool begun_ = false, ended_ = false;
};

}  // namespace eyeslam::replay
