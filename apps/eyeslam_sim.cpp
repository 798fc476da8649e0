// SPDX-License-Identifier: GPL-3.0-or-later
// eyeslam-sim: renders microscope video with exact truth (contracts, section 5).
#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string>

#include <opencv2/imgcodecs.hpp>
#include "command_line/interruption.h"
#include "command_line/program.h"
#include "command_line/progress.h"
#include "eyeslam/files/encoded_video.h"
#include "eyeslam/files/file_error.h"
#include "eyeslam/files/test_sequence.h"
#include "eyeslam/files/video_file.h"
#include "eyeslam/simulation/fundus_photograph.h"
#include "eyeslam/simulation/procedural_fundus.h"
#include "eyeslam/simulation/sequence_renderer.h"

namespace {

using namespace eyeslam;
using apps::UsageError;

constexpr double kRadToDeg = 57.29577951308232;
constexpr int kCrf = 18;  // of the sequences with truth
constexpr const char* kProcedural = "procedural";
constexpr const char* kExamples =
    "Examples:\n"
    "  eyeslam-sim --out human --condition human\n"
    "  eyeslam-sim --out jumps --condition saccade --frames 600 --seed 7 --size 640x480\n"
    "  eyeslam-sim --out mine --retina fundus.jpg --vessels mask.png --retina-um-per-px 4 --condition laser\n"
    "Writes video.mp4, truth.csv, tool.csv, vessels.png and meta.json; the same call gives the same pictures.";

struct Arguments {
  std::string out;
  std::string condition = "human";
  std::string motion;
  std::string retina = kProcedural;
  std::string vessels;
  std::string size;
  double um_per_px = 4.0;
  int frames = 300;
  std::uint64_t seed = 1;
  bool lossless = false;
  bool quiet = false;
};

void addOptions(CLI::App& app, Arguments& arguments)
{
  app.add_option("--out", arguments.out, "folder of the sequence")->required();
  app.add_option("--condition", arguments.condition,
                 "how it looks: human, paper, porcine, laser, saccade, blackout, plain, deform, excursion, hd")
      ->capture_default_str();
  app.add_option("--motion", arguments.motion,
                 "how the eye moves: smooth, jerky, saccade, in_situ, excursion, scaling (default: the condition's)");
  app.add_option("--retina", arguments.retina, "'procedural', or a photograph of a fundus")->capture_default_str();
  app.add_option("--vessels", arguments.vessels, "mask of the photograph's vessels, for the truth");
  app.add_option("--retina-um-per-px", arguments.um_per_px, "width of the photograph's pixel, um")
      ->check(CLI::Range(0.1, 100.0))
      ->capture_default_str();
  app.add_option("--frames", arguments.frames, "length of the video")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  app.add_option("--size", arguments.size, "WIDTHxHEIGHT of the video, px (default: the condition's, 800x608)");
  app.add_option("--seed", arguments.seed, "everything that is left to chance")->capture_default_str();
  app.add_flag("--lossless", arguments.lossless, "write video.mkv, every bit kept, instead of video.mp4");
  app.add_flag("--quiet", arguments.quiet, "no progress");
  apps::addStandardOptions(app, kExamples);
}

std::optional<int> wholeNumber(const std::string& text)
{
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

cv::Size sizeOf(const Arguments& arguments, const simulation::Condition& condition)
{
  if (arguments.size.empty()) return {condition.width, condition.height};
  const std::size_t cross = arguments.size.find('x');
  const auto width = wholeNumber(arguments.size.substr(0, cross));
  const auto height = cross == std::string::npos ? std::nullopt : wholeNumber(arguments.size.substr(cross + 1));
  if (!width || !height)
    throw UsageError(fmt::format("--size {}: WIDTHxHEIGHT is wanted, like 800x608", arguments.size));
  if (*width < 64 || *height < 48 || *width > 4096 || *height > 4096) {
    throw UsageError(fmt::format("--size {}: 64x48 to 4096x4096 is wanted", arguments.size));
  }
  if (!arguments.lossless && (*width % 2 || *height % 2)) {
    throw UsageError(
        fmt::format("--size {}: H.264 knows even sizes only; take even ones, or --lossless", arguments.size));
  }
  return {*width, *height};
}

simulation::Condition conditionOf(const Arguments& arguments)
try {
  simulation::Condition condition = simulation::condition(arguments.condition);
  if (!arguments.motion.empty()) condition.motion = simulation::eyeMotionOptions(arguments.motion);
  return condition;
} catch (const std::invalid_argument& error) {
  throw UsageError(error.what());
}

cv::Mat picture(const std::string& option, const std::string& path, int mode)
{
  cv::Mat image;
  try {
    image = cv::imread(path, mode);
  } catch (const cv::Exception&) {
    image.release();
  }
  if (image.empty())
    throw files::FileError(
        fmt::format("{} {}: not a picture that can be read; JPEG, PNG or TIFF is wanted", option, path));
  return image;
}

simulation::Fundus fundusOf(const Arguments& arguments, double um_per_px)
{
  if (arguments.retina == kProcedural) {
    if (!arguments.vessels.empty())
      throw UsageError("--vessels: the procedural retina knows its vessels; name a photograph with --retina");
    simulation::ProceduralFundusOptions options;
    options.um_per_px = um_per_px;
    return simulation::proceduralFundus(options, arguments.seed);
  }
  const cv::Mat photograph = picture("--retina", arguments.retina, cv::IMREAD_COLOR);
  const cv::Mat mask =
      arguments.vessels.empty() ? cv::Mat() : picture("--vessels", arguments.vessels, cv::IMREAD_GRAYSCALE);
  simulation::FundusPhotographOptions options;
  options.um_per_px = arguments.um_per_px;
  return simulation::fundusFromPhotograph(photograph, mask, options);
}

void append(const simulation::RenderedFrame& frame, files::TestSequence& sequence)
{
  const auto& pose = frame.map_T_frame;
  sequence.truth.poses.push_back({frame.t_s, pose.x, pose.y, pose.theta * kRadToDeg, pose.scale, frame.visible});
  const auto& tool = frame.tool;
  sequence.truth.tools.push_back(
      {tool.present, tool.tip.x, tool.tip.y, tool.shaft_angle * kRadToDeg, tool.shaft_width});
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
void renderInto(Video video, simulation::SequenceRenderer& renderer, const Arguments& arguments,
                files::TestSequence& sequence)
{
  apps::Progress progress("rendering", arguments.frames,
                          arguments.quiet ? apps::Verbosity::quiet : apps::Verbosity::normal);
  apps::Interruption interruption;
  while (const auto frame = renderer.next()) {
    video.add(frame->image);
    append(*frame, sequence);
    progress.show(frame->frame + 1);
    if (interruption.requested()) break;
  }
  video.close();
}

void render(const Arguments& arguments)
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

void renderOrNameTheRetina(const Arguments& arguments)
{
  try {
    render(arguments);
  } catch (const std::invalid_argument& error) {
    throw files::FileError(fmt::format("--retina {}: {}", arguments.retina, error.what()));
  }
}

}  // namespace

int main(int argc, char** argv)
{
  Arguments arguments;
  return apps::runProgram("eyeslam-sim",
                          "Renders a video of the retina through a surgical microscope, with its exact truth.", argc,
                          argv, [&arguments](CLI::App& app) {
                            addOptions(app, arguments);
                            return [&arguments] { renderOrNameTheRetina(arguments); };
                          });
}
