// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/subscription.h"

#include <gtest/gtest.h>

#include <lcm/lcm-cpp.hpp>
#include <stdexcept>
#include <vector>

#include "eyeslam/messaging/laser_messages.h"
#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/messaging/record_messages.h"
#include "support/allocation_counter.h"
#include "support/encoded_message.h"

namespace eyeslam::messaging {
namespace {

using retina::Reason;
using support::Bytes;

constexpr std::int64_t kUtime = 1'700'000'000'000'000;  // when the receiver's clock shows 0
constexpr std::int64_t kMillisecond = 1000;
const Key kKey = {1, 2, 3};
const Key kOtherKey = {3, 2, 1};

/// A controller that listens to MICRON_COMMAND, and whatever somebody puts on the wire.
class Controller : public ::testing::Test {
 protected:
  micron_command_t command(std::int64_t seq, std::int64_t session = 7) const
  {
    MicronCommand value;
    value.mode = MicronMode::follow;
    value.goal.x() = 1e-6 * static_cast<double>(seq);
    micron_command_t message{};
    EXPECT_EQ(write(value, message), Reason::none);
    message.utime = kUtime + now_ - 5000;
    message.utime_sent = kUtime + now_;
    message.seq = seq;
    message.session = session;
    return message;
  }

  /// Puts the bytes on the channel and lets a millisecond pass.
  void put(const Bytes& bytes)
  {
    link_.send("MICRON_COMMAND", bytes.data(), bytes.size());
    now_ += kMillisecond;
  }
  void put(const micron_command_t& message) { put(support::encodedMessage(message, kKey)); }
  void drain() { link_.drain({now_, kUtime + now_}); }
  void hear(const Bytes& bytes)
  {
    put(bytes);
    drain();
  }
  void hear(const micron_command_t& message) { hear(support::encodedMessage(message, kKey)); }
  void hearMany(int count)
  {
    for (int i = 0; i < count; ++i) hear(command(i));
  }

