// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/channel_guard.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <set>
#include <vector>

namespace eyeslam::messaging {
namespace {

using retina::Reason;

constexpr std::int64_t kUtime = 1'700'000'000'000'000;  // the sender's clock when the receiver's shows 0
constexpr std::int64_t kMillisecond = 1000;

/// Messages of one or more senders, a millisecond apart, to one guard.
struct Talk {
  ChannelGuard guard;
  std::int64_t now = 1'000'000;

  MessageHeader header(std::int64_t session, std::int64_t seq) const
  {
    return {kUtime + now - 5000, kUtime + now, seq, session};
  }
  Reason say(std::int64_t session, std::int64_t seq)
  {
    now += kMillisecond;
    return hear(header(session, seq));
  }
  Reason hear(const MessageHeader& message, std::optional<double> expiry = 0.05)
  {
    return guard.admit(message, {now, kUtime + now}, expiry);
  }
};

TEST(ChannelGuard, HearsTheFirstSessionAndNoOther)
{
  Talk talk;
  EXPECT_EQ(talk.say(7, 0), Reason::none);
  EXPECT_EQ(talk.say(8, 0), Reason::wrong_session);
  EXPECT_EQ(talk.say(7, 1), Reason::none);
  EXPECT_EQ(talk.guard.session(), 7);
}

TEST(ChannelGuard, HearsAnotherSessionOnlyAfterAHumanActAndTheReplacedOneNeverAgain)
{
  Talk talk;
  talk.say(7, 0);
  talk.guard.acceptNewSession();
  EXPECT_EQ(talk.say(8, 0), Reason::none);
  EXPECT_EQ(talk.say(7, 1), Reason::wrong_session);
  talk.guard.acceptNewSession();
  EXPECT_EQ(talk.say(7, 2), Reason::wrong_session);
  EXPECT_EQ(talk.say(8, 1), Reason::none);
}

// Two servos: re-arming opens the channel for one message, and who is heard then stays.
TEST(ChannelGuard, ClosesAgainWithTheFirstMessageAfterTheAct)
{
  Talk talk;
  talk.say(7, 0);
  talk.guard.acceptNewSession();
  EXPECT_EQ(talk.say(7, 1), Reason::none);
  EXPECT_EQ(talk.say(8, 0), Reason::wrong_session);
}

TEST(ChannelGuard, NeverBeginsWithAnExperimentOfThePast)
{
  Talk talk;
  MessageHeader old = talk.header(7, 0);
  old.utime_sent -= 6'000'000;
  EXPECT_EQ(talk.hear(old), Reason::clock_differs);
  EXPECT_EQ(talk.say(8, 0), Reason::none);
}

RC_GTEST_PROP(ChannelGuard, TakesEachNumberOnceAndOnlyUpwards, (std::vector<std::uint8_t> numbers))
{
  Talk talk;
  std::set<int> seen;
  int highest = -1;
  for (const int seq : numbers) {
    const Reason verdict = talk.say(7, seq);
    if (seq > highest) {
      RC_ASSERT(verdict == Reason::none);
    } else if (seen.count(seq) != 0 || highest - seq >= 64) {
      RC_ASSERT(verdict == Reason::replayed);
    } else {
      RC_ASSERT(verdict == Reason::out_of_order);
    }
    seen.insert(seq);
    highest = std::max(highest, seq);
  }
}

TEST(ChannelGuard, CountsTheNumbersLeftOut)
{
  Talk talk;
  for (const int seq : {5, 6, 9, 200}) talk.say(7, seq);
  EXPECT_EQ(talk.guard.lost(), 2 + 190);
  talk.guard.acceptNewSession();
  for (const int seq : {3, 5}) talk.say(8, seq);
  EXPECT_EQ(talk.guard.lost(), 2 + 190 + 1);
}

TEST(ChannelGuard, RefusesACommandThatWasTooLongUnderWay)
{
  Talk talk;
  for (int i = 0; i < 10; ++i) talk.say(7, i);
  const MessageHeader late = talk.header(7, 10);
  talk.now += 49 * kMillisecond;
  EXPECT_EQ(talk.hear(late), Reason::none);
  const MessageHeader later = talk.header(7, 11);
  talk.now += 51 * kMillisecond;
  EXPECT_EQ(talk.hear(later), Reason::expired);
  const MessageHeader telemetry = talk.header(7, 12);
  talk.now += 51 * kMillisecond;
  EXPECT_EQ(talk.hear(telemetry, std::nullopt), Reason::none);
}

TEST(ChannelGuard, JudgesExpiryByItsOwnClockWhateverTheSendersShows)
{
  Talk talk;
  const std::int64_t ahead = 2'000'000;
  for (int i = 0; i < 10; ++i) {
    talk.now += kMillisecond;
    MessageHeader message = talk.header(7, i);
    message.utime_sent += ahead;
    EXPECT_EQ(talk.hear(message), Reason::none);
  }
  MessageHeader late = talk.header(7, 10);
  late.utime_sent += ahead;
  talk.now += 60 * kMillisecond;
  EXPECT_EQ(talk.hear(late), Reason::expired);
}

TEST(ChannelGuard, ASteppedClockIsAFaultUntilAHumanReArms)
{
  Talk talk;
  for (int i = 0; i < 200; ++i) ASSERT_EQ(talk.say(7, i), Reason::none);
  MessageHeader stepped = talk.header(7, 200);
  stepped.utime_sent += 1'000'000;
  EXPECT_EQ(talk.hear(stepped), Reason::clock_stepped);
  EXPECT_EQ(talk.say(7, 201), Reason::clock_stepped);
  EXPECT_EQ(talk.guard.fault(), Reason::clock_stepped);
  talk.guard.acceptNewSession();
  EXPECT_EQ(talk.guard.fault(), Reason::none);
  EXPECT_EQ(talk.say(7, 202), Reason::none);
  EXPECT_EQ(talk.say(7, 201), Reason::replayed);
}

TEST(ChannelGuard, RefusesTimesAndNumbersThatNobodyHas)
{
  const std::int64_t most = std::numeric_limits<std::int64_t>::max();
  const std::int64_t least = std::numeric_limits<std::int64_t>::min();
  Talk talk;
  const MessageHeader good = talk.header(7, 0);
  for (const std::int64_t bad : {most, least, std::int64_t{-1}}) {
    EXPECT_EQ(talk.hear({bad, good.utime_sent, 0, 7}), Reason::out_of_range);
    EXPECT_EQ(talk.hear({good.utime, bad, 0, 7}), Reason::out_of_range);
  }
  EXPECT_EQ(talk.hear({good.utime, good.utime_sent, -1, 7}), Reason::out_of_range);
  EXPECT_EQ(talk.hear({good.utime, good.utime_sent, 0, 0}), Reason::out_of_range);
  EXPECT_EQ(talk.hear({good.utime, good.utime_sent, most, 7}), Reason::none);
}

}  // namespace
}  // namespace eyeslam::messaging
