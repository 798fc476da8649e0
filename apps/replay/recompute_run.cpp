// SPDX-License-Identifier: GPL-3.0-or-later
#include "replay/recompute_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "command_line/program.h"
#include "eyeslam/configuration/field.h"
#include "eyeslam/files/file_error.h"
#include "eyeslam/files/partial_file.h"
#include "eyeslam/files/whole_file.h"
#include "eyeslam/replay/recorded_trial.h"
#include "eyeslam/replay/servo_replay.h"
#include "eyeslam/replay/video_replay.h"
#include "eyeslam/servo/servo_configuration.h"
#include "eyeslam/tracking/tracker_options.h"
#include "replay/comparison_text.h"
#include "replay/log_pass.h"
#include "replay/side_video_text.h"

namespace eyeslam::apps {
namespace {

using replay::RecomputedPart;

constexpr std::int64_t kBeyond_us = 1'000'000;  // read behind the part, so that all of it is computed

using Changes = std::vector<configuration::Assignment>;

// What changes nothing of what vision says lets the servo hear what was recorded: the comparison is of the servo alone.
bool changesTracker(const Changes& changes)
{
  return std::any_of(changes.begin(), changes.end(), [](const auto& one) { return replay::isOfTracker(one.key); });
}

// A question that nothing here can answer must not be answered with "no difference".
void requirePartFor(const Changes& changes, bool tracker, bool servo)
{
  for (const configuration::Assignment& one : changes) {
    if (!tracker && replay::isOfTracker(one.key))
      throw UsageError(one.key + ": the tracker is not computed again; its video is needed, and --only servo is not");
    if (!servo && replay::isOfServo(one.key))
      throw UsageError(one.key + ": the servo is not computed again; leave out --only");
  }
}

template <class Options>
bool knows(Options defaults, const configuration::Assignment& one)
{
  const std::vector<configuration::Field> fields = configuration::fieldsOf(defaults);
  return std::any_of(fields.begin(), fields.end(), [&one](const auto& field) { return field.key == one.key; });
}

// Of live programs each has its own keys: those that the other one alone knows are not for this one.
template <class Own, class Other>
Changes without(Changes changes, const Own& own, const Other& other)
{
  const auto is_others = [&](const configuration::Assignment& one) { return knows(other, one) && !knows(own, one); };
  changes.erase(std::remove_if(changes.begin(), changes.end(), is_others), changes.end());
  return changes;
}

void writeJson(const ReplayArguments& arguments, const std::string& text)
{
  if (arguments.json.empty()) return;
  files::PartialFile file(arguments.json);
  files::writeWholeFile(file.partialPath(), text);
  file.publish();
}

// A table of many logs must have the row of one that could not be read, too; what was found is told already.
void tellFailure(const ReplayArguments& arguments, const std::string& what)
{
  if (!std::filesystem::exists(arguments.json)) writeJson(arguments, failureJson(what));
}

class RecomputeRun {
 public:
  explicit RecomputeRun(const ReplayArguments& arguments) : arguments_(arguments), pass_(arguments, "computing again")
  {
    const Changes changes = changesOf(arguments);
    const std::string video = videoOf(arguments);
    const bool both = arguments.only.empty() && !video.empty();
    requirePartFor(changes, !video.empty(), arguments.only != "tracker");
    const tracking::TrackerOptions of_tracker;
    const servo::ServoConfiguration of_servo;
    if (arguments.only != "tracker") {
      servo_ =
          std::make_unique<replay::ServoReplay>(both ? without(changes, of_servo, of_tracker) : changes, comparison_);
    }
    if (video.empty()) return;
    replay::TrackerReplay::Each each;
    servo_hears_tracker_ = servo_ && changesTracker(changes);
    if (servo_hears_tracker_) each = [this](const replay::SortedEvent& event) { servo_->take(event); };
    tracker_ = std::make_unique<replay::VideoReplay>(
        replay::VideoReplayOptions{video, arguments.offset, both ? without(changes, of_tracker, of_servo) : changes},
        comparison_, each);
  }

  void run()
  {
    while (const auto event = pass_.next()) {
      if (restrictTo(*event)) break;
      if (tracker_) tracker_->take(*event);
      if (servo_ && !servo_hears_tracker_) servo_->take(*event);
    }
    pass_.end();
    for (RecomputedPart* part : parts()) part->finish();
    requireAny();
    tell();
    if (pass_.interrupted())
      throw std::runtime_error(fmt::format("{}: interrupted; only its beginning was computed", arguments_.log));
    requireCompared();
    if (!comparison_.isIdentical()) {
      throw std::runtime_error(fmt::format("{}: {}", arguments_.log, differenceText(comparison_, pass_.log().start())));
    }
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

  void requireCompared() const
  {
    const auto is_empty = [](const replay::ChannelComparison& channel) {
      return channel.compared + channel.missing + channel.extra == 0;
    };
    const auto& channels = comparison_.channels();
    if (std::all_of(channels.begin(), channels.end(), is_empty))
      throw std::runtime_error(fmt::format("{}: no message in this part; nothing was compared", arguments_.log));
  }

  void tell() const
  {
    writeJson(arguments_, comparisonJson(comparison_, pass_.log(), tracker_.get(), pass_.interrupted()));
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

void recomputeLog(const ReplayArguments& arguments)
{
  selectionOf(arguments);                                                // refuses what is no interval
  if (!arguments.json.empty()) std::filesystem::remove(arguments.json);  // of another run, it would be taken for this
  try {
    RecomputeRun(arguments).run();
  } catch (const UsageError&) {
    throw;
  } catch (const replay::ReplayError& error) {
    tellFailure(arguments, error.what());
    throw files::FileError(fmt::format("{}: {}", arguments.log, error.what()));
  } catch (const std::exception& error) {
    tellFailure(arguments, error.what());
    throw;
  }
}

}  // namespace eyeslam::apps
