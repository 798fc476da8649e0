// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "eyeslam/replay/cycle_pairs.h"
#include "eyeslam/replay/kept_message.h"
#include "eyeslam/replay/recomputed_servo.h"

namespace eyeslam::replay {

/// When the cycles of a recorded servo were, and what it had heard by then.
class ServoTimeline {
 public:
  ServoTimeline() = default;
  virtual ~ServoTimeline() = default;
  ServoTimeline(const ServoTimeline&) = delete;
  ServoTimeline& operator=(const ServoTimeline&) = delete;

  /// A message of ours, in the order of the log.
  virtual void take(const files::LogEvent& event) = 0;
  /// @param whole  nothing of the last cycle is missing
  virtual void finish(bool whole) = 0;
};

/// In lock step a cycle was each millisecond, and the log has what was heard in it before what was said in it: the very
/// same bytes must come.
class LockStepTimeline final : public ServoTimeline {
 public:
  static constexpr std::int64_t kLongestGap_us = 60'000'000;

  /// @param start  us since 1970, of the first cycle
  LockStepTimeline(const trials::TrialSetting& setting, std::int64_t session, std::int64_t start,
                   Comparison& comparison, GoalDistances& goals);

  /// @throws ReplayError  where nothing was recorded for so long that the cycles between are no trial's
  void take(const files::LogEvent& event) override;
  void finish(bool whole) override;

 private:
  void cycle();

  std::int64_t utime_;  // of the cycle to come
  CyclePairs pairs_;
  RecomputedServo servo_;
};

/// Of a program that ran in real time the times of cycles stand in what it sent; it had heard what was logged by then,
/// more or less. Where it sent nothing, cycles are a millisecond apart. Its motion and fire commands are compared; no
/// cycle's are the same to the last bit.
class LiveTimeline final : public ServoTimeline {
 public:
  /// What was logged later than its cycle by more than this is not found again.
  static constexpr std::int64_t kLookAhead_us = 200'000;

  LiveTimeline(const servo::ServoConfiguration& configuration, std::int64_t session, std::int64_t start,
               Comparison& comparison, GoalDistances& goals);

  void take(const files::LogEvent& event) override;
  void finish(bool whole) override;

 private:
  struct Said {
    std::int64_t utime_sent = 0;
    KeptMessage message;
  };

  void takeSaid(const files::LogEvent& event);
  void runUntil(std::int64_t utime);
  void cycle(std::int64_t utime);
  void resume(const files::LogEvent& event);
  void hearItself(const files::LogEvent& event);

  CyclePairs pairs_;
  RecomputedServo servo_;
  std::int64_t last_;  // cycle, us since 1970
  std::int64_t newest_ = 0;
  std::deque<KeptMessage> heard_;
  std::deque<Said> said_;  // by time
  bool registered_ = false;
};

}  // namespace eyeslam::replay
