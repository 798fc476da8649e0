// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "eyeslam/messaging/message_header.h"
#include "eyeslam/messaging/sequence_window.h"
#include "eyeslam/replay/duration_statistics.h"
#include "eyeslam/replay/message_types.h"
#include "eyeslam/replay/sorted_log.h"

namespace eyeslam::replay {

/// The longest time without an event, strays left out.
struct LongestGap {
  std::int64_t us = 0;
  std::int64_t since_us = 0;  ///< where it begins, since the log's first event
};

/// What a log holds on one channel. Fields of messages are judged on those of ours alone.
struct ChannelFindings {
  std::string channel;
  std::string type;  ///< micron_state_t; empty where foreign
  std::int64_t events = 0;
  std::int64_t bytes = 0;  ///< of the messages
  double rate = 0.0;       ///< 1/s, between the first and the last; 0 of fewer than two
  LongestGap gap;

  std::optional<std::int64_t> fingerprint;  ///< of the first message that is not ours, or not today's
  std::int64_t changed_type = 0;            ///< refused: not today's type of this channel
  std::int64_t undecodable = 0;             ///< refused: of a wrong length

  std::int64_t sessions = 0;         ///< of senders; a sender that starts anew begins another
  std::int64_t lost = 0;             ///< numbers that are missing between others of their session
  std::int64_t repeated = 0;         ///< numbers that came before
  std::int64_t overtaken = 0;        ///< numbers that came after later ones
  std::int64_t utime_missing = 0;    ///< utime or utime_sent not positive: not judged further
  std::int64_t utime_backwards = 0;  ///< utime before that of the message before it, in its session
  std::int64_t from_future = 0;      ///< utime after utime_sent: of something that had not happened yet
  std::int64_t sent_later = 0;       ///< utime_sent more than kClock_us after the log received it: another clock
  DurationStatistics age;            ///< utime_sent - utime: how old the content was when it was sent
  DurationStatistics transport;      ///< the log's time - utime_sent: clocks of sender and logger, and the way
};

/// Looks at the events of one channel in their order.
class ChannelSurvey {
 public:
  static constexpr std::int64_t kClock_us = 1000;
  static constexpr std::size_t kSessions = 16;  ///< remembered at a time; the one silent longest is forgotten

  explicit ChannelSurvey(std::string channel) { findings_.channel = std::move(channel); }

  void add(const SortedEvent& event, const JudgedEvent& judged);
  ChannelFindings findings() const;

 private:
  struct Session {
    std::int64_t id = 0;
    std::int64_t last_heard = -1;  // by count of events; -1: free
    std::int64_t utime = 0;
    messaging::SequenceWindow order;
  };

  void timeOf(const SortedEvent& event);
  void judgeHeader(const messaging::MessageHeader& header, const SortedEvent& event);
  void judgeOrder(const messaging::MessageHeader& header);
  Session& sessionOf(std::int64_t id);

  ChannelFindings findings_;
  std::array<Session, kSessions> sessions_;
  std::int64_t lost_in_forgotten_ = 0;
  std::int64_t last_since_ = 0, duration_us_ = 0;  // of all parts of the log together
  std::int64_t timed_ = 0, part_ = 0, parts_ = 0;
};

}  // namespace eyeslam::replay
