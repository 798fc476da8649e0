// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/replay/message_types.h"

#include <algorithm>

#include "eyeslam/messaging/message_lengths.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/messaging/retina_messages.h"

namespace eyeslam::replay {
namespace {

constexpr std::size_t kNumberBytes = sizeof(std::int64_t);

std::int64_t numberAt(const std::uint8_t* at)
{
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < kNumberBytes; ++i) value = value << 8U | at[i];
  return static_cast<std::int64_t>(value);
}

template <class... Messages>
std::vector<MessageType> listed(const std::tuple<Messages...>*)
{
  return {MessageType{Messages::getTypeName(), messaging::channelOf<Messages>(), Messages::getHash(),
                      &messaging::hasItsLengths<Messages>}...};
}

template <class Wanted>
const MessageType* find(Wanted wanted)
{
  const std::vector<MessageType>& types = messageTypes();
  const auto found = std::find_if(types.begin(), types.end(), wanted);
  return found == types.end() ? nullptr : &*found;
}

}  // namespace

const std::vector<MessageType>& messageTypes()
{
  static const std::vector<MessageType> kTypes = listed(static_cast<const MessageTypes*>(nullptr));
  return kTypes;
}

const MessageType* typeOfChannel(std::string_view channel)
{
  return find([channel](const MessageType& type) { return type.channel == channel; });
}

JudgedEvent judge(const files::LogEvent& event)
{
  const MessageType* own = typeOfChannel(event.channel);
  if (event.size < kNumberBytes) return {own, own ? Standing::wrong_length : Standing::foreign, std::nullopt};
  const std::int64_t fingerprint = numberAt(event.data);
  if (own && own->fingerprint != fingerprint) return {own, Standing::changed_type, fingerprint};
  const MessageType* type =
      own ? own : find([fingerprint](const MessageType& other) { return other.fingerprint == fingerprint; });
  if (!type) return {nullptr, Standing::foreign, fingerprint};
  const bool whole = type->hasItsLengths(event.data, event.size);
  return {type, whole ? Standing::ours : Standing::wrong_length, fingerprint};
}

messaging::MessageHeader headerOf(const files::LogEvent& event)
{
  const std::uint8_t* at = event.data + kNumberBytes;
  return {numberAt(at), numberAt(at + kNumberBytes), numberAt(at + 2 * kNumberBytes), numberAt(at + 3 * kNumberBytes)};
}

}  // namespace eyeslam::replay
