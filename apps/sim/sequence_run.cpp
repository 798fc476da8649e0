// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/sequence_run.h"

#include <fmt/format.h>

#include "command_line/interruption.h"
#include "command_line/picture_size.h"
#include "command_line/program.h"
#include "command_line/progress.h"
#include "eyeslam/files/encoded_video.h"
#include "eyeslam/files/file_error.h"
#include "eyeslam/files/test_sequence.h"
#include "eyeslam/files/video_file.h"
#include "eyeslam/retina/units.h"
#include "eyeslam/simulation/sequence_renderer.h"

namespace eyeslam::apps {
namespace {

constexpr int kCrf = 18;  // of the sequences with truth

cv::Size sizeOf(const SimArguments& arguments, const simulation::Condition& condition)
{
  if (arguments.size.empty()) return {condition.width, condition.height};
  const PictureSize size = pictureSize("--size", arguments.size);
  if (!arguments.lossless && (size.width % 2 || size.height % 2)) {
    throw UsageError(
        fmt::format("--size {}: H.264 knows even sizes only; take even ones, or --lossless", arguments.size));
  }
  return {size.width, size.height};
}

simulation::Condition conditionOf(const SimArguments& arguments)
try {
  simulation::Condition condition = simulation::condition(arguments.condition);
  if (!arguments.motion.empty()) condition.motion = simulation::eyeMotionOptions(arguments.motion);
  return condition;
} catch (const std::invalid_argument& error) {
  throw UsageError(error.what());
}

void append(const simulation::RenderedFrame& frame, files::TestSequence& sequence)
{
  const auto& pose = frame.map_T_frame;
  sequence.truth.poses.push_back(
      {frame.t_s, pose.x, pose.y, pose.theta * kDegreesPerRadian, pose.scale, frame.visible});
  const auto& tool = frame.tool;
  sequence.truth.tools.push_back(
      {tool.present, tool.tip.x, tool.tip.y, tool.shaft_angle * kDegreesPerRadian, tool.shaft_width});
  sequence.tool_cover.push_back(frame.tool_cover);
  if (frame.fired) sequence.burns.push_back(frame.frame);
}

// Thin vessels stay vessels: 0 means none.
cv::Mat_<std::uint8_t> calibrePicture(const cv::Mat_<float>& calibre_px)
{
  cv::Mat_<std::uint8_t> rounded;
  calibre_px.convertTo(rounded, CV_8U);
  rounded.setTo(1, (rounded == 0) & (calibre_px > 0.0F));
  return rounded;
}

files::TestSequence headOf(const simulation::SequenceRenderer& renderer, const simulation::SequenceOptions& options,
                           const std::string& condition)
{
  files::TestSequence sequence;
  sequence.truth.size = options.size;
  sequence.truth.fps = options.fps;
  sequence.truth.um_per_px = renderer.umPerPx();
  if (const auto rim = renderer.rim()) sequence.truth.rim = files::Rim{rim->x, rim->y, rim->radius};
  sequence.truth.vessels = calibrePicture(renderer.vessels());
  sequence.truth.vessels_origin = renderer.vesselsOrigin();
  sequence.condition = condition;
  sequence.seed = options.seed;
  sequence.zoom = renderer.zoom();
  return sequence;
}

// Until the last frame, or Ctrl-C: what was rendered by then is a whole, shorter sequence.
template <class Video>
void renderInto(Video video, simulation::SequenceRenderer& renderer, const SimArguments& arguments,
                files::TestSequence& sequence)
{
  Progress progress("rendering", arguments.frames, arguments.quiet ? Verbosity::quiet : Verbosity::normal);
  Interruption interruption;
  while (const auto frame = renderer.next()) {
    video.add(frame->image);
    append(*frame, sequence);
    progress.show(frame->frame + 1);
    if (interruption.requested()) break;
  }
  video.close();
}

void render(const SimArguments& arguments)
{
  const simulation::Condition condition = conditionOf(arguments);
  const simulation::SequenceOptions options{sizeOf(arguments, condition), arguments.frames, 30.0, arguments.seed};
  simulation::SequenceRenderer renderer(fundusOf(arguments, simulation::umPerPixel(condition.tissue, options)),
                                        condition, options);
  files::OutputFolder folder(arguments.out,
                             {"video.mp4", "video.mkv", "truth.csv", "tool.csv", "vessels.png", "meta.json"});
  const std::string name = arguments.lossless ? "video.mkv" : "video.mp4";
  files::TestSequence sequence = headOf(renderer, options, condition.name);
  if (arguments.lossless) {
    renderInto(files::VideoFile(folder.staged(name), folder.final(name), files::VideoCoding::lossless, options.fps),
               renderer, arguments, sequence);
  } else {
    renderInto(files::EncodedVideo(folder.staged(name), folder.final(name), options.size, options.fps, kCrf), renderer,
               arguments, sequence);
  }
  files::writeTestSequence(sequence, folder);
  folder.checkSpace();
  folder.publish();
  const auto done = static_cast<int>(sequence.truth.poses.size());
  if (done < arguments.frames)
    fmt::print(stderr, "eyeslam-sim: interrupted; {} holds the first {} frames\n", arguments.out, done);
}

}  // namespace

void renderSequence(const SimArguments& arguments)
try {
  render(arguments);
} catch (const std::invalid_argument& error) {
  throw files::FileError(fmt::format("--retina {}: {}", arguments.retina, error.what()));
}

}  // namespace eyeslam::apps