  std::int64_t now_ = 1'000'000;
  Link link_{"memq://", 99, kKey};
  Subscription<micron_command_t> commands_{link_};
};

TEST_F(Controller, HearsWhatAHolderOfTheKeySends)
{
  EXPECT_EQ(commands_.latest(), nullptr);
  hear(command(3));
  ASSERT_NE(commands_.latest(), nullptr);
  EXPECT_EQ(commands_.latest()->goal.x(), 3e-6);
  EXPECT_EQ(commands_.header().seq, 3);
  EXPECT_EQ(commands_.received(), 1);
  EXPECT_EQ(commands_.accepted(), 1);
}

TEST_F(Controller, RefusesAForgedCommand)
{
  hear(support::encodedMessage(command(0), kOtherKey));
  hear(support::encodedMessage(command(1)));
  hear(support::encodedMessage(command(2), kKey, "LASER_COMMAND"));
  Bytes changed = support::encodedMessage(command(3), kKey);
  changed[80] = static_cast<std::uint8_t>(changed[80] ^ 1U);
  hear(changed);
  EXPECT_EQ(commands_.refused(Reason::unauthenticated), 4);
  EXPECT_EQ(commands_.latest(), nullptr);
}

TEST_F(Controller, AForgedCommandDoesNotTakeTheSession)
{
  hear(support::encodedMessage(command(0, 66), kOtherKey));
  hear(command(0));
  EXPECT_EQ(commands_.session(), 7);
}

TEST_F(Controller, RefusesAReplayedCommandAndKeepsTheLatest)
{
  const Bytes replayed = support::encodedMessage(command(0), kKey);
  hear(replayed);
  hear(command(1));
  hear(replayed);
  EXPECT_EQ(commands_.refused(Reason::replayed), 1);
  EXPECT_EQ(commands_.header().seq, 1);
}

TEST_F(Controller, RefusesACommandThatWasOvertaken)
{
  const Bytes overtaken = support::encodedMessage(command(1), kKey);
  hear(command(0));
  hear(command(2));
  hear(overtaken);
  EXPECT_EQ(commands_.refused(Reason::out_of_order), 1);
  EXPECT_EQ(commands_.lost(), 1);
  EXPECT_EQ(commands_.header().seq, 2);
}

TEST_F(Controller, RefusesALateCommand)
{
  hearMany(10);
  const Bytes late = support::encodedMessage(command(10), kKey);
  now_ += 60 * kMillisecond;
  hear(late);
  EXPECT_EQ(commands_.refused(Reason::expired), 1);
  EXPECT_EQ(commands_.header().seq, 9);
}

TEST_F(Controller, ACommandThatIsNotRenewedLapses)
{
  hearMany(10);
  EXPECT_NE(commands_.inForce(now_ + 48 * kMillisecond), nullptr);
  EXPECT_EQ(commands_.inForce(now_ + 51 * kMillisecond), nullptr);
  EXPECT_EQ(commands_.silence(now_ + 51 * kMillisecond), 51 * kMillisecond);
}

TEST_F(Controller, NothingIsInForceBeforeTheFirstCommand) { EXPECT_EQ(commands_.inForce(now_), nullptr); }

TEST_F(Controller, RefusesTheCommandsOfASecondServo)
{
  hear(command(0, 7));
  hear(command(0, 8));
  hear(command(1, 7));
  EXPECT_EQ(commands_.refused(Reason::wrong_session), 1);
  EXPECT_EQ(commands_.accepted(), 2);
  commands_.acceptNewSession();
  hear(command(1, 8));
  EXPECT_EQ(commands_.session(), 8);
}

TEST_F(Controller, StopsListeningWhenTheSendersClockSteps)
{
  hearMany(200);
  micron_command_t stepped = command(200);
  stepped.utime_sent += 100 * kMillisecond;
  hear(stepped);
  hear(command(201));
  EXPECT_EQ(commands_.refused(Reason::clock_stepped), 2);
  EXPECT_EQ(commands_.fault(), Reason::clock_stepped);
  commands_.acceptNewSession();
  hear(command(202));
  EXPECT_EQ(commands_.header().seq, 202);
}

TEST_F(Controller, RefusesAnotherTypeOnItsChannel)
{
  laser_command_t laser{};
  laser.session = 7;
  hear(support::encodedMessage(laser, kKey, "MICRON_COMMAND"));
  EXPECT_EQ(commands_.refused(Reason::wrong_type), 1);
}

TEST_F(Controller, RefusesTooFewAndTooManyBytes)
{
  Bytes bytes = support::encodedMessage(command(0), kKey);
  bytes.push_back(0);
  hear(bytes);
  bytes.resize(bytes.size() - 2);
  hear(bytes);
  bytes.resize(7);
  hear(bytes);
  hear(Bytes());
  // Signed as it is, so that only its length is wrong.
  Bytes shorter = support::encodedMessage(command(0));
  shorter.resize(shorter.size() - kTagBytes - 8);
  const Tag tag = Authenticator(kKey).tag("MICRON_COMMAND", shorter.data(), shorter.size());
  shorter.insert(shorter.end(), tag.begin(), tag.end());
  hear(shorter);
  EXPECT_EQ(commands_.refused(Reason::wrong_length), 3);
  EXPECT_EQ(commands_.refused(Reason::unauthenticated), 2);
  EXPECT_EQ(commands_.latest(), nullptr);
}

TEST_F(Controller, RefusesWhatIsNotFiniteOrImpossibleAndDoesNotGiveItTheSession)
{
  micron_command_t bad = command(0, 66);
  bad.goal[1] = std::nan("");
  hear(bad);
  bad = command(1, 66);
  bad.speed_bound = 50.0;
  hear(bad);
  EXPECT_EQ(commands_.refused(Reason::not_finite), 1);
  EXPECT_EQ(commands_.refused(Reason::out_of_range), 1);
  EXPECT_EQ(commands_.session(), 0);
}

TEST_F(Controller, RefusesTheExperimentOfYesterday)
{
  micron_command_t old = command(0, 66);
  old.utime_sent -= 86'400'000'000;
  hear(old);
  EXPECT_EQ(commands_.refused(Reason::clock_differs), 1);
  EXPECT_EQ(commands_.session(), 0);
}

TEST_F(Controller, HasTheLatestAfterDrainingABacklog)
{
  for (int i = 0; i < 100; ++i) put(command(i));
  drain();
  EXPECT_EQ(commands_.header().seq, 99);
  EXPECT_EQ(commands_.received(), 100);
  EXPECT_EQ(commands_.lost(), 0);
}

TEST_F(Controller, LeavesAFloodForTheNextDrain)
{
  for (int i = 0; i < 100; ++i) put(command(i));
  EXPECT_EQ(link_.drain({now_, kUtime + now_}, 10), 10U);
  EXPECT_EQ(commands_.header().seq, 9);
}

// A delay that all messages share is not known: 5 ms from image to sending, and none under way.
TEST_F(Controller, KnowsTheAgeOfWhatIsDescribedInItsOwnTime)
{
  hearMany(300);
  EXPECT_EQ(commands_.age(now_), 5000);
  EXPECT_EQ(commands_.age(now_ + kMillisecond), 6000);
  EXPECT_EQ(commands_.toReceiver(commands_.header().utime_sent), now_);
}

TEST_F(Controller, TakesAMessageWithoutAllocating)
{
  hearMany(3);
  for (int i = 3; i < 6; ++i) put(command(i));
  std::int64_t least = 1000;
  for (int i = 0; i < 3; ++i) {
    const std::int64_t before = support::allocations();
    link_.drain({now_, kUtime + now_}, 1);
    least = std::min(least, support::allocations() - before);
  }
  EXPECT_EQ(least, 0);
  EXPECT_EQ(commands_.accepted(), 6);
}

std::int64_t running = 0;  // us, of both clocks
ReceiveTime runningClocks() { return {running, kUtime + running}; }

// A busy computer keeps a reader from the processor, while the sender goes on.
TEST(Subscription, WhatComesWhileItsReaderStandsStillIsNoStepOfTheSendersClock)
{
  for (const bool live : {true, false}) {
    running = 1'000'000;
    Link link("memq://", 1, {});
    Publisher<micron_state_t> states(link);
    const auto send = [&] { states.publish(MicronState(), kUtime + running, kUtime + running); };
    Subscription<mark_t> standstill(link, [&](const mark_t&, const MessageHeader&) {
      running += 300 * kMillisecond;
      send();
    });
    Subscription<micron_state_t> heard(link);
    const auto drain = [&] { live ? link.drain(runningClocks) : link.drain(runningClocks()); };
    for (int i = 0; i < 200; ++i, running += kMillisecond) {
      send();
      drain();
    }
    mark_t mark{};
    Publisher<mark_t>(link).publish(mark, kUtime + running);
    drain();
    EXPECT_EQ(heard.accepted(), live ? 201 : 200);
    EXPECT_EQ(heard.refused(Reason::clock_stepped), live ? 0 : 1) << "by clocks that were read before";
  }
}

TEST(Subscription, HandsEveryAcceptedMessageToItsHandler)
{
  Link link("memq://", 1, {});
  std::vector<std::string> notes;
  Subscription<mark_t> marks(link, [&](const mark_t& mark, const MessageHeader&) { notes.push_back(mark.note); });
  Publisher<mark_t> publisher(link);
  mark_t mark{};
  for (const char* note : {"a", "b", "c"}) {
    mark.note = note;
    publisher.publish(mark, 1000);
  }
  link.drain({1000, 1000});
  EXPECT_EQ(notes, (std::vector<std::string>{"a", "b", "c"}));
}

// MARK and BURN_PLAN have several senders; what moves or fires has a tag, and one.
TEST(Subscription, HearsAnyoneWhereNothingMoves)
{
  Link link("memq://", 1, {});
  Subscription<mark_t> marks(link);
  mark_t mark{};
  for (const std::int64_t session : {5, 6, 5}) {
    mark.session = session;
    mark.utime = 700;
    mark.utime_sent = 1000;
    const Bytes bytes = support::encodedMessage(mark);
    link.send("MARK", bytes.data(), bytes.size());
    link.drain({2000, 1000});
    EXPECT_EQ(marks.session(), session);
    EXPECT_EQ(marks.age(2500), 800);
  }
  EXPECT_EQ(marks.accepted(), 3);
}

// LCM aborts the process at the next message when an exception has unwound through it.
TEST(Subscription, LetsNoExceptionOfItsHandlerOut)
{
  Link link("memq://", 1, {});
  Subscription<mark_t> marks(link, [](const mark_t&, const MessageHeader&) { throw std::runtime_error("no"); });
  Publisher<mark_t> publisher(link);
  mark_t mark{};
  for (int i = 0; i < 3; ++i) publisher.publish(mark, 1000);
  EXPECT_EQ(link.drain({1000, 1000}), 3U);
  EXPECT_EQ(marks.refused(Reason::internal_error), 3);
}

TEST(Subscription, TakesAMessageInLockStepWhenItWasSent)
{
  Link link("memq://", 1, {});
  Subscription<micron_state_t> states(link);
  Publisher<micron_state_t> publisher(link);
  publisher.publish(MicronState(), 900, 1000);
  link.drain({5000, 1000});
  publisher.publish(MicronState(), 1900, 2000);
  EXPECT_EQ(states.silence(6000), 1000);
  EXPECT_TRUE(link.step());
  EXPECT_EQ(states.silence(2000), 0);
  EXPECT_FALSE(link.step());
}

TEST(Subscription, RefusesAChannelThatLcmWouldTakeForAPattern)
{
  Link link("memq://", 1, {});
  for (const char* channel : {".*", "A(", "", "A B"}) {
    EXPECT_THROW(Subscription<mark_t>(link, {}, channel), std::runtime_error) << channel;
  }
}

TEST(Subscription, MayEndBeforeItsLink)
{
  Link link("memq://", 1, {});
  Publisher<mark_t> publisher(link);
  mark_t mark{};
  {
    Subscription<mark_t> marks(link);
    publisher.publish(mark, 1000);
  }
  link.drain({2000, 2000});
  Subscription<mark_t> marks(link);
  publisher.publish(mark, 3000);
  link.drain({3000, 3000});
  EXPECT_EQ(marks.header().seq, 1);
}

TEST(Publisher, SendsNoValueWithANumberThatIsNone)
{
  Link link("memq://", 1, {});
  Subscription<micron_command_t> commands(link);
  Publisher<micron_command_t> publisher(link);
  MicronCommand command;
  EXPECT_TRUE(publisher.publish(command, 900, 1000));
  command.speed_bound = std::nan("");
  EXPECT_FALSE(publisher.publish(command, 900, 1000));
  link.drain({1000, 1000});
  EXPECT_EQ(commands.received(), 1);
  EXPECT_EQ(commands.header().utime, 900);
}

}  // namespace
}  // namespace eyeslam::messaging
