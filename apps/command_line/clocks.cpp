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

}  // namespace eyeslam::apps
