// SPDX-License-Identifier: GPL-3.0-or-later
#include "real_time/real_time_loop.h"

#include <cerrno>
#include <ctime>
#include <utility>

#include "real_time/scheduling.h"
#include "real_time/timer_grid.h"

namespace eyeslam::apps {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

std::int64_t nanoseconds(clockid_t clock)
{
  timespec now{};
  clock_gettime(clock, &now);
  return now.tv_sec * kSecond_ns + now.tv_nsec;
}

void sleepUntil(std::int64_t monotonic_ns)
{
  const timespec until{monotonic_ns / kSecond_ns, monotonic_ns % kSecond_ns};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace

RealTimeLoop::RealTimeLoop(const RealTimeLoopSetting& setting, Cycle cycle)
    : setting_(setting), cycle_(std::move(cycle)), thread_([this] { run(); })
{}

RealTimeLoop::~RealTimeLoop()
{
  askToEnd();
  if (thread_.joinable()) thread_.join();
}

void RealTimeLoop::join()
{
  if (thread_.joinable()) thread_.join();
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void RealTimeLoop::run() noexcept
{
  try {
    cycles();
  } catch (...) {
    failure_ = std::current_exception();
  }
  ended_ = true;
}

void RealTimeLoop::cycles()
{
  sharpenTimers();
  if (setting_.priority > 0) scheduleInRealTime(setting_.priority);  // whoever starts the loop has said if it may not
  const std::int64_t period = setting_.period_us * 1000;
  TimerGrid grid(nanoseconds(CLOCK_MONOTONIC) + period, period);
  CycleStart start;
  while (!asked_to_end_) {
    sleepUntil(grid.due());
    const std::int64_t now = nanoseconds(CLOCK_MONOTONIC);
    const TimerGrid::Start due = grid.start(now);
    start.monotonic = now / 1000;
    start.utime = nanoseconds(CLOCK_REALTIME) / 1000;
    start.lateness = due.lateness;
    start.left_out += due.left_out;
    const std::int64_t cpu = nanoseconds(CLOCK_THREAD_CPUTIME_ID);
    if (!cycle_(start)) return;
    start.computation = 1e-9 * static_cast<double>(nanoseconds(CLOCK_THREAD_CPUTIME_ID) - cpu);
  }
}

}  // namespace eyeslam::apps
