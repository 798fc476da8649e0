// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan/plan_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <list>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "command_line/program.h"
#include "eyeslam/files/file_error.h"
#include "eyeslam/files/partial_file.h"
#include "eyeslam/files/plan_drawing.h"
#include "eyeslam/files/plan_file.h"
#include "eyeslam/files/whole_file.h"
#include "eyeslam/fixtures/burn_order.h"
#include "plan/plan_report.h"

namespace eyeslam::apps {
namespace {

bool holds(const files::RecordedMosaic& picture, const fixtures::BurnTarget& target)
{
  const files::PictureGeometry& place = picture.geometry;
  const Eigen::Vector2d at = (target.position_px - Eigen::Vector2d(place.origin_x, place.origin_y)) / place.px_per_cell;
  return at.x() >= 0.0 && at.y() >= 0.0 && at.x() < picture.picture.cols && at.y() < picture.picture.rows;
}

files::RecordedMosaic retinaOf(const PlanArguments& arguments)
{
  if (arguments.over != "mosaic") return files::readPlacedPicture(arguments.over);
  std::optional<files::RecordedMosaic> mosaic = files::readMosaic(arguments.folder);
  if (mosaic) return *std::move(mosaic);
  throw files::FileError(fmt::format("--over mosaic: {} has no mosaic.png", arguments.folder));
}

files::PlanBackground backgroundOf(const PlanArguments& arguments, const fixtures::BurnPlan& plan,
                                   const files::RecordedMap& map)
{
  const fixtures::BurnSafetyOptions& safety = plan.prescription.safety;
  if (arguments.over == "map") return files::mapBackground(map.map, safety.vessel_probability, safety.seen_frames);
  const files::RecordedMosaic retina = retinaOf(arguments);
  const bool fits = std::any_of(plan.targets.begin(), plan.targets.end(),
                                [&retina](const fixtures::BurnTarget& target) { return holds(retina, target); });
  if (fits || plan.targets.empty()) return {retina.picture, retina.geometry};
  throw files::FileError(fmt::format("--over {}: no target lies on it; a picture in map px is wanted", arguments.over));
}

// Files that appear together when all of them could be written.
class Results {
 public:
  void add(const std::string& path, const std::string& content)
  {
    files_.emplace_back(path);
    files::writeWholeFile(files_.back().partialPath(), content);
  }
  void publish()
  {
    for (files::PartialFile& file : files_) file.publish();
  }

 private:
  std::list<files::PartialFile> files_;
};

std::string pngOf(const cv::Mat& picture)
{
  std::vector<unsigned char> bytes;
  cv::imencode(".png", picture, bytes);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

files::RecordedMap mapOf(const PlanArguments& arguments)
{
  files::RecordedMap map = files::readMap(arguments.folder, arguments.frame);
  if (arguments.um_per_px) map.map.um_per_px = *arguments.um_per_px;
  return map;
}

void writeResults(const PlanArguments& arguments, const fixtures::BurnPlan& plan, const files::RecordedMap& map)
{
  Results results;
  if (const std::string path = planPath(arguments); !path.empty()) results.add(path, files::planJson(plan));
  if (!arguments.svg.empty() || !arguments.png.empty()) {
    const files::VectorPicture drawing = files::drawPlan(plan, backgroundOf(arguments, plan, map), {arguments.travel});
    if (!arguments.svg.empty()) results.add(arguments.svg, drawing.svg());
    if (!arguments.png.empty()) results.add(arguments.png, pngOf(drawing.pixels()));
  }
  results.publish();
}

void makePlan(const PlanArguments& arguments)
{
  const fixtures::BurnPrescription prescription = prescriptionOf(arguments);
  const files::RecordedMap map = mapOf(arguments);
  if (map.map.um_per_px == 0.0) {
    throw UsageError(fmt::format("um_per_px: unknown in {}, so no um can be planned; give --um-per-px", map.path));
  }
  fixtures::BurnPlan plan = fixtures::orderedPlan(map.map, prescription);
  plan.map.track = map.track;
  writeResults(arguments, plan, map);
  if (arguments.quiet) return;
  fmt::print("{}{}  written    {}\n", warningsOf(plan), summaryOf(plan), planPath(arguments));
}

}  // namespace eyeslam::apps
