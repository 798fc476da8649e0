// SPDX-License-Identifier: GPL-3.0-or-later
#include "real_time/scheduling.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace eyeslam::apps {

std::string lockMemory()
{
  rlimit limit{};
  const bool limited = getrlimit(RLIMIT_MEMLOCK, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY;
  if (limited && geteuid() != 0) return "memory is not locked: the limit 'memlock' is not unlimited";
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return {};
  return fmt::format("memory is not locked: {}", std::strerror(errno));
}

std::string scheduleInRealTime(int priority)
{
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  if (error == 0) return {};
  return fmt::format("no SCHED_FIFO {}: {}", priority, std::strerror(error));
}

void sharpenTimers() { prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL); }

RealTimeSection::RealTimeSection(int priority)
{
  pthread_getschedparam(pthread_self(), &policy_, &parameters_);
  refusal_ = scheduleInRealTime(priority);
}

RealTimeSection::~RealTimeSection()
{
  if (refusal_.empty()) pthread_setschedparam(pthread_self(), policy_, &parameters_);
}

}  // namespace eyeslam::apps
