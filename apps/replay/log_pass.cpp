// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/log_pass.h"

#include <fmt/format.h>

#include "eyeslam/files/file_error.h"

namespace eyeslam::apps {
namespace {

std::int64_t megabytes(std::int64_t bytes) { return (bytes + 999'999) / 1'000'000; }

}  // namespace

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

void LogPass::showProgress() { progress_.show(megabytes(log_.reader().position())); }

void LogPass::requireEvents() const
{
  if (log_.reader().events() > 0) return;
  throw files::FileError(fmt::format("{}: no event of an LCM log in {} bytes; a file of lcm-logger is wanted", path_,
                                     log_.reader().size()));
}

}  // namespace eyeslam::apps
