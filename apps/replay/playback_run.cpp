// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/playback_run.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "command_line/clocks.h"
#include "replay/log_pass.h"

namespace eyeslam::apps {
namespace {

void sleepUntil(double monotonic)
{
  timespec until{};
  until.tv_sec = static_cast<time_t>(std::floor(monotonic));
  until.tv_nsec = static_cast<long>(1e9 * (monotonic - std::floor(monotonic)));
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

// Keeps a log's times on the monotonic clock: lateness of one event delays no other. Where one log was joined to a
// later one, or its clock was set back, time begins anew.
class LogClock {
 public:
  explicit LogClock(double speed) : speed_(speed) {}

  double due(const replay::SortedEvent& event)
  {
    if (!first_us_ || event.part != part_) {
      first_us_ = event.since_us;
      part_ = event.part;
      start_ = monotonicSeconds();
    }
    return start_ + 1e-6 * static_cast<double>(event.since_us - *first_us_) / speed_;
  }

 private:
  double speed_;
  std::optional<std::int64_t> first_us_;
  std::int64_t part_ = 0;
  double start_ = 0.0;
};

class Playback {
 public:
  explicit Playback(const ReplayArguments& arguments)
      : arguments_(arguments),
        selection_(selectionOf(arguments)),
        pass_(arguments, "playing"),
        link_(openLink(arguments.link, newSession())),
        clock_(arguments.speed)
  {}

  void run()
  {
    if (arguments_.link.key.empty() && !arguments_.quiet) {
      fmt::print(stderr, "no --key FILE: what is played stays on this computer\n");
    }
    while (const auto event = pass_.next()) {
      if (selection_.takes(*event) && waitFor(*event)) send(*event);
    }
    pass_.end();
    report();
  }

 private:
  // In slices, for a log may be silent for hours. Returns false when it was interrupted.
  bool waitFor(const replay::SortedEvent& event)
  {
    constexpr double kSlice = 0.1;  // s
    const double due = clock_.due(event);
    for (double now = monotonicSeconds(); now < due; now = monotonicSeconds()) {
      if (pass_.interruption().requested()) {
        pass_.interrupt();
        return false;
      }
      pass_.showProgress();
      sleepUntil(std::min(due, now + kSlice));
    }
    return true;
  }

  void send(const replay::SortedEvent& event)
  {
    const files::LogEvent& e = event.event;
    const double late = monotonicSeconds() - clock_.due(event);
    if (late > latest_) latest_at_us_ = event.since_us;
    latest_ = std::max(latest_, late);
    channel_.assign(e.channel);
    // LCM takes C strings: a channel with a NUL inside would go out under another name.
    const bool whole = channel_.find('\0') == std::string::npos;
    ++(whole && link_.send(channel_, e.data, e.size) ? sent_ : refused_);
    last_us_ = event.since_us;
  }

  void report() const
  {
    if (pass_.interrupted()) {
      fmt::print(stderr, "eyeslam-replay: interrupted at {:.3f} s of the log\n", 1e-6 * static_cast<double>(last_us_));
    }
    if (!arguments_.quiet) {
      fmt::print("{}: {} events at {:g} times real time, at most {:.1f} ms late (at {:.3f} s)\n", link_.url(), sent_,
                 arguments_.speed, 1e3 * latest_, 1e-6 * static_cast<double>(latest_at_us_));
    }
    if (sent_ + refused_ == 0 && !pass_.interrupted())
      throw std::runtime_error(fmt::format("{}: no event in this part; nothing played", arguments_.log));
    if (refused_ > 0) {
      throw std::runtime_error(fmt::format("{}: LCM refused {} of {} events", link_.url(), refused_, refused_ + sent_));
    }
  }

  const ReplayArguments& arguments_;
  replay::LogSelection selection_;
  LogPass pass_;  // before the link, whose threads shall not take its signals
  messaging::Link link_;
  LogClock clock_;
  std::string channel_;
  std::int64_t sent_ = 0, refused_ = 0, last_us_ = 0, latest_at_us_ = 0;
  double latest_ = 0.0;  // s
};

}  // namespace

void playLog(const ReplayArguments& arguments) { Playback(arguments).run(); }

}  // namespace eyeslam::apps
