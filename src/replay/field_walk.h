// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string_view>
#include <utility>
#include <vector>

#include "eyeslam/messaging/channel_guard.h"
#include "eyeslam/retina/reason.h"

namespace eyeslam::replay {

/// A field's name in parts: they are joined by '_' where they are not empty. The last part is the unit, for names of
/// messages have it only where it is not SI.
struct FieldName {
  std::string_view name;       ///< as in the message
  std::string_view part = {};  ///< of a vector, matrix or set of bits
  std::string_view unit = {};  ///< "m", "per_s"; empty where the name has it, or there is none
  std::string_view second_part = {};
  std::string_view second_unit = {};
};

template <std::size_t kSize>
using Parts = const std::string_view (&)[kSize];

constexpr std::string_view kXy[] = {"x", "y"};
constexpr std::string_view kXyz[] = {"x", "y", "z"};
constexpr std::string_view kQuaternion[] = {"w", "x", "y", "z"};

/// Walks over the fields of a message, which `Fields<Message>` lists, and tells a visitor of each single value:
///
///   visitor.number(FieldName, value)     any arithmetic type
///   visitor.text(FieldName, characters)
///   visitor.bytes(FieldName, pointer, count)
template <class Visitor>
class FieldWalk {
 public:
  explicit FieldWalk(Visitor& visitor) : visitor_(visitor) {}

  template <class Message>
  void header(const Message& message)
  {
    number("utime", "us", message.utime);
    number("utime_sent", "us", message.utime_sent);
    number("seq", "", message.seq);
    number("session", "", message.session);
  }

  template <class Value>
  void number(std::string_view name, std::string_view unit, Value value)
  {
    visitor_.number(FieldName{name, {}, unit}, value);
  }

  /// Number and word, which is empty where the number is none of the list.
  void choice(std::string_view name, std::int64_t value, std::initializer_list<std::string_view> words)
  {
    visitor_.number(FieldName{name}, value);
    const bool known = value >= 0 && value < static_cast<std::int64_t>(words.size());
    visitor_.text(FieldName{name, "word"}, known ? words.begin()[value] : std::string_view());
  }

  void reason(std::string_view name, std::int16_t value)
  {
    visitor_.number(FieldName{name}, value);
    visitor_.text(FieldName{name, "word"}, retina::word(static_cast<retina::Reason>(value)));
  }

  /// The number, then each bit as 0 or 1.
  void bits(std::string_view name, std::int32_t value,
            std::initializer_list<std::pair<std::int32_t, std::string_view>> words)
  {
    visitor_.number(FieldName{name}, value);
    for (const auto& [bit, word] : words) visitor_.number(FieldName{name, word}, (value & bit) != 0 ? 1 : 0);
  }

  template <class Value, std::size_t kSize>
  void vector(std::string_view name, std::string_view unit, Parts<kSize> axes, const Value (&values)[kSize])
  {
    for (std::size_t i = 0; i < kSize; ++i) visitor_.number(FieldName{name, axes[i], unit}, values[i]);
  }

  template <class Value, std::size_t kRows, std::size_t kColumns>
  void matrix(std::string_view name, Parts<kRows> rows, Parts<kColumns> columns, const Value (&values)[kRows][kColumns])
  {
    for (std::size_t row = 0; row < kRows; ++row) {
      for (std::size_t column = 0; column < kColumns; ++column) {
        visitor_.number(FieldName{name, rows[row], {}, columns[column]}, values[row][column]);
      }
    }
  }

  /// Of the variables `axes`, row by row; "covariance_x_theta_px_rad".
  template <std::size_t kAxes, std::size_t kSize>
  void covariance(std::string_view name, Parts<kAxes> axes, Parts<kAxes> units, const double (&values)[kSize])
  {
    static_assert(kSize == kAxes * kAxes);
    for (std::size_t i = 0; i < kSize; ++i) {
      const std::size_t row = i / kAxes, column = i % kAxes;
      visitor_.number(FieldName{name, axes[row], units[row], axes[column], units[column]}, values[i]);
    }
  }

  void refusals(std::string_view name, const std::int64_t (&counts)[messaging::kRefusalReasons])
  {
    for (std::size_t i = 0; i < messaging::kRefusalReasons; ++i) {
      const int reason = static_cast<int>(retina::Reason::unauthenticated) + static_cast<int>(i);
      visitor_.number(FieldName{name, retina::word(static_cast<retina::Reason>(reason))}, counts[i]);
    }
  }

  void text(std::string_view name, std::string_view characters) { visitor_.text(FieldName{name}, characters); }

  template <std::size_t kSize>
  void bytes(std::string_view name, const std::uint8_t (&values)[kSize])
  {
    visitor_.bytes(FieldName{name}, values, kSize);
  }
  void bytes(std::string_view name, const std::vector<std::uint8_t>& values)
  {
    visitor_.bytes(FieldName{name}, values.data(), values.size());
  }

 private:
  Visitor& visitor_;
};

/// `template <class Walk> static void list(Walk& walk, const Message& message)`: the fields in their order.
template <class Message>
struct Fields;

template <class Message, class Visitor>
void visitFields(const Message& message, Visitor& visitor)
{
  FieldWalk<Visitor> walk(visitor);
  Fields<Message>::list(walk, message);
}

}  // namespace eyeslam::replay
