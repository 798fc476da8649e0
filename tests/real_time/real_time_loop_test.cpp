// SPDX-License-Identifier: GPL-3.0-or-later
// What the loop does when it is late; how late it is belongs to no test (stack: plain Linux promises nothing).
#include "real_time/real_time_loop.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sched.h>
#include <time.h>

#include <atomic>
#include <stdexcept>
#include <vector>

#include "real_time/scheduling.h"
#include "real_time/timer_grid.h"

namespace eyeslam::apps {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;

void sleepFor(double seconds)
{
  const timespec span{0, static_cast<long>(1e9 * seconds)};
  nanosleep(&span, nullptr);
}

TEST(TimerGrid, LeavesOutWhatWasDueDuringALateCycle)
{
  TimerGrid grid(10 * kPeriod_ns, kPeriod_ns);
  const TimerGrid::Start on_time = grid.start(10 * kPeriod_ns);
  EXPECT_EQ(on_time.left_out, 0);
  EXPECT_EQ(on_time.lateness, 0.0);
  // Due at 11 and starting at 14.4: 12, 13 and 14 were due meanwhile, 15 is next.
  const TimerGrid::Start late = grid.start(14 * kPeriod_ns + 400'000);
  EXPECT_EQ(late.left_out, 3);
  EXPECT_DOUBLE_EQ(late.lateness, 3.4e-3);
  EXPECT_EQ(grid.due(), 15 * kPeriod_ns);
}

RC_GTEST_PROP(TimerGrid, NeverDriftsAndCountsEveryCycle, ())
{
  const auto first = *rc::gen::inRange<std::int64_t>(0, 1'000'000'000);
  const auto delays = *rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(0, 9 * kPeriod_ns));
  TimerGrid grid(first, kPeriod_ns);
  std::int64_t counted = 0;
  for (const std::int64_t delay : delays) {
    const std::int64_t now = grid.due() + delay;
    const TimerGrid::Start start = grid.start(now);
    counted += 1 + start.left_out;
    RC_ASSERT(start.lateness == 1e-9 * static_cast<double>(delay));
    RC_ASSERT(grid.due() == first + counted * kPeriod_ns);
    RC_ASSERT(grid.due() > now);
    RC_ASSERT(grid.due() - now <= kPeriod_ns);
  }
}

TEST(RealTimeLoop, KeepsTheClocksRateAndCountsWhatItLeavesOut)
{
  std::vector<CycleStart> starts;
  RealTimeLoop loop({}, [&](const CycleStart& start) {
    starts.push_back(start);
    if (starts.size() == 20) sleepFor(5.5e-3);
    return starts.size() < 60;
  });
  loop.join();
  ASSERT_EQ(starts.size(), 60U);
  EXPECT_GE(starts.back().left_out - starts[19].left_out, 4) << "a cycle of 5.5 ms leaves out five, or four at least";
  // Each start minus its lateness lies on the grid, and the grid has an interval for every cycle, run or left out.
  const auto due = [](const CycleStart& start) { return static_cast<double>(start.monotonic) - 1e6 * start.lateness; };
  for (std::size_t i = 1; i < starts.size(); ++i) {
    // What was left out while a cycle was late lies after it on the grid.
    const auto intervals = static_cast<double>(static_cast<std::int64_t>(i) + starts[i - 1].left_out);
    EXPECT_NEAR(due(starts[i]) - due(starts[0]), 1e3 * intervals, 1.5) << "us; clocks are read to 1 us";
  }
}

TEST(RealTimeLoop, TellsTheCpuTimeOfTheCycleBefore)
{
  std::vector<double> computations;
  RealTimeLoop loop({5000, 0}, [&](const CycleStart& start) {
    computations.push_back(start.computation);
    timespec begin{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
    double spent = 0.0;
    while (computations.size() == 1 && spent < 2e-3) {
      timespec now{};
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
      spent = static_cast<double>(now.tv_sec - begin.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec - begin.tv_nsec);
    }
    return computations.size() < 3;
  });
  loop.join();
  ASSERT_EQ(computations.size(), 3U);
  EXPECT_EQ(computations[0], 0.0);
  EXPECT_GE(computations[1], 2e-3);
  EXPECT_LT(computations[2], computations[1]);
}

TEST(RealTimeLoop, EndsWhenAsked)
{
  std::atomic<int> cycles{0};
  RealTimeLoop loop({}, [&](const CycleStart&) { return ++cycles > 0; });
  while (cycles < 5) sleepFor(1e-3);
  EXPECT_FALSE(loop.ended());
  loop.askToEnd();
  loop.join();
  EXPECT_TRUE(loop.ended());
}

TEST(RealTimeLoop, HandsOverTheExceptionThatEndedIt)
{
  RealTimeLoop loop({}, [](const CycleStart&) -> bool { throw std::runtime_error("broken"); });
  EXPECT_THROW(loop.join(), std::runtime_error);
  EXPECT_TRUE(loop.ended());
}

int policyOfThisThread()
{
  int policy = -1;
  sched_param parameters{};
  pthread_getschedparam(pthread_self(), &policy, &parameters);
  return policy;
}

TEST(RealTimeSection, CoversThreadsStartedInItAndEndsWithItself)
{
  int inside = -1;
  std::string refusal;
  {
    const RealTimeSection section(kLoopPriority - 1);
    refusal = section.refusal();
    std::thread([&] { inside = policyOfThisThread(); }).join();
  }
  EXPECT_EQ(inside, refusal.empty() ? SCHED_FIFO : SCHED_OTHER);
  EXPECT_EQ(policyOfThisThread(), SCHED_OTHER);
  EXPECT_TRUE(refusal.empty() || refusal.find("SCHED_FIFO") != std::string::npos) << refusal;
}

}  // namespace
}  // namespace eyeslam::apps
