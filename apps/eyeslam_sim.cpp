// SPDX-License-Identifier: GPL-3.0-or-later
// eyeslam-sim: renders microscope video with exact truth (contracts, section 5).
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>

#include "eyeslam/files/encoded_video.h"
#include "eyeslam/files/file_error.h"
#include "eyeslam/files/test_sequence.h"
#include "eyeslam/files/video_file.h"
#include "eyeslam/simulation/fundus_photograph.h"
#include "eyeslam/simulation/procedural_fundus.h"
#include "eyeslam/simulation/sequence_renderer.h"

namespace {

namespace files = eyeslam::files;
namespace simulation = eyeslam::simulation;

constexpr double kRadToDeg = 57.29577951308232;
constexpr int kCrf = 18;  // of the sequences with truth

struct Arguments {
  std::string out, condition = "human", motion, retina = "procedural", vessels, size;
  double um_per_px = 4.0;
  int frames = 300;
  std::uint64_t seed = 1;
  bool lossless = false;
};

simulation::Fundus fundusOf(const Arguments& arguments, double um_per_px)
{
  if (arguments.retina == "procedural") {
    simulation::ProceduralFundusOptions procedural;
    procedural.um_per_px = um_per_px;
    return simulation::proceduralFundus(procedural, arguments.seed);
  }
  const cv::Mat picture = cv::imread(arguments.retina, cv::IMREAD_COLOR);
  if (picture.empty()) throw files::FileError(arguments.retina + ": not a picture that can be read");
  cv::Mat mask;
  if (!arguments.vessels.empty()) {
    mask = cv::imread(arguments.vessels, cv::IMREAD_GRAYSCALE);
    if (mask.empty()) throw files::FileError(arguments.vessels + ": not a picture that can be read");
  }
  simulation::FundusPhotographOptions options;
  options.um_per_px = arguments.um_per_px;
  return simulation::fundusFromPhotograph(picture, mask, options);
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

files::TestSequence headOf(const simulation::SequenceRenderer& renderer, const simulation::SequenceOptions& options,
                           const std::string& condition)
{
  files::TestSequence sequence;
  sequence.truth.size = options.size;
  sequence.truth.fps = options.fps;
  sequence.truth.um_per_px = renderer.umPerPx();
  if (const auto rim = renderer.rim()) sequence.truth.rim = files::Rim{rim->x, rim->y, rim->radius};
  renderer.vessels().convertTo(sequence.truth.vessels, CV_8U);
  sequence.truth.vessels_origin = renderer.vesselsOrigin();
  sequence.condition = condition;
  sequence.seed = options.seed;
  sequence.zoom = renderer.zoom();
  return sequence;
}

void render(const Arguments& arguments)
{
  simulation::Condition condition = simulation::condition(arguments.condition);
  if (!arguments.motion.empty()) condition.motion = simulation::eyeMotionOptions(arguments.motion);
  simulation::SequenceOptions options;
  options.size = {condition.width, condition.height};
  if (!arguments.size.empty() &&
      std::sscanf(arguments.size.c_str(), "%dx%d", &options.size.width, &options.size.height) != 2) {
    throw std::invalid_argument("--size " + arguments.size + ": WIDTHxHEIGHT is wanted, like 800x608");
  }
  options.frames = arguments.frames;
  options.seed = arguments.seed;
  simulation::SequenceRenderer renderer(fundusOf(arguments, simulation::umPerPixel(condition.tissue, options)),
                                        condition, options);
  files::OutputFolder folder(arguments.out,
                             {"video.mp4", "video.mkv", "truth.csv", "tool.csv", "vessels.png", "meta.json"});
  const std::string video_name = arguments.lossless ? "video.mkv" : "video.mp4";
  const auto rendered = [&](auto&& video) {
    files::TestSequence sequence = headOf(renderer, options, condition.name);
    while (const auto frame = renderer.next()) {
      video.add(frame->image);
      append(*frame, sequence);
    }
    video.close();
    return sequence;
  };
  const std::string staged = folder.staged(video_name);
  const std::string shown = folder.final(video_name);
  const files::TestSequence sequence =
      arguments.lossless ? rendered(files::VideoFile(staged, shown, files::VideoCoding::lossless, options.fps))
                         : rendered(files::EncodedVideo(staged, shown, options.size, options.fps, kCrf));
  files::writeTestSequence(sequence, folder);
  folder.publish();
}

}  // namespace

int main(int argc, char** argv)
{
  CLI::App app("Renders a video of the retina through a surgical microscope, with its exact truth.", "eyeslam-sim");
  Arguments arguments;
  app.add_option("--out", arguments.out)->required();
  app.add_option("--condition", arguments.condition);
  app.add_option("--motion", arguments.motion);
  app.add_option("--retina", arguments.retina);
  app.add_option("--vessels", arguments.vessels);
  app.add_option("--retina-um-per-px", arguments.um_per_px);
  app.add_option("--frames", arguments.frames);
  app.add_option("--size", arguments.size);
  app.add_option("--seed", arguments.seed);
  app.add_flag("--lossless", arguments.lossless);
  CLI11_PARSE(app, argc, argv);
  try {
    render(arguments);
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "eyeslam-sim: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "eyeslam-sim: %s\n", error.what());
    return 1;
  }
  return 0;
}
