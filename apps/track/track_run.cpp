// SPDX-License-Identifier: GPL-3.0-or-later
#include "track/track_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "command_line/clocks.h"
#include "command_line/program.h"
#include "command_line/version.h"
#include "eyeslam/configuration/json.h"
#include "eyeslam/configuration/listing.h"
#include "eyeslam/files/map_files.h"
#include "eyeslam/files/whole_file.h"
#include "eyeslam/tracking/eyeslam_tracker.h"
#include "track/message_publisher.h"
#include "track/overlay_writer.h"
#include "track/recorder.h"
#include "track/track_window.h"
#include "track/truth_report.h"

namespace eyeslam::apps {
namespace {

constexpr std::int64_t kSpaceCheckPeriod = 64;  // frames

const std::vector<std::string> kOwnedNames = {"trajectory.csv", "map",           "vessels.csv",
                                              "mosaic.png",     "mosaic.json",   "overlay.mp4",
                                              "truth_pose.png", "truth_map.png", "run.json"};

Verbosity verbosity(const TrackArguments& arguments) { return arguments.quiet ? Verbosity::quiet : Verbosity::normal; }

files::VideoSourceOptions sourceOptions(const TrackArguments& arguments)
{
  files::VideoSourceOptions options;
  options.frames_per_second = arguments.fps;
  options.last_frame = arguments.to;
  options.now = monotonicSeconds;
  options.patience = arguments.timeout;
  return options;
}

// A large folder is checked for long, a camera may answer late: neither is deaf to Ctrl-C.
std::unique_ptr<files::VideoSource> openSource(const TrackArguments& arguments, Interruption& interruption)
{
  files::VideoSourceOptions options = sourceOptions(arguments);
  std::optional<Progress> progress;
  options.checking = [&](std::int64_t checked, std::int64_t all) {
    if (!progress) progress.emplace("checking " + arguments.input, all, verbosity(arguments));
    progress->show(checked);
    return !interruption.requested();
  };
  options.stopped = [&interruption] { return interruption.requested(); };
  std::optional<Interruption::Suspension> abrupt;
  if (arguments.input.rfind("camera:", 0) == 0) abrupt.emplace(interruption);
  return files::openVideoSource(arguments.input, options);
}

bool isMapCutOff(const baselines::Method& method)
{
  return method.eyeSlam() != nullptr && method.eyeSlam()->isMapCutOff();
}

// How many frames the progress bar waits for.
std::optional<std::int64_t> expectedFrames(const files::VideoSource& source, const TrackArguments& arguments)
{
  std::optional<std::int64_t> count = source.announcedFrames();
  if (arguments.to >= 0) count = std::min(count.value_or(arguments.to + 1), arguments.to + 1);
  if (count) count = *count - arguments.from;
  return count;
}

void checkThatInputIsKept(const std::vector<std::string>& inputs, const std::string& out)
{
  for (const std::string& input : inputs) {
    for (const std::string& name : kOwnedNames) {
      std::error_code none;
      if (!std::filesystem::equivalent(input, std::filesystem::path(out) / name, none)) continue;
      throw UsageError(fmt::format("--out {}: results would replace the input {}; name another", out, input));
    }
  }
}

}  // namespace

TrackRun::TrackRun(const TrackArguments& arguments)
    : arguments_(arguments),
      options_(configurationOf(arguments)),
      source_(openSource(arguments, interruption_)),
      pixel_size_(files::pixelSizeOf(arguments.input, arguments.um_per_px)),
      method_(baselines::makeMethod(arguments.method, options_.tracker)),
      folder_(arguments.out, kOwnedNames),
      trajectory_(folder_.staged("trajectory.csv"), folder_.final("trajectory.csv")),
      snapshots_(arguments.snapshots.begin(), arguments.snapshots.end())
{
  checkThatInputIsKept(source_->paths(), arguments.out);
  addObservers();
}

void TrackRun::addObservers()
{
  const double rate = source_->framesPerSecond();
  if (arguments_.lcm) addMessages(rate);
  if (!arguments_.record.empty()) observers_.push_back(std::make_unique<Recorder>(arguments_.record, rate));
  if (!arguments_.truth.empty()) observers_.push_back(std::make_unique<TruthReport>(arguments_.truth, folder_));
  if (arguments_.display) observers_.push_back(std::make_unique<TrackWindow>());
  if (!arguments_.no_overlay) addOverlay(rate);
}

void TrackRun::addMessages(double frames_per_second)
{
  try {
    observers_.push_back(std::make_unique<MessagePublisher>(
        *arguments_.lcm, arguments_.key, pixel_size_.um_per_px.value_or(0.0), frames_per_second,
        configuration::yamlOf(options_), configuration::hashOf(options_)));
  } catch (const std::runtime_error& error) {
    throw UsageError(error.what());  // URL or key
  }
  if (!arguments_.quiet && arguments_.key.empty()) {
    fmt::print(stderr, "eyeslam-track: no --key FILE: messages are unsigned and stay on this computer\n");
  }
}

void TrackRun::addOverlay(double frames_per_second)
{
  const char* const kName = "overlay.mp4";
  observers_.push_back(std::make_unique<OverlayWriter>(folder_.staged(kName), folder_.final(kName), frames_per_second,
                                                       options_.overlay));
}

void TrackRun::run()
{
  const double start = monotonicSeconds();
  sayNotices();
  trackFrames();
  if (interrupted_) sayInterrupted();
  if (summary_.frames() == 0) {
    throw files::FileError(
        fmt::format("{}: has no frame {}; --from must be before its end", arguments_.input, arguments_.from));
  }
  finishMaps();
  trajectory_.close();
  for (const auto& observer : observers_) observer->finish();
  writeRecord(monotonicSeconds() - start);
  publish();
  sayNotices();
  sayFramesLeftOut();
  saySnapshotsMissed();
  sayMapCutOff();
  sayDone();
}

void TrackRun::trackFrames()
{
  Progress progress(arguments_.input, expectedFrames(*source_, arguments_), verbosity(arguments_));
  files::VideoFrame frame;
  source_->skipTo(arguments_.from);
  while (!(interrupted_ = interruption_.requested()) && source_->read(frame)) {
    trackFrame(frame);
    progress.show(summary_.frames());
  }
}

// What somebody waits for goes out before anything is drawn, encoded or written.
void TrackRun::trackFrame(const files::VideoFrame& frame)
{
  for (const auto& observer : observers_) observer->onRead(frame);
  const double start = threadCpuMilliseconds();
  const tracking::TrackResult& result = localize(frame);
  const double localized = threadCpuMilliseconds();
  for (const auto& observer : observers_) observer->onTracked(frame, result, *method_);
  const double told = threadCpuMilliseconds();
  if (result.reason != retina::Reason::frozen) method_->updateMap();
  keep({frame.number, frame.t, result, localized - start, threadCpuMilliseconds() - told}, frame);
}

const tracking::TrackResult& TrackRun::localize(const files::VideoFrame& frame)
{
  return source_->isLive() ? live_.track(*method_, frame.image) : method_->track(frame.image);
}

void TrackRun::keep(const files::TrajectoryRow& row, const files::VideoFrame& frame)
{
  summary_.add(row);
  last_frame_ = frame.number;
  try {
    trajectory_.add(row);
    for (const auto& observer : observers_) observer->onFrame(frame, row.result, *method_);
    if (snapshots_.count(frame.number) > 0) files::writeMap(folder_, method_->vesselMap(), frame.number, pixel_size_);
    if (summary_.frames() % kSpaceCheckPeriod == 0) folder_.checkSpace();
  } catch (const files::FileError&) {
    for (const auto& observer : observers_) observer->onFailure(frame, row.result, *method_);
    throw;
  }
}

// The last frame's map is the finished one, also where a snapshot of that frame was asked for.
void TrackRun::finishMaps()
{
  method_->finishMap();
  files::writeMap(folder_, method_->vesselMap(), last_frame_, pixel_size_);
  folder_.write("vessels.csv", files::vesselsCsv(method_->vesselMap()));
  const baselines::Mosaic mosaic = method_->mosaic();
  if (method_->eyeSlam() == nullptr && mosaic.picture.empty()) return;  // a method without one
  files::writeMosaic(folder_, mosaic.picture, {mosaic.origin.x, mosaic.origin.y, mosaic.px_per_pixel}, pixel_size_);
}

void TrackRun::writeRecord(double wall_s) const
{
  TrackConfiguration options = options_;
  const auto fields = configuration::fieldsOf(options);
  const auto paths = source_->paths();
  nlohmann::ordered_json record;
  record["program"] = "eyeslam-track";
  record["version"] = kVersion;
  record["input"] = {{"name", arguments_.input}, {"files", paths.size()}, {"sha256", nullptr}};
  if (!paths.empty()) record["input"]["sha256"] = files::sha256OfFiles(paths);
  record["method"] = arguments_.method;
  record["configuration"] = configuration::jsonOf(fields);
  record["configuration_sha256"] = configuration::hashOf(fields);
  record["um_per_px"] = nullptr;
  if (pixel_size_.um_per_px) record["um_per_px"] = *pixel_size_.um_per_px;
  record["um_per_px_source"] = pixel_size_.source;
  record["first_frame"] = arguments_.from;
  record["last_frame"] = last_frame_;
  record["interrupted"] = interrupted_;
  record["counts"] = summary_.counts();
  if (source_->isLive()) record["frames_left_out"] = source_->framesLeftOut();
  record["map_cut_off"] = isMapCutOff(*method_);
  record["notices"] = source_->notices();
  record["timing"] = summary_.timing(wall_s);
  folder_.write("run.json", record.dump(2) + "\n");
}

void TrackRun::publish()
{
  folder_.publish();
  for (const auto& observer : observers_) observer->publish();
}

void TrackRun::sayNotices()
{
  const auto& notices = source_->notices();
  for (; notices_said_ < notices.size(); ++notices_said_) {
    if (!arguments_.quiet) fmt::print(stderr, "eyeslam-track: {}\n", notices[notices_said_]);
  }
}

void TrackRun::sayFramesLeftOut() const
{
  if (arguments_.quiet || source_->framesLeftOut() == 0) return;
  fmt::print(stderr, "eyeslam-track: {} frames left out, for newer ones had come before they could be tracked\n",
             source_->framesLeftOut());
}

void TrackRun::sayInterrupted() const
{
  if (summary_.frames() == 0)
    throw files::FileError(arguments_.input + ": interrupted before the first frame; nothing written");
  fmt::print(stderr, "eyeslam-track: interrupted after frame {}; what was done is kept in {}\n", last_frame_,
             arguments_.out);
}

void TrackRun::saySnapshotsMissed() const
{
  for (const std::int64_t frame : snapshots_) {
    const bool tracked = frame >= arguments_.from && frame <= last_frame_;
    if (tracked || arguments_.quiet) continue;
    fmt::print(stderr, "eyeslam-track: --snapshots {}: not kept, the frames tracked are {} to {}\n", frame,
               arguments_.from, last_frame_);
  }
}

void TrackRun::sayMapCutOff() const
{
  if (arguments_.quiet || !isMapCutOff(*method_)) return;
  const retina::VesselMap& map = method_->vesselMap();
  fmt::print(stderr, "eyeslam-track: the vessel map ends at {} x {} cells; the retina seen beyond is not in it\n",
             map.width, map.height);
}

void TrackRun::sayDone() const
{
  if (arguments_.quiet) return;
  fmt::print("{}: {} frames, {} tracked, {:.2f} ms CPU a frame (median); results in {}\n", arguments_.input,
             summary_.frames(), summary_.tracked(), summary_.medianCpuMs(), arguments_.out);
}

}  // namespace eyeslam::apps
