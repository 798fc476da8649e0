// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/log_pass.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "command_line/program.h"
#include "eyeslam/files/file_error.h"
#include "eyeslam/replay/recomputed_part.h"
#include "eyeslam/replay/todays_type.h"
#include "replay/side_video_text.h"

namespace eyeslam::apps {
namespace {

std::int64_t megabytes(std::int64_t bytes) { return (bytes + 999'999) / 1'000'000; }

}  // namespace

void requireOthers(const ReplayArguments& arguments)
{
  const std::pair<const char*, std::string> outputs[] = {{"--out", arguments.out}, {"--json", arguments.json}};
  const std::pair<const char*, std::string> inputs[] = {
      {"log", arguments.log}, {"video", arguments.video.empty() ? videoBeside(arguments) : arguments.video}};
  for (const auto& [option, output] : outputs) {
    for (const auto& [what, input] : inputs) {
      std::error_code ignored;  // what does not exist is nothing's equal
      if (output.empty() || !std::filesystem::equivalent(input, output, ignored)) continue;
      throw UsageError(fmt::format("{} {}: is the {} itself; another name is wanted", option, output, what));
    }
  }
}

LogPass::LogPass(const ReplayArguments& arguments, const std::string& doing)
    : path_(arguments.log),
      log_(arguments.log),
      progress_(doing + ", MB", megabytes(log_.reader().size()), arguments.verbosity())
{}

std::optional<replay::SortedEvent> LogPass::next()
{
  if (events_ % kTurn == 0) {
    showProgress();
    interrupted_ = interrupted_ || interruption_.requested();
  }
  if (interrupted_) return std::nullopt;
  ++events_;
  return log_.next();
}

std::optional<replay::SortedEvent> LogPass::nextOfToday()
try {
  std::optional<replay::SortedEvent> event = next();
  if (event) replay::judgeToday(event->event);
  return event;
} catch (const replay::ReplayError& error) {
  throw files::FileError(fmt::format("{}: {}", path_, error.what()));
}

void LogPass::end() const
{
  requireEvents();
  const files::LogDamage& damage = log_.reader().damage();
  if (damage.gaps == 0 && !damage.cut_off) return;
  fmt::print(stderr, "eyeslam-replay: {}: {} bytes of it are no events and were skipped, at {} places; see `info`\n",
             path_, damage.skipped_bytes, damage.gaps);
}

void LogPass::showProgress() { progress_.show(megabytes(log_.reader().position())); }

void LogPass::requireEvents() const
{
  if (log_.reader().events() > 0) return;
  throw files::FileError(fmt::format("{}: no event of an LCM log in {} bytes; a file of lcm-logger is wanted", path_,
                                     log_.reader().size()));
}

}  // namespace eyeslam::apps
