// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/messaging/sender_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace eyeslam::messaging {
namespace {

constexpr std::int64_t kStart = 1'700'000'000'000'000;  // the sender's clock when the receiver's shows 0
constexpr std::int64_t kMillisecond = 1000;

/// One message a period, each delayed by up to `jitter` us; time in us by the receiver.
struct Stream {
  SenderClock clock;
  std::int64_t sent_at = 0;  // true time of sending
  std::int64_t step = 0;     // of the sender's clock
  double rate = 1.0;         // of the sender's clock
  std::int64_t last_received = 0;

  bool send(std::int64_t period, std::int64_t delay)
  {
    sent_at += period;
    last_received = std::max(last_received, sent_at + delay);
    return clock.follows(stamp(), last_received);
  }
  bool sendMany(int count, std::int64_t period, std::int64_t jitter)
  {
    bool good = true;
    for (int i = 0; i < count; ++i) good = send(period, 50 + (jitter == 0 ? 0 : std::rand() % jitter)) && good;
    return good;
  }
  std::int64_t stamp() const { return kStart + step + static_cast<std::int64_t>(rate * static_cast<double>(sent_at)); }
  /// Error of the relation, us.
  std::int64_t error() const { return std::abs(clock.toReceiver(stamp()) - sent_at); }
};

TEST(SenderClock, LearnsTheRelationFromTheQuickestMessages)
{
  Stream stream;
  EXPECT_TRUE(stream.sendMany(1000, kMillisecond, 5 * kMillisecond));
  EXPECT_LT(stream.error(), kMillisecond);
}

TEST(SenderClock, BearsAStallOfTheReceiverAndABacklogAtTheStart)
{
  Stream stream;
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(stream.send(kMillisecond, 150 * kMillisecond - i * kMillisecond));
  EXPECT_TRUE(stream.sendMany(500, kMillisecond, 0));
  for (int i = 0; i < 400; ++i) EXPECT_TRUE(stream.send(kMillisecond, 400 * kMillisecond - i * kMillisecond));
  EXPECT_TRUE(stream.sendMany(500, kMillisecond, 0));
  EXPECT_LT(stream.error(), kMillisecond);
}

TEST(SenderClock, BearsAFirstMessageThatWaitedForItsReader)
{
  Stream stream;
  EXPECT_TRUE(stream.send(kMillisecond, 80 * kMillisecond));
  EXPECT_TRUE(stream.send(100 * kMillisecond, 0));
  EXPECT_TRUE(stream.sendMany(100, kMillisecond, 0));
}

TEST(SenderClock, FollowsADriftOf100PpmForAnHour)
{
  for (const double drift : {100e-6, -100e-6}) {
    Stream stream;
    stream.rate = 1.0 + drift;
    EXPECT_TRUE(stream.sendMany(3600 * 20, 50 * kMillisecond, 3 * kMillisecond)) << drift;
    EXPECT_LT(stream.error(), kMillisecond) << drift;
  }
}

TEST(SenderClock, BearsAMinuteOfSilence)
{
  Stream stream;
  stream.sendMany(300, kMillisecond, 100);
  EXPECT_TRUE(stream.send(60'000 * kMillisecond, 50));
  EXPECT_TRUE(stream.sendMany(300, kMillisecond, 100));
}

TEST(SenderClock, SeesAStepAheadAtOnceAndStaysStepped)
{
  Stream stream;
  ASSERT_TRUE(stream.sendMany(300, kMillisecond, 100));
  stream.step = 30 * kMillisecond;
  EXPECT_FALSE(stream.send(kMillisecond, 50));
  stream.step = 0;
  EXPECT_FALSE(stream.sendMany(300, kMillisecond, 100));
  stream.clock.forget();
  EXPECT_TRUE(stream.sendMany(300, kMillisecond, 100));
}

TEST(SenderClock, SeesAStepBackBeyondTheLastMessageAtOnce)
{
  Stream stream;
  ASSERT_TRUE(stream.sendMany(300, kMillisecond, 100));
  stream.step = -3 * kMillisecond;
  EXPECT_FALSE(stream.send(kMillisecond, 50));
}

// 30 Hz: a step of 25 ms does not turn the order of two messages; it can only be told from a delay by its lasting.
TEST(SenderClock, SeesASmallerStepBackWithinTwoSeconds)
{
  Stream stream;
  ASSERT_TRUE(stream.sendMany(90, 33 * kMillisecond, 100));
  stream.step = -25 * kMillisecond;
  EXPECT_TRUE(stream.send(33 * kMillisecond, 50));
  EXPECT_FALSE(stream.sendMany(60, 33 * kMillisecond, 100));
}

TEST(SenderClock, TakesNoDelayOfASecondForAStep)
{
  Stream stream;
  ASSERT_TRUE(stream.sendMany(2000, kMillisecond, 100));
  for (int i = 0; i < 900; ++i) ASSERT_TRUE(stream.send(kMillisecond, 40 * kMillisecond));
  EXPECT_TRUE(stream.sendMany(2000, kMillisecond, 100));
}

}  // namespace
}  // namespace eyeslam::messaging
