// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <type_traits>

#include "eyeslam/messaging/conversion.h"
#include "eyeslam/retina/options.h"

namespace eyeslam::messaging {

using retina::Range;

constexpr Range kAnyNumber{};
constexpr Range kNotNegative{0.0, std::numeric_limits<double>::max()};
constexpr Range kPosition{-1.0, 1.0};  ///< m, in the manipulator's frame: its tracker sees 30 mm
constexpr Range kImage_px{-1e6, 1e6};
constexpr Range kAngle{-3.2, 3.2};  ///< rad
constexpr Range kScale{0.01, 100.0};
constexpr Range kUmPerPx{0.0, 1000.0};  ///< 0 = unknown
constexpr Range kExpiry{1e-6, 1.0};     ///< s

/// The fields of a type, listed once in its source for both ways:
///
///   template <>
///   struct Listing<foo_t> {
///     template <class Copy, class Message, class Value>
///     static void list(Copy& copy, Message& message, Value& value) { copy.number(message.lead, value.lead, {0, 1}); }
///   };
///   template struct ListedConversion<foo_t, Foo>;
template <class Message>
struct Listing;

enum class CopyTo { value, message };

/// Passes over the fields of a message and its value together: copies one way, checks each, and remembers the first
/// thing wrong.
template <CopyTo kTo>
class FieldCopy {
 public:
  retina::Reason reason() const { return reason_; }

  /// Refuses where fields do not go together.
  void require(bool condition) { refuseUnless(condition, retina::Reason::out_of_range); }

  template <class Field, class Value>
  void number(Field& field, Value& value, const Range& range)
  {
    assign(field, value);
    check(static_cast<double>(value), range);
  }

  template <class Field, class Value>
  void flag(Field& field, Value& value)
  {
    if constexpr (kTo == CopyTo::value) {
      value = field != 0;
    } else {
      field = value ? 1 : 0;
    }
  }

  template <class Field, class Value>
  void bit(Field& field, std::int32_t bit, Value& value)
  {
    if constexpr (kTo == CopyTo::value) {
      value = (field & bit) != 0;
    } else {
      field = value ? field | bit : field & ~bit;
    }
  }

  /// Before its bits are listed: the others must be 0.
  template <class Field>
  void bits(Field& field, std::int32_t known)
  {
    if constexpr (kTo == CopyTo::message) field = 0;
    require((field & ~known) == 0);
  }

  /// An enumeration of consecutive numbers from 0.
  template <class Field, class Value>
  void choice(Field& field, Value& value, std::decay_t<Value> last)
  {
    assign(field, value);
    check(static_cast<double>(field), {0.0, static_cast<double>(last)});
  }

  template <class Field, class Value>
  void reason(Field& field, Value& value)
  {
    assign(field, value);
    check(static_cast<double>(field), {0.0, std::numeric_limits<std::int16_t>::max()});
  }

  /// A vector, or a matrix row by row.
  template <class Field, class Value>
  void numbers(Field& field, Value& value, const Range& range)
  {
    static_assert(sizeof(field) / sizeof(field[0]) == std::decay_t<Value>::SizeAtCompileTime);
    for (Eigen::Index row = 0; row < value.rows(); ++row) {
      for (Eigen::Index column = 0; column < value.cols(); ++column) {
        number(field[row * value.cols() + column], value(row, column), range);
      }
    }
  }

  /// Bytes, or counts.
  template <class Field, class Value>
  void counts(Field& field, Value& value)
  {
    static_assert(std::extent_v<Field> == std::tuple_size_v<std::decay_t<Value>>);
    for (std::size_t i = 0; i < value.size(); ++i) number(field[i], value[i], kNotNegative);
  }

  template <class Field, class Value>
  void orientation(Field& field, Value& value)
  {
    constexpr double kRounding = 1e-6;
    number(field[0], value.w(), {-1.0, 1.0});
    number(field[1], value.x(), {-1.0, 1.0});
    number(field[2], value.y(), {-1.0, 1.0});
    number(field[3], value.z(), {-1.0, 1.0});
    require(std::abs(value.squaredNorm() - 1.0) < kRounding);
  }

  template <class Field, class Value>
  void covariance(Field& field, Value& value)
  {
    numbers(field, value, kAnyNumber);
    require(isCovariance(value));
  }

 private:
  template <class Field, class Value>
  static void assign(Field& field, Value& value)
  {
    if constexpr (kTo == CopyTo::value) {
      value = static_cast<std::decay_t<Value>>(field);
    } else {
      field = static_cast<std::decay_t<Field>>(value);
    }
  }

  void check(double value, const Range& range)
  {
    refuseUnless(std::isfinite(value), retina::Reason::not_finite);
    refuseUnless(value >= range.lowest && value <= range.highest, retina::Reason::out_of_range);
  }

  void refuseUnless(bool condition, retina::Reason why)
  {
    if (!condition && reason_ == retina::Reason::none) reason_ = why;
  }

  // What any pair of its axes must satisfy; beyond that the sender's word is taken.
  template <class Matrix>
  static bool isCovariance(const Matrix& matrix)
  {
    constexpr double kRounding = 1e-6;
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      if (!(matrix(i, i) >= 0.0)) return false;
      for (Eigen::Index j = 0; j < i; ++j) {
        const double most = std::sqrt(matrix(i, i)) * std::sqrt(matrix(j, j)) * (1.0 + kRounding);
        if (!(std::abs(matrix(i, j)) <= most) || !(std::abs(matrix(i, j) - matrix(j, i)) <= most * kRounding))
          return false;
      }
    }
    return true;
  }

  retina::Reason reason_ = retina::Reason::none;
};

template <class Message, class ListedValue>
retina::Reason ListedConversion<Message, ListedValue>::read(const Message& message, ListedValue& value)
{
  FieldCopy<CopyTo::value> copy;
  Listing<Message>::list(copy, message, value);
  return copy.reason();
}

template <class Message, class ListedValue>
retina::Reason ListedConversion<Message, ListedValue>::write(const ListedValue& value, Message& message)
{
  FieldCopy<CopyTo::message> copy;
  Listing<Message>::list(copy, message, value);
  return copy.reason();
}

}  // namespace eyeslam::messaging
