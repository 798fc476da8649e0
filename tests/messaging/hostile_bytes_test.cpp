// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever bytes come: no crash, no memory without bound, and each is either accepted or refused for a counted reason.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <numeric>
#include <random>
#include <vector>

#include "support/encoded_message.h"
#include "support/every_subscription.h"
#include "support/random_values.h"

namespace eyeslam::messaging {
namespace {

using retina::Reason;
using support::Bytes;

constexpr std::int64_t kUtime = 1'700'000'000'000'000;

// A map of 16 million cells, twice while it grows, and what a sanitizer keeps of freed memory. A count that is believed
// asks for up to 2 GB.
constexpr long kMostKilobytes = 600'000;

long residentKilobytes()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

struct Wired {
  std::string channel;
  Bytes bytes;
};

/// A good message of each type, signed; the numbers of one channel grow.
class MessageSource {
 public:
  explicit MessageSource(const std::optional<Key>& key) : key_(key) {}

  std::vector<Wired> next()
  {
    ++seq_;
    return {valued<laser_command_t>(), valued<laser_state_t>(),  valued<micron_command_t>(), valued<micron_state_t>(),
            valued<operator_t>(),      valued<registration_t>(), valued<retina_pose_t>(),    valued<servo_status_t>(),
            valued<tool_tip_t>(),      itself<burn_plan_t>(),    itself<mark_t>(),           itself<vessel_map_t>()};
  }

 private:
  template <class Message>
  Wired valued()
  {
    typename Conversion<Message>::Value value;
    Message message{};
    values_.fill(value);
    EXPECT_EQ(write(value, message), Reason::none);
    return wired(message);
  }
  template <class Message>
  Wired itself()
  {
    Message message{};
    values_.fill(message);
    return wired(message);
  }
  template <class Message>
  Wired wired(Message& message)
  {
    message.utime = message.utime_sent = kUtime + seq_ * 1000;
    message.seq = seq_;
    message.session = 5;
    return {channelOf<Message>(), support::encodedMessage(message, key_)};
  }

  std::optional<Key> key_;
  support::RandomValues values_{11};
  std::int64_t seq_ = 0;
};

/// Damage as networks, other programs and attackers do it.
Bytes damaged(Bytes bytes, std::mt19937& random)
{
  const auto place = [&](std::size_t room) { return random() % std::max<std::size_t>(1, bytes.size() - room); };
  switch (random() % 6) {
    case 0:
      bytes.resize(random() % (bytes.size() + 1));
      break;
    case 1:
      bytes.insert(bytes.end(), 1 + random() % 50, static_cast<std::uint8_t>(random()));
      break;
    case 2: {  // a count of millions, or a negative one
      const std::size_t at = place(4);
      for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(random());
      break;
    }
    case 3: {  // a number that is none
      const std::size_t at = place(8);
      bytes[at] = 0x7f;
      bytes[at + 1] = 0xf8;
      break;
    }
    case 4:
      for (std::uint8_t& byte : bytes) {
        if (random() % 20 == 0) byte = static_cast<std::uint8_t>(random());
      }
      break;
    default:
      for (std::size_t i = 8; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(random());
  }
  return bytes;
}

/// Sends 100,000 messages, each with damage that changed it.
void attack(Link& link, support::EverySubscription& subscriptions, MessageSource& source)
{
  std::mt19937 random(3);
  constexpr int kRounds = 100'000 / 12 + 1;
  for (int round = 1; round <= kRounds; ++round) {
    for (const Wired& message : source.next()) {
      const Bytes bytes = damaged(message.bytes, random);
      if (bytes == message.bytes) continue;
      link.send(message.channel, bytes.data(), bytes.size());
    }
    link.drain({kUtime + round * 1000, kUtime + round * 1000});
    for (ChannelReceiver* channel : subscriptions.all()) {
      if (channel->fault() != Reason::none) channel->acceptNewSession();
    }
  }
}

std::int64_t refusedBy(support::EverySubscription& subscriptions)
{
  std::int64_t refused = 0;
  for (const ChannelReceiver* channel : subscriptions.all()) {
    const std::int64_t here = std::accumulate(channel->refused().begin(), channel->refused().end(), std::int64_t{0});
    EXPECT_EQ(here + channel->accepted(), channel->received()) << channel->channel();
    EXPECT_EQ(channel->refused(Reason::internal_error), 0) << channel->channel();
    refused += here;
  }
  return refused;
}

TEST(HostileBytes, AreRefusedForACountedReasonWithoutMemoryBeyondTheLargestMap)
{
  Link link("memq://", 1, {});
  support::EverySubscription subscriptions{link, {}};
  MessageSource source({});
  const long before = residentKilobytes();
  attack(link, subscriptions, source);
  EXPECT_GT(refusedBy(subscriptions), 50'000);
  EXPECT_LT(residentKilobytes() - before, kMostKilobytes);
}

TEST(HostileBytes, NoneWithAWrongByteIsAcceptedWhereThereIsAKey)
{
  const Key key = {9, 8, 7};
  Link link("memq://", 1, key);
  support::EverySubscription subscriptions{link, {}};
  MessageSource source(key);
  attack(link, subscriptions, source);
  refusedBy(subscriptions);
  for (const ChannelReceiver* channel : subscriptions.all()) {
    const bool is_unsigned =
        channel == &subscriptions.burn_plan || channel == &subscriptions.mark || channel == &subscriptions.servo_status;
    EXPECT_TRUE(is_unsigned || channel->accepted() == 0) << channel->channel();
  }
}

// The four kinds of count that ended a typed subscriber (memory, crash, exception), at each place of each message.
TEST(HostileBytes, NoCountAnywhereEndsAReceiver)
{
  Link link("memq://", 1, {});
  support::EverySubscription subscriptions{link, {}};
  MessageSource source({});
  const long before = residentKilobytes();
  for (const Wired& message : source.next()) {
    for (std::size_t at = 8; at + 4 <= std::min<std::size_t>(message.bytes.size(), 260); ++at) {
      for (const std::uint32_t count : {0x7fffffffU, 0x20000000U, 100'000'000U, 0xffffffffU, 0U}) {
        Bytes bytes = message.bytes;
        for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(count >> (24U - 8U * i));
        link.send(message.channel, bytes.data(), bytes.size());
      }
      link.drain({kUtime, kUtime});
    }
  }
  refusedBy(subscriptions);
  EXPECT_LT(residentKilobytes() - before, kMostKilobytes);
}

TEST(HostileBytes, GoodMessagesOfEveryTypeAreHeard)
{
  const Key key = {9, 8, 7};
  Link link("memq://", 1, key);
  support::EverySubscription subscriptions{link, {}};
  MessageSource source(key);
  for (int round = 1; round <= 50; ++round) {
    for (const Wired& message : source.next()) link.send(message.channel, message.bytes.data(), message.bytes.size());
    link.drain({kUtime + round * 1000, kUtime + round * 1000});
  }
  for (const ChannelReceiver* channel : subscriptions.all()) EXPECT_EQ(channel->accepted(), 50) << channel->channel();
}

}  // namespace
}  // namespace eyeslam::messaging
