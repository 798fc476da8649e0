// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include "eyeslam/replay/message_types.h"
#include "eyeslam/replay/sorted_log.h"

namespace eyeslam::replay {

/// A message as a line of CSV: a column for each single value, in the order of the fields; units in the names where
/// the field's own name has none ("theta_rad", "tip_position_x_m"); numbers so that reading them gives the same
/// numbers; flags 0 or 1; bytes as hexadecimal digits; texts in quotes where they must be. Reasons and enumerations
/// have their word beside them ("reason", "reason_word").
struct MessageCsv {
  const MessageType* type = nullptr;
  std::string header;  ///< names of the columns, without the line's end
  /// Adds the line's fields of an event that was judged ours. @return whether it could be decoded
  bool (*appendRow)(const files::LogEvent& event, fmt::memory_buffer& line) = nullptr;
};

/// @param type  one of messageTypes()
MessageCsv csvOf(const MessageType& type);

/// The targets of a BURN_PLAN: a line each.
std::string targetHeader();
void appendTarget(const burn_target_t& target, fmt::memory_buffer& line);

/// Where a message stood: before its own columns, and in tables of parts of it.
constexpr const char* kPlaceColumns = "log_utime_us,log_s,";
void appendPlace(const SortedEvent& event, fmt::memory_buffer& line);

}  // namespace eyeslam::replay
