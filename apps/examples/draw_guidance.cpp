// SPDX-License-Identifier: GPL-3.0-or-later
// draw_guidance DIR: what guidance makes of a map that eyeslam-track wrote, as a figure.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "command_line/program.h"
#include "eyeslam/files/file_error.h"
#include "eyeslam/files/graph_file.h"
#include "eyeslam/files/guidance_drawing.h"
#include "eyeslam/files/map_reader.h"
#include "eyeslam/files/partial_file.h"
#include "eyeslam/files/whole_file.h"
#include "eyeslam/fixtures/vessel_graph.h"
#include "eyeslam/fixtures/vessel_walk.h"
#include "eyeslam/retina/map_hash.h"
#include "guidance/fixture_field.h"
#include "guidance/guided_tracing.h"
#include "guidance/tracing_score.h"

namespace {

using namespace eyeslam;
using namespace eyeslam::apps;

const std::string kExamples =
    "draw_guidance out/mine --out guidance.svg --graph graph.json\n"
    "draw_guidance out/mine --out guidance.png --aid hard --motion jerky --um-per-px 5.2";
const cv::Scalar kUnaided(90, 230, 255);
const cv::Scalar kAided(255, 230, 90);
constexpr double kLongest_um = 3000.0;
constexpr double kSettled_s = 1.0;
constexpr double kHeight = 0.5e-3;  // of the tip over the retina, m
constexpr int kArrows = 27;         // across the close-up

struct Arguments {
  std::string folder, out, graph;
  std::string motion = "in_situ", aid = "soft", follow = "way";
  double lambda = 0.1;
  double um_per_px = 0.0;
  double least_um = 60.0;
  std::uint64_t seed = 1;
};

double scaleOf(const Arguments& arguments, const files::RecordedMap& recorded)
{
  const double scale = arguments.um_per_px > 0.0 ? arguments.um_per_px : recorded.map.um_per_px;
  if (scale > 0.0) return scale;
  throw files::FileError(recorded.path + ": does not say how large a pixel is; give --um-per-px");
}

bool meetsAny(const fixtures::Junction& junction, const std::vector<fixtures::Vessel>& vessels)
{
  return std::any_of(vessels.begin(), vessels.end(), [&](const fixtures::Vessel& vessel) {
    return vessel.ends[0] == junction.id || vessel.ends[1] == junction.id;
  });
}

// Vessels too narrow to be followed are left out, and junctions where no other remains.
fixtures::VesselNetwork wideEnough(const fixtures::VesselNetwork& network, double least_px)
{
  fixtures::VesselNetwork wide;
  for (const fixtures::Vessel& vessel : network.vessels) {
    double calibre = 0.0;
    for (const auto& point : vessel.points) {
      calibre += 2.0 * point.radius_px / static_cast<double>(vessel.points.size());
    }
    if (calibre >= least_px) wide.vessels.push_back(vessel);
  }
  for (const fixtures::Junction& junction : network.junctions) {
    if (meetsAny(junction, wide.vessels)) wide.junctions.push_back(junction);
  }
  return wide;
}

cv::Mat pictureOf(const retina::VesselMap& map)
{
  cv::Mat grey(map.height, map.width, CV_8U);
  std::copy(map.probability.begin(), map.probability.end(), grey.begin<std::uint8_t>());
  cv::Mat picture;
  cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
  return picture;
}

void showRetina(const std::string& folder, const retina::VesselMap& map, files::GuidanceFigure& figure)
{
  figure.retina = pictureOf(map);
  figure.geometry = {map.origin_x, map.origin_y, map.px_per_cell};
  if (const auto mosaic = files::readMosaic(folder)) {
    figure.retina = mosaic->picture;
    figure.geometry = mosaic->geometry;
  }
}

std::vector<Eigen::Vector2d> wayToTrace(const retina::VesselMap& map, double um_per_px,
                                        const fixtures::VesselNetwork& network)
{
  const Eigen::Vector2d size(map.width * map.px_per_cell, map.height * map.px_per_cell);
  const Eigen::Vector2d middle = Eigen::Vector2d(map.origin_x, map.origin_y) + size / 2.0;
  return fixtures::longestWay(network, middle, size.norm() / 2.0, kLongest_um / um_per_px);
}

// The square around a way, with a margin for what the hand does beside it.
void closeUp(const std::vector<Eigen::Vector2d>& way, double um_per_px, files::GuidanceFigure& figure)
{
  constexpr double kMargin_um = 450.0;
  Eigen::Vector2d low = way.front();
  Eigen::Vector2d high = way.front();
  for (const Eigen::Vector2d& point : way) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  figure.window_middle_px = (low + high) / 2.0;
  figure.window_px = (high - low).maxCoeff() + 2.0 * kMargin_um / um_per_px;
}

// One way along the path, after the hand has settled; errors are from what the surgeon means to trace, not from
// whatever vessel is next to it.
files::DrawnTrace traced(GuidedTracing tracing, const std::string& who, double um_per_px)
{
  const fixtures::CenterlineIndex meant({vesselThrough(tracing.path().points(), um_per_px)}, um_per_px);
  files::DrawnTrace trace;
  double square = 0.0;
  const double seconds = tracing.path().length() / 0.4e-3;
  for (int i = 0; i < static_cast<int>(seconds * 1000.0); ++i) {
    const TracingStep& step = tracing.step();
    if (step.t_s < kSettled_s) continue;
    const Eigen::Vector2d tip = step.tip_retina.head<2>();
    trace.points_px.push_back(tip / (um_per_px * 1e-6));
    constexpr double kFar = 2e-3;
    const auto near = meant.nearest(tip, kFar);
    square += near ? near->distance * near->distance : kFar * kFar;
  }
  const double rms = std::sqrt(square / static_cast<double>(std::max<std::size_t>(1, trace.points_px.size())));
  trace.caption = fmt::format("{}: {:.0f} um RMS off the path", who, rms * 1e6);
  return trace;
}

files::GuidanceFigure figureOf(const Arguments& arguments)
{
  const files::RecordedMap recorded = files::readMap(arguments.folder);
  files::GuidanceFigure figure;
  figure.um_per_px = scaleOf(arguments, recorded);
  fixtures::VesselGraph graph;
  graph.update(recorded.map);
  figure.network = wideEnough(graph.network(), arguments.least_um / figure.um_per_px);
  if (!arguments.graph.empty()) {
    const retina::VesselMap& map = recorded.map;
    files::writeGraph({retina::hashOf(map), {map.origin_x, map.origin_y, map.px_per_cell}, graph.network()},
                      arguments.graph);
  }
  showRetina(arguments.folder, recorded.map, figure);
  const auto way = wayToTrace(recorded.map, figure.um_per_px, figure.network);
  if (way.size() < 2) throw files::FileError(recorded.path + ": shows no vessel to follow; a lower --least-um may do");
  closeUp(way, figure.um_per_px, figure);

  fixtures::CurveFixtureOptions curve;
  if (arguments.aid == "soft") curve.compliance.lambda = arguments.lambda;
  const auto index = std::make_shared<const fixtures::CenterlineIndex>(figure.network.vessels, figure.um_per_px);
  figure.field = fixtureField(*index, figure.um_per_px, curve, figure.window_middle_px, figure.window_px,
                              figure.window_px / kArrows);
  figure.field_caption = arguments.aid + " fixture: from the hand to its goal";
  const auto path = ontoRetina(way, figure.um_per_px, kHeight);
  const auto chosen = std::make_shared<const fixtures::CenterlineIndex>(
      std::vector<fixtures::Vessel>{vesselThrough(path, figure.um_per_px)}, figure.um_per_px);
  const Eigen::Vector2d middle = figure.window_middle_px * figure.um_per_px * 1e-6;
  for (const Aid aid : {Aid::none, arguments.aid == "soft" ? Aid::soft : Aid::hard}) {
    const GuidedTracingOptions options{arguments.motion, arguments.seed, aid, arguments.lambda};
    const std::string who = aid == Aid::none ? "unaided" : arguments.aid + " fixture";
    figure.traces.push_back(
        traced({options, arguments.follow == "way" ? chosen : index, path, {middle.x(), middle.y(), 0.0}}, who,
               figure.um_per_px));
    figure.traces.back().colour = aid == Aid::none ? kUnaided : kAided;
  }
  return figure;
}

void draw(const Arguments& arguments)
{
  const bool vector = arguments.out.size() > 4 && arguments.out.substr(arguments.out.size() - 4) == ".svg";
  if (!vector && (arguments.out.size() <= 4 || arguments.out.substr(arguments.out.size() - 4) != ".png")) {
    throw UsageError("--out " + arguments.out + ": a name that ends in .svg or .png is wanted");
  }
  const files::VectorPicture picture = files::drawGuidance(figureOf(arguments));
  files::PartialFile file(arguments.out);
  if (vector) {
    files::writeWholeFile(file.partialPath(), picture.svg());
  } else {
    std::vector<std::uint8_t> png;
    cv::imencode(".png", picture.pixels(), png);
    files::writeWholeFile(file.partialPath(), png.data(), png.size());
  }
  file.publish();
}

std::function<void()> setUp(CLI::App& app, Arguments& arguments)
{
  addStandardOptions(app, kExamples);
  app.add_option("DIR", arguments.folder, "what eyeslam-track wrote")->required()->check(CLI::ExistingDirectory);
  app.add_option("--out", arguments.out, "the figure: FILE.svg or FILE.png")->required();
  app.add_option("--graph", arguments.graph, "also write the whole graph, as graph.json");
  app.add_option("--aid", arguments.aid, "which fixture: soft or hard")->check(CLI::IsMember({"soft", "hard"}));
  app.add_option("--follow", arguments.follow,
                 "what the fixture of the traces follows: the way alone, as a surgeon chose it, or the whole network")
      ->check(CLI::IsMember({"way", "network"}));
  app.add_option("--lambda", arguments.lambda, "share of the hand's distance that a soft fixture leaves")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--motion", arguments.motion, "how the retina moves: paper, in_situ, jerky, saccade")
      ->check(CLI::IsMember(simulation::retinaMotionNames()));
  app.add_option("--seed", arguments.seed, "of hand and retina");
  app.add_option("--um-per-px", arguments.um_per_px, "width of a map pixel, um, where the map does not say it")
      ->check(CLI::Range(0.1, 1000.0));
  app.add_option("--least-um", arguments.least_um, "vessels narrower than this are not followed")
      ->check(CLI::Range(0.0, 1000.0));
  return [&arguments] { draw(arguments); };
}

}  // namespace

int main(int argc, char** argv)
{
  Arguments arguments;
  return runProgram("draw_guidance", "Draws a map's vessel graph, a fixture's field, and a simulated hand with it.",
                    argc, argv, [&arguments](CLI::App& app) { return setUp(app, arguments); });
}
