// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/clocks.h"

#include <ctime>

namespace eyeslam::apps {
namespace {

double seconds(clockid_t clock)
{
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

double monotonicSeconds() { return seconds(CLOCK_MONOTONIC); }
double threadCpuMilliseconds() { return 1e3 * seconds(CLOCK_THREAD_CPUTIME_ID); }

std::int64_t utimeNow()
{
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1000000 + now.tv_nsec / 1000;
}

}  // namespace eyeslam::apps
