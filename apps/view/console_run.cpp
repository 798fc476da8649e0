// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/console_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>

#include "eyeslam/files/file_error.h"

namespace eyeslam::apps {
namespace {

constexpr int kTurn_ms = 10;
constexpr std::int64_t kFarewell_us = 300'000;  // six OPERATOR: one of them arrives

// Whoever reads through a pipe must not wait for a full buffer.
void say(const std::string& line)
{
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

}  // namespace

ConsoleRun::ConsoleRun(const ViewArguments& arguments)
    : terminal_(isatty(STDIN_FILENO) != 0),
      lines_(STDIN_FILENO),
      link_(openLink(arguments.link, newSession())),
      mark_(link_, "eyeslam-view", {}),
      console_(link_, centreOf(arguments), say)
{
  const std::string notice = unsignedNotice(arguments.link);
  if (!arguments.quiet && !notice.empty()) fmt::print(stderr, "eyeslam-view: {}\n", notice);
  if (terminal_) say("'help' lists the commands");
}

void ConsoleRun::run()
{
  std::string failure;
  try {
    obeyLines();
  } catch (const CommandError& error) {
    failure = error.what();
  }
  endInStandby();
  if (!failure.empty()) throw CommandError(failure);
}

// A line a turn: each is a wish of its own that the servo hears, also where a file has many.
void ConsoleRun::obeyLines()
{
  while (!console_.quits() && !interruption_.requested()) {
    turn(!console_.waits());
    if (console_.waits()) continue;
    if (const std::optional<std::string> line = lines_.next()) {
      ++line_;
      obey(*line);
    } else if (lines_.ended()) {
      return;
    }
  }
}

// A human at the keyboard is told and goes on; a script that went wrong does not.
void ConsoleRun::obey(const std::string& line)
{
  std::string complaint;
  try {
    console_.obey(line, receiveTime());
    return;
  } catch (const CommandError& error) {
    complaint = error.what();
  } catch (const files::FileError& error) {
    complaint = error.what();
  }
  if (!terminal_) throw CommandError(fmt::format("line {}: {}", line_, complaint));
  fmt::print(stderr, "{}\n", complaint);
}

void ConsoleRun::turn(bool reads)
{
  if (reads) {
    lines_.wait(kTurn_ms);
  } else {
    usleep(kTurn_ms * 1000);
  }
  link_.drain(receiveTime);
  try {
    console_.work(receiveTime());
  } catch (const CommandError& error) {
    if (!terminal_) throw CommandError(fmt::format("line {}: {}", line_, error.what()));
    fmt::print(stderr, "{}\n", error.what());
  }
}

void ConsoleRun::endInStandby()
{
  const messaging::ReceiveTime begin = receiveTime();
  console_.standBy(begin);
  while (receiveTime().monotonic - begin.monotonic < kFarewell_us) turn(false);
  say("standby; the console ends");
}

}  // namespace eyeslam::apps
