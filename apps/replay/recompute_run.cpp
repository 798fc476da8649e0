// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/recompute_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/partial_file.h"
#include "eyeslam/files/whole_file.h"
#include "eyeslam/replay/servo_replay.h"
#include "eyeslam/replay/video_replay.h"
#include "replay/comparison_text.h"
#include "replay/log_pass.h"
#include "replay/side_video_text.h"

namespace eyeslam::apps {
namespace {

using replay::RecomputedPart;

constexpr std::int64_t kBeyond_us = 1'000'000;  // read behind the part, so that all of it is computed

// What changes nothing of what vision says lets the servo hear what was recorded: the comparison is of the servo alone.
bool changesTracker(const std::vector<configuration::Assignment>& changes)
{
  return std::any_of(changes.begin(), changes.end(),
                     [](const configuration::Assignment& one) { return one.key.rfind("vision.", 0) == 0; });
}

class RecomputeRun {
 public:
  explicit RecomputeRun(const ReplayArguments& arguments) : arguments_(arguments), pass_(arguments, "computing again")
  {
    selectionOf(arguments);  // refuses what is no interval
    const std::vector<configuration::Assignment> changes = changesOf(arguments);
    if (arguments.only != "tracker") servo_ = std::make_unique<replay::ServoReplay>(changes, comparison_);
    const std::string video = videoOf(arguments);
    if (video.empty()) return;
    replay::TrackerReplay::Each each;
    servo_hears_tracker_ = servo_ && changesTracker(changes);
    if (servo_hears_tracker_) each = [this](const replay::SortedEvent& event) { servo_->take(event); };
    tracker_ = std::make_unique<replay::VideoReplay>(replay::VideoReplayOptions{video, arguments.offset, changes},
                                                     comparison_, each);
  }

  void run()
  try {
    while (const auto event = pass_.next()) {
      if (restrictTo(*event)) break;
      if (tracker_) tracker_->take(*event);
      if (servo_ && !servo_hears_tracker_) servo_->take(*event);
    }
    pass_.requireEvents();
    for (RecomputedPart* part : parts()) part->finish();
    requireAny();
    tell();
    if (!comparison_.isIdentical()) {
      throw std::runtime_error(fmt::format("{}: {}", arguments_.log, differenceText(comparison_, pass_.log().start())));
    }
  } catch (const replay::ReplayError& error) {
    throw files::FileError(fmt::format("{}: {}", arguments_.log, error.what()));
  }

 private:
  // In the order in which one hears the other.
  std::vector<RecomputedPart*> parts() const
  {
    std::vector<RecomputedPart*> parts;
    if (tracker_) parts.push_back(tracker_.get());
    if (servo_) parts.push_back(servo_.get());
    return parts;
  }

  // At the first event, which tells when the log begins. @return whether the rest is of no interest
  bool restrictTo(const replay::SortedEvent& event)
  {
    const auto utime = [this](double seconds) { return pass_.log().start() + std::llround(1e6 * seconds); };
    const replay::LogPart& part = arguments_.part;
    if (!restricted_) {
      comparison_.restrictTo(part.from ? utime(*part.from) : std::numeric_limits<std::int64_t>::min(),
                             part.to ? utime(*part.to) : std::numeric_limits<std::int64_t>::max());
    }
    restricted_ = true;
    return part.to && event.utime > utime(*part.to) + kBeyond_us;
  }

  void requireAny() const
  {
    const auto is_there = [](const RecomputedPart* part) { return part->lacking().empty(); };
    const std::vector<RecomputedPart*> all = parts();
    if (!std::any_of(all.begin(), all.end(), is_there)) throw replay::ReplayError(all.back()->lacking());
  }

  void tell() const
  {
    if (!arguments_.json.empty()) {
      files::PartialFile file(arguments_.json);
      files::writeWholeFile(file.partialPath(), comparisonJson(comparison_, pass_.log(), tracker_.get()));
      file.publish();
    }
    if (pass_.interrupted()) fmt::print(stderr, "eyeslam-replay: interrupted; this is only the beginning of the log\n");
    if (arguments_.quiet) return;
    for (const RecomputedPart* part : parts()) {
      fmt::print("{}\n", part->lacking().empty() ? part->about() : "not computed: " + part->lacking());
    }
    if (tracker_) fmt::print("{}", videoText(*tracker_));
    fmt::print("{}", comparisonText(comparison_, pass_.log().start()));
    if (servo_) tellGoals(servo_->goals());
  }

  void tellGoals(const replay::GoalDistances& goals) const
  {
    if (goals.count() == 0 || goals.largest() == 0.0) return;
    fmt::print("\ngoals of {} commands: {:.3g} um apart in the median, {:.3g} um p95, {:.3g} um at most\n",
               goals.count(), goals.quantile(0.5), goals.quantile(0.95), goals.largest());
  }

  const ReplayArguments& arguments_;
  LogPass pass_;
  replay::Comparison comparison_;
  std::unique_ptr<replay::VideoReplay> tracker_;
  std::unique_ptr<replay::ServoReplay> servo_;
  bool servo_hears_tracker_ = false;  // as it is computed again, not as it was
  bool restricted_ = false;
};

}  // namespace

void recomputeLog(const ReplayArguments& arguments) { RecomputeRun(arguments).run(); }

}  // namespace eyeslam::apps
