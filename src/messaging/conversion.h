// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/retina/reason.h"

namespace eyeslam::messaging {

/// How a message type becomes a plain value (SI, Eigen) and back. A new type: write `lcmtypes/NAME_t.lcm` and its name
/// in the list beside it, declare the value and `Conversion<NAME_t>` in a header here, list its fields in the source
/// (field_copy.h). Publisher and Subscription then serve it on the channel NAME. A type of variable size tells
/// `static bool hasItsLengths(ByteWalk)` besides.
template <class Message>
struct Conversion;

/// A conversion whose fields are listed once in its source, for both directions.
template <class Message, class ListedValue>
struct ListedConversion {
  using Value = ListedValue;
  /// Reads all fields but the header's. @return none, or why the value must not be used: not_finite, out_of_range
  static retina::Reason read(const Message& message, Value& value);
  /// Writes all fields but the header's and the tag. @return as read; then the message must not be sent
  static retina::Reason write(const Value& value, Message& message);
};

template <class Message>
retina::Reason read(const Message& message, typename Conversion<Message>::Value& value)
{
  return Conversion<Message>::read(message, value);
}

template <class Message>
retina::Reason write(const typename Conversion<Message>::Value& value, Message& message)
{
  return Conversion<Message>::write(value, message);
}

}  // namespace eyeslam::messaging
