// SPDX-License-Identifier: GPL-3.0-or-later
// Events in their order of time, whatever order they stand in.
#include "eyeslam/replay/sorted_log.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "support/written_log.h"

namespace eyeslam::replay {
namespace {

using support::kLogStart;

constexpr std::int64_t kSecond = 1'000'000, kDay = 86'400 * kSecond;

struct Read {
  std::vector<std::int64_t> numbers;  // of the events, by their place in the file
  std::vector<std::int64_t> utimes;   // of their places in time
  std::vector<std::int64_t> parts;
  std::vector<bool> stray, late;
  SortFindings findings;
};

Read readSorted(const std::vector<std::int64_t>& utimes, SortWindow window = {})
{
  support::WrittenLog written;
  for (const std::int64_t utime : utimes) written.add("STATE", {1, 2, 3}, utime);
  SortedLog log(written.finish(), window);
  Read read;
  while (const auto event = log.next()) {
    read.numbers.push_back(event->event.number);
    read.utimes.push_back(event->utime);
    read.parts.push_back(event->part);
    read.stray.push_back(event->stray);
    read.late.push_back(event->late);
  }
  read.findings = log.findings();
  return read;
}

std::vector<std::int64_t> everyMillisecond(int events, std::int64_t start = kLogStart)
{
  std::vector<std::int64_t> utimes(static_cast<std::size_t>(events));
  for (std::size_t i = 0; i < utimes.size(); ++i) utimes[i] = start + 1000 * static_cast<std::int64_t>(i);
  return utimes;
}

bool isEachOnce(std::vector<std::int64_t> numbers, std::size_t events)
{
  std::sort(numbers.begin(), numbers.end());
  std::vector<std::int64_t> all(events);
  std::iota(all.begin(), all.end(), 0);
  return numbers == all;
}

// Who overtakes whom by less than the window: each event is logged by less than it after its time.
std::vector<std::int64_t> anyOrderWithin(std::int64_t span)
{
  const auto steps = *rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(0, span / 2));
  std::vector<std::pair<std::int64_t, std::int64_t>> logged;  // when, of which time
  std::int64_t utime = kLogStart;
  for (const std::int64_t step : steps) {
    utime += step;
    logged.emplace_back(utime + *rc::gen::inRange<std::int64_t>(0, span), utime);
  }
  std::stable_sort(logged.begin(), logged.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::int64_t> utimes;
  for (const auto& [when, of] : logged) utimes.push_back(of);
  return utimes;
}

RC_GTEST_PROP(SortedLog, OrdersAnyPermutationWithinItsWindowAndLosesNothing, ())
{
  SortWindow window;
  window.span_us = *rc::gen::inRange<std::int64_t>(1, 5000);
  const std::vector<std::int64_t> utimes = anyOrderWithin(window.span_us);
  const Read read = readSorted(utimes, window);
  RC_ASSERT(isEachOnce(read.numbers, utimes.size()));
  RC_ASSERT(std::is_sorted(read.utimes.begin(), read.utimes.end()));
  RC_ASSERT(read.findings.late == 0);
  RC_ASSERT(read.findings.strays == 0);
}

RC_GTEST_PROP(SortedLog, LosesNothingInAnyOrderAtAll, ())
{
  const auto utimes = *rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(0, 1LL << 52));
  SortWindow window;
  window.events = *rc::gen::inRange<std::size_t>(1, 10);
  const Read read = readSorted(utimes, window);
  RC_ASSERT(isEachOnce(read.numbers, utimes.size()));
  RC_ASSERT(std::count(read.late.begin(), read.late.end(), true) == read.findings.late);
  RC_ASSERT(std::count(read.stray.begin(), read.stray.end(), true) == read.findings.strays);
}

TEST(SortedLog, KeepsTheOrderOfEventsOfOneTime)
{
  std::vector<std::int64_t> utimes(300, kLogStart);
  std::fill(utimes.begin() + 150, utimes.end(), kLogStart + 1000);
  const Read read = readSorted(utimes);
  EXPECT_TRUE(std::is_sorted(read.numbers.begin(), read.numbers.end()));
}

TEST(SortedLog, DeliversWhatIsTooLateWhereItStandsAndSaysSo)
{
  std::vector<std::int64_t> utimes = everyMillisecond(5000);
  utimes[4000] = kLogStart + 100 * 1000;  // 3.9 s behind
  const Read read = readSorted(utimes);
  EXPECT_TRUE(isEachOnce(read.numbers, utimes.size()));
  EXPECT_EQ(read.findings.late, 1);
  EXPECT_NEAR(static_cast<double>(read.findings.latest_us), 3.9e6 - 1e6, 2000.0);  // behind what the window let go
  const auto late = std::find(read.late.begin(), read.late.end(), true);
  EXPECT_EQ(read.numbers[static_cast<std::size_t>(late - read.late.begin())], 4000);
}

TEST(SortedLog, HoldsNoMoreThanItsWindow)
{
  std::vector<std::int64_t> utimes = everyMillisecond(100);
  std::swap(utimes[10], utimes[20]);
  SortWindow window;
  window.events = 5;
  const Read read = readSorted(utimes, window);
  EXPECT_TRUE(isEachOnce(read.numbers, utimes.size()));
  EXPECT_GT(read.findings.late, 0);
}

TEST(SortedLog, LetsNoImpossibleTimeDisturbTheOthers)
{
  for (const std::int64_t wrong : {std::int64_t{0}, std::int64_t{1} << 62U, kLogStart + 365 * kDay, kLogStart - kDay}) {
    for (const std::size_t at : {0U, 1U, 2U, 3U, 500U, 999U}) {
      std::vector<std::int64_t> utimes = everyMillisecond(1000);
      utimes[at] = wrong;
      const Read read = readSorted(utimes);
      EXPECT_TRUE(std::is_sorted(read.numbers.begin(), read.numbers.end())) << wrong << " at " << at;
      EXPECT_EQ(read.numbers.size(), utimes.size());
      EXPECT_EQ(read.findings.strays, 1) << wrong << " at " << at;
      EXPECT_EQ(read.findings.late + read.findings.steps_back, 0) << wrong << " at " << at;
      const auto stray = std::find(read.stray.begin(), read.stray.end(), true);
      EXPECT_EQ(read.numbers[static_cast<std::size_t>(stray - read.stray.begin())], static_cast<std::int64_t>(at));
    }
  }
}

TEST(SortedLog, LetsSeveralImpossibleTimesInARowNotBearEachOtherOut)
{
  for (const std::int64_t wrong : {std::int64_t{0}, std::int64_t{1} << 62U, kLogStart + 365 * kDay}) {
    for (const std::size_t count : {2U, 5U, 32U}) {
      std::vector<std::int64_t> utimes = everyMillisecond(1000);
      std::fill_n(utimes.begin() + 500, count, wrong);
      const Read read = readSorted(utimes);
      EXPECT_TRUE(std::is_sorted(read.numbers.begin(), read.numbers.end())) << wrong << ", " << count;
      EXPECT_EQ(read.findings.strays, static_cast<std::int64_t>(count)) << wrong;
      EXPECT_EQ(read.findings.late + read.findings.steps_back, 0) << wrong << ", " << count;
    }
  }
}

// Ten minutes ahead is possible, so it is believed; but it must not end the wait for events that are overtaken.
TEST(SortedLog, LetsNoTimeThatIsAheadEmptyItsWindow)
{
  std::vector<std::int64_t> utimes = everyMillisecond(1000);
  utimes[500] += 600 * kSecond;
  std::swap(utimes[499], utimes[501]);
  const Read read = readSorted(utimes);
  EXPECT_TRUE(std::is_sorted(read.utimes.begin(), read.utimes.end()));
  EXPECT_EQ(read.numbers.back(), 500);
  EXPECT_EQ(read.findings.late + read.findings.strays, 0);
}

TEST(SortedLog, TakesAPauseOfADayForAPause)
{
  std::vector<std::int64_t> utimes = everyMillisecond(100);
  const std::vector<std::int64_t> next = everyMillisecond(100, kLogStart + kDay);
  utimes.insert(utimes.end(), next.begin(), next.end());
  const Read read = readSorted(utimes);
  EXPECT_EQ(read.utimes, utimes);
  EXPECT_EQ(read.findings.strays + read.findings.late + read.findings.steps_back, 0);
}

TEST(SortedLog, ReadsJoinedLogsOneAfterTheOther)
{
  std::vector<std::int64_t> utimes = everyMillisecond(100);
  const std::vector<std::int64_t> older = everyMillisecond(100, kLogStart - kDay);
  utimes.insert(utimes.end(), older.begin(), older.end());
  const Read read = readSorted(utimes);
  EXPECT_EQ(read.utimes, utimes);
  EXPECT_EQ(read.findings.steps_back, 1);
  EXPECT_EQ(read.findings.strays + read.findings.late, 0);
}

// Trials in lock step begin at the same time, all of them; and a clock may be set back.
TEST(SortedLog, ReadsALogAfterTheOneThatItOverlaps)
{
  for (const std::int64_t back : {5 * kSecond, 20 * kSecond}) {
    std::vector<std::int64_t> utimes = everyMillisecond(20'000);
    const std::vector<std::int64_t> again = everyMillisecond(20'000, kLogStart + 20 * kSecond - back);
    utimes.insert(utimes.end(), again.begin(), again.end());
    const Read read = readSorted(utimes);
    EXPECT_EQ(read.utimes, utimes);
    EXPECT_EQ(read.findings.steps_back, 1);
    EXPECT_EQ(read.findings.strays + read.findings.late, 0);
    EXPECT_EQ(std::count(read.parts.begin(), read.parts.end(), 0), 20'000);
    EXPECT_EQ(read.parts.back(), 1);
  }
}

TEST(SortedLog, PassesOtherPeoplesChannelsUntouched)
{
  support::WrittenLog written;
  const std::string channel("camera/\0left", 12);
  const support::Bytes picture(300'000, 0xA5);
  written.add(channel, picture, kLogStart);
  written.add("EMPTY", {}, kLogStart);
  SortedLog log(written.finish());
  const auto first = log.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->event.channel, channel);
  EXPECT_EQ(support::Bytes(first->event.data, first->event.data + first->event.size), picture);
  const auto second = log.next();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->event.size, 0U);
  EXPECT_FALSE(log.next());
  EXPECT_FALSE(log.next());
}

}  // namespace
}  // namespace eyeslam::replay
