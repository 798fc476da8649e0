// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

#include "eyeslam/replay/sorted_log.h"

namespace eyeslam::replay {

/// A log cannot be computed again: one line that says what it lacks, without its path.
class ReplayError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A part of the system that is computed again from a log: it is given the whole log in order, takes as inputs what the
/// part had heard, and holds what it sends now beside what it had sent.
///
///   while (const auto event = log.next()) part.take(*event);
///   part.finish();
///   if (!part.lacking().empty()) say(part.lacking());
class RecomputedPart {
 public:
  RecomputedPart() = default;
  virtual ~RecomputedPart() = default;
  RecomputedPart(const RecomputedPart&) = delete;
  RecomputedPart& operator=(const RecomputedPart&) = delete;

  /// @throws ReplayError, configuration::ConfigurationError, files::FileError
  virtual void take(const SortedEvent& event) = 0;
  /// After the last event.
  virtual void finish() = 0;
  /// What was computed, for people: "servo of eyeslam-trial 0.1.0 (short, seed 3) in lock step".
  virtual std::string about() const = 0;
  /// What the log lacks for this part, one line; empty where it was computed.
  virtual std::string lacking() const = 0;
};

}  // namespace eyeslam::replay
