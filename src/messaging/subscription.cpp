// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/subscription.h"

#include <algorithm>
#include <cctype>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>

namespace eyeslam::messaging {
namespace {

using retina::Reason;

// Ten seconds at 1 kHz. A full queue drops the newest message, and one without limit grows until memory ends.
constexpr int kQueueCapacity = 10'000;

std::int64_t fingerprintOf(const std::uint8_t* bytes)
{
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(bits); ++i) bits = bits << 8U | bytes[i];
  return static_cast<std::int64_t>(bits);
}

// LCM takes a channel for a regular expression, and crashes on a bad one.
bool isPlain(const std::string& channel)
{
  return !channel.empty() && std::all_of(channel.begin(), channel.end(), [](unsigned char letter) {
    return std::isalnum(letter) != 0 || letter == '_';
  });
}

}  // namespace

ChannelReceiver::ChannelReceiver(Link& link, std::string channel, std::int64_t fingerprint, bool has_tag)
    : link_(link), channel_(std::move(channel)), fingerprint_(fingerprint), has_tag_(has_tag)
{
  if (!isPlain(channel_)) throw std::runtime_error("channel '" + channel_ + "': only letters, digits and _");
  subscription_ = link_.lcm().subscribe(channel_, &ChannelReceiver::onMessage, this);
  subscription_->setQueueCapacity(kQueueCapacity);
}

ChannelReceiver::~ChannelReceiver() { link_.lcm().unsubscribe(subscription_); }

bool ChannelReceiver::isInForce(std::int64_t monotonic) const
{
  if (!expiry_) return false;
  return 1e-6 * static_cast<double>(monotonic - guard_.toReceiver(header_.utime_sent)) <= *expiry_;
}

// Whatever the bytes, and whatever the program does with them: an exception that unwinds through LCM ends the process.
void ChannelReceiver::onMessage(const lcm::ReceiveBuffer* buffer, const std::string&)
{
  const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
  Reason why = Reason::internal_error;
  try {
    why = check(bytes, buffer->data_size);
    if (why == Reason::none) why = take(bytes, buffer->data_size);
  } catch (...) {
    why = Reason::internal_error;
  }
  ++received_;
  if (why != Reason::none) ++refused_[refusalIndex(why)];
}

Reason ChannelReceiver::check(const std::uint8_t* bytes, std::size_t size) const
{
  if (size < sizeof(fingerprint_)) return Reason::wrong_length;
  if (fingerprintOf(bytes) != fingerprint_) return Reason::wrong_type;
  const Authenticator* authenticator = has_tag_ ? link_.authenticator() : nullptr;
  if (authenticator && !authenticator->verifies(channel_, bytes, size)) return Reason::unauthenticated;
  return Reason::none;
}

Reason ChannelReceiver::admit(const MessageHeader& header, std::optional<double> expiry)
{
  const ReceiveTime now = link_.receivedAt(header);
  const Reason why = has_tag_ ? guard_.admit(header, now, expiry) : guard_.admitAnyone(header, now);
  if (why != Reason::none) return why;
  header_ = header;
  expiry_ = expiry;
  last_received_ = now.monotonic;
  ++accepted_;
  return Reason::none;
}

}  // namespace eyeslam::messaging
