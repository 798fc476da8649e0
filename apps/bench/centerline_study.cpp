// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/centerline_study.h"

#include <fmt/format.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "bench/data_name.h"
#include "command_line/program.h"
#include "command_line/progress.h"
#include "eyeslam/files/file_error.h"
#include "eyeslam/files/map_reader.h"
#include "eyeslam/files/test_sequence.h"
#include "eyeslam/fixtures/vessel_graph.h"

namespace eyeslam::apps {
namespace {

constexpr double kMaskTolerance_px = 2.0;
constexpr double kMapTolerance_px = 4.0;

std::vector<fixtures::Vessel> vesselsOf(const retina::VesselMap& map)
{
  fixtures::VesselGraph graph;
  graph.update(map);
  return graph.vessels();
}

}  // namespace

files::CenterlineScore scoreMask(const std::string& mask)
{
  const cv::Mat picture = cv::imread(mask, cv::IMREAD_GRAYSCALE);
  if (picture.empty()) throw files::FileError(mask + ": is no picture");
  retina::VesselMap map;
  map.width = picture.cols;
  map.height = picture.rows;
  map.probability.assign(picture.datastart, picture.dataend);
  return files::scoreCenterlines(vesselsOf(map), {picture, {0.0, 0.0, 1.0}, {}}, kMaskTolerance_px);
}

files::CenterlineScore scoreRun(const std::string& sequence, const std::string& run)
{
  const files::Truth truth = files::readTestSequence(sequence).truth;
  const retina::VesselMap map = files::readMap(run).map;
  files::KnownVessels known{truth.vessels, {truth.vessels_origin.x, truth.vessels_origin.y, 1.0}, {}};
  cv::Mat_<std::uint8_t> cells(map.height, map.width);
  for (std::size_t i = 0; i < map.probability.size(); ++i) cells.data[i] = map.probability[i] >= 128 ? 255 : 0;
  const cv::Matx23d picture_T_map(map.px_per_cell, 0.0, map.origin_x - truth.vessels_origin.x,  //
                                  0.0, map.px_per_cell, map.origin_y - truth.vessels_origin.y);
  cv::warpAffine(cells, known.covered, picture_T_map, truth.vessels.size(), cv::INTER_NEAREST);
  return files::scoreCenterlines(vesselsOf(map), known, kMapTolerance_px);
}

void printCenterlines(const CenterlineInputs& inputs)
{
  fmt::print("| vessels | recall | precision | radius error, median px | centrelines px |\n");
  fmt::print("| --- | --- | --- | --- | --- |\n");
  files::CenterlineScore mean;
  const auto share = 1.0 / static_cast<double>(inputs.known.size());
  const auto print = [](const std::string& name, const files::CenterlineScore& score) {
    fmt::print("| {} | {:.1f} % | {:.1f} % | {:.2f} | {:.0f} |\n", name, 100.0 * score.recall, 100.0 * score.precision,
               score.radius_error_px, score.centerlines_px);
  };
  for (std::size_t i = 0; i < inputs.known.size(); ++i) {
    const std::string& known = inputs.known[i];
    const std::string name = nameOf(known);
    Progress progress(name, std::nullopt, inputs.quiet ? Verbosity::quiet : Verbosity::normal);
    const bool mask = std::filesystem::is_regular_file(known);
    if (!mask && inputs.tracks.empty()) throw UsageError("centerlines: a sequence needs --tracks, its results' folder");
    const files::CenterlineScore score = mask ? scoreMask(known) : scoreRun(known, inputs.tracks + "/" + name);
    print(name, score);
    mean.recall += share * score.recall;
    mean.precision += share * score.precision;
    mean.radius_error_px += share * score.radius_error_px;
    mean.centerlines_px += share * score.centerlines_px;
  }
  print("mean", mean);
}

}  // namespace eyeslam::apps
