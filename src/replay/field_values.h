// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "eyeslam/files/log_event.h"
#include "eyeslam/replay/field_walk.h"

namespace eyeslam::replay {

/// A single value of a message, as `Fields` lists it.
struct FieldValue {
  enum class Kind { integer, real, text, bytes };

  FieldName name;
  Kind kind = Kind::integer;
  std::int64_t integer = 0;
  double real = 0.0;
  std::string characters;  ///< of a text, or the bytes themselves
};

/// All values of an event's message, in the order of its fields; those of a plan's targets follow, as "target_x_px".
/// Empty where the event is no whole message of ours.
std::vector<FieldValue> valuesOf(const files::LogEvent& event);

/// Bit by bit: a number that is none is the same as itself.
bool isSame(const FieldValue& a, const FieldValue& b);
/// |a - b|; 0 of texts and bytes, infinite where one alone is no finite number.
double distance(const FieldValue& a, const FieldValue& b);
/// Numbers so that reading them gives the same; bytes as hexadecimal digits; long ones are cut.
std::string textOf(const FieldValue& value);
std::string textOf(const std::uint8_t* bytes, std::size_t count);

}  // namespace eyeslam::replay
