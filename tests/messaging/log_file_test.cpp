// SPDX-License-Identifier: GPL-3.0-or-later
// The same interface over LCM's log files.
#include <gtest/gtest.h>

#include <filesystem>
#include <thread>
#include <vector>

#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/messaging/subscription.h"
#include "support/temporary_folder.h"

namespace eyeslam::messaging {
namespace {

constexpr std::int64_t kUtime = 1'700'000'000'000'000;

class LogFile : public ::testing::Test {
 protected:
  /// 1 s of states at 1 kHz, a mark after every hundredth.
  void writeLog()
  {
    Link link("file://" + path_ + "?mode=w", 7, key_);
    Publisher<micron_state_t> states(link);
    Publisher<mark_t> marks(link);
    mark_t mark{};
    for (int i = 0; i < 1000; ++i) {
      const std::int64_t now = kUtime + 1000 * i;
      MicronState state;
      state.tip.position.x() = 1e-6 * i;
      ASSERT_TRUE(states.publish(state, now - 300, now));
      ASSERT_TRUE(i % 100 != 99 || marks.publish(mark, now));
    }
  }

  support::TemporaryFolder folder_;
  std::string path_ = folder_.path("trial.lcm");
  const Key key_ = {4, 5, 6};
};

TEST_F(LogFile, IsReadInLockStepEachMessageAtItsOwnTime)
{
  writeLog();
  Link link("file://" + path_ + "?speed=0", 1, key_);
  Subscription<micron_state_t> states(link);
  Subscription<mark_t> marks(link);
  std::int64_t steps = 0;
  while (link.step()) {
    ++steps;
    const std::int64_t now = states.header().utime_sent;
    ASSERT_EQ(states.silence(now), 0);
    ASSERT_EQ(states.age(now), 300);
    ASSERT_EQ(states.latest()->tip.position.x(), 1e-6 * static_cast<double>(states.header().seq));
  }
  EXPECT_EQ(steps, 1010);
  EXPECT_EQ(states.accepted(), 1000);
  EXPECT_EQ(states.lost(), 0);
  EXPECT_EQ(marks.accepted(), 10);
  EXPECT_FALSE(link.step());
}

TEST_F(LogFile, ThatWasCutGivesWhatIsThereAndEnds)
{
  writeLog();
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) / 2 + 13);
  Link link("file://" + path_ + "?speed=0", 1, key_);
  Subscription<micron_state_t> states(link);
  while (link.step()) continue;
  EXPECT_GT(states.accepted(), 490);
  EXPECT_LT(states.accepted(), 510);
}

TEST_F(LogFile, OfAnotherKeyIsNotBelieved)
{
  writeLog();
  Link link("file://" + path_ + "?speed=0", 1, Key{1});
  Subscription<micron_state_t> states(link);
  while (link.step()) continue;
  EXPECT_EQ(states.accepted(), 0);
  EXPECT_EQ(states.refused(retina::Reason::unauthenticated), 1000);
}

// LCM's own writer lets the events of two threads run into each other.
TEST_F(LogFile, IsWrittenWholeBySeveralThreads)
{
  constexpr int kEach = 40'000;
  {
    Link link("file://" + path_ + "?mode=w", 7, {});
    std::thread other([&link] {
      Publisher<mark_t> marks(link);
      mark_t mark{};
      for (int i = 0; i < kEach; ++i) marks.publish(mark, kUtime + i);
    });
    Publisher<micron_state_t> states(link);
    for (int i = 0; i < kEach; ++i) states.publish(MicronState{}, kUtime + i, kUtime + i);
    other.join();
  }
  Link link("file://" + path_ + "?speed=0", 1, {});
  Subscription<micron_state_t> states(link);
  Subscription<mark_t> marks(link);
  while (link.step()) continue;
  EXPECT_EQ(states.received(), kEach);
  EXPECT_EQ(marks.received(), kEach);
}

TEST_F(LogFile, ThatDoesNotExistIsRefusedByName)
{
  EXPECT_THROW(Link("file://" + path_ + "?speed=0", 1, {}), std::runtime_error);
}

}  // namespace
}  // namespace eyeslam::messaging
