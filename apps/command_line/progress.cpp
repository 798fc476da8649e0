// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "command_line/clocks.h"

namespace eyeslam::apps {
namespace {

constexpr double kBarPeriod = 0.1;   // s
constexpr double kLinePeriod = 5.0;  // s
constexpr int kBarWidth = 24;

std::string bar(double fraction)
{
  const int full = static_cast<int>(std::lround(fraction * kBarWidth));
  return fmt::format("[{:#<{}}{:.<{}}]", "", full, "", kBarWidth - full);
}

}  // namespace

std::string durationText(double seconds)
{
  const auto whole = std::llround(std::max(seconds, 0.0));
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

Progress::Progress(std::string what, std::optional<std::int64_t> total, Verbosity verbosity)
    : what_(std::move(what)),
      total_(total),
      quiet_(verbosity == Verbosity::quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(monotonicSeconds()),
      shown_(start_)
{}

Progress::~Progress()
{
  if (drawn_) fmt::print(stderr, "\r\033[K");
}

void Progress::show(std::int64_t done)
{
  if (quiet_) return;
  const double now = monotonicSeconds();
  if (now - shown_ < (terminal_ ? kBarPeriod : kLinePeriod)) return;
  shown_ = now;
  drawn_ = terminal_;
  fmt::print(stderr, terminal_ ? "\r{}\033[K" : "{}\n", text(done, now - start_));
}

std::string Progress::text(std::int64_t done, double elapsed) const
{
  const double rate = static_cast<double>(done) / std::max(elapsed, 1e-3);
  if (!total_ || *total_ <= 0) return fmt::format("{} {}, {:.1f}/s", what_, done, rate);
  const double fraction = std::min(1.0, static_cast<double>(done) / static_cast<double>(*total_));
  const double left = static_cast<double>(std::max<std::int64_t>(*total_ - done, 0)) / std::max(rate, 1e-3);
  return fmt::format("{} {} {:3.0f} % {}/{}, {:.1f}/s, {} left", what_, bar(fraction), 100.0 * fraction, done, *total_,
                     rate, durationText(left));
}

}  // namespace eyeslam::apps
