// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/plan_study.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "bench/data_name.h"
#include "command_line/clocks.h"
#include "eyeslam/files/file_error.h"
#include "eyeslam/files/map_reader.h"
#include "eyeslam/files/map_score.h"
#include "eyeslam/files/test_sequence.h"
#include "eyeslam/files/thinning.h"
#include "eyeslam/fixtures/burn_planner.h"
#include "eyeslam/fixtures/burn_room.h"
#include "eyeslam/fixtures/cell_set.h"

namespace eyeslam::apps {
namespace {

namespace fs = std::filesystem;

constexpr int kThresholds[] = {64, 128, 192};
constexpr double kSpots_um[] = {100.0, 200.0};
constexpr double kMargins_um[] = {50.0, 100.0, 200.0};
constexpr int kDarkest = 30;  // of red: the photographs are black around the retina

/// From a point to the nearest vessel cell's square, by looking at every cell within `reach` cells; cells.
double bruteDistance(const retina::VesselMap& map, double x, double y, int reach, int threshold)
{
  double nearest = HUGE_VAL;
  const int column = static_cast<int>(std::lround(x)), row = static_cast<int>(std::lround(y));
  for (int r = std::max(row - reach, 0); r <= std::min(row + reach, map.height - 1); ++r) {
    for (int c = std::max(column - reach, 0); c <= std::min(column + reach, map.width - 1); ++c) {
      if (map.probability[map.index(c, r)] < threshold) continue;
      const double dx = x < c - 0.5 ? c - 0.5 - x : (x > c + 0.5 ? x - c - 0.5 : 0.0);
      const double dy = y < r - 0.5 ? r - 0.5 - y : (y > r + 0.5 ? y - r - 0.5 : 0.0);
      nearest = std::min(nearest, dx * dx + dy * dy);
    }
  }
  return std::sqrt(nearest);
}

std::vector<int> keptFrames(const std::string& track)
{
  std::set<int> frames;
  for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(track) / "map")) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("map_", 0) == 0 && entry.path().extension() == ".png") frames.insert(std::stoi(name.substr(4)));
  }
  return {frames.begin(), frames.end()};
}

/// The true vessels from a calibre on, grown by the burn: where the centre of a burn touches one.
class TouchedPlaces {
 public:
  TouchedPlaces(const files::Truth& truth, double burn_um) : origin_(truth.vessels_origin)
  {
    const cv::Mat_<std::uint8_t> whole = truth.vessels.clone();
    const std::vector<std::uint8_t> calibre(whole.data, whole.data + whole.total());
    for (const int from : {1, 6, 10}) {
      fixtures::CellSet vessels(whole.cols, whole.rows);
      vessels.addFrom(calibre, from);
      touched_.push_back(vessels.dilatedForCentre(burn_um / 2.0 / truth.um_per_px));
    }
  }

  void count(double x_px, double y_px, BurnRisk& risk) const
  {
    const int column = static_cast<int>(std::lround(x_px - origin_.x));
    const int row = static_cast<int>(std::lround(y_px - origin_.y));
    if (column < 0 || row < 0 || column >= touched_[0].width() || row >= touched_[0].height()) return;
    ++risk.places;
    risk.touching += touched_[0].has(column, row);
    risk.touching_6 += touched_[1].has(column, row);
    risk.touching_10 += touched_[2].has(column, row);
  }

 private:
  cv::Point2d origin_;
  std::vector<fixtures::CellSet> touched_;
};

void countPlaces(const retina::VesselMap& map, const TouchedPlaces& touched, BurnRisk& risk)
{
  fixtures::BurnPrescription prescription;
  prescription.laser.spot_um = risk.spot_um;
  prescription.safety.margin_um = risk.margin_um;
  prescription.safety.vessel_probability = risk.vessel_probability;
  const fixtures::BurnValidity validity(map, prescription);
  const fixtures::BurnRoom room(validity, prescription.burn_um());
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      risk.seen += map.seen[map.index(column, row)] > 0;
      const Eigen::Vector2d place = validity.placeOf({column, row});
      if (room.allows(place)) touched.count(place.x(), place.y(), risk);
    }
  }
}

/// The truth as a map that lacks vessels narrower than `least_px`.
retina::VesselMap mapFrom(const files::Truth& truth, int least_px)
{
  retina::VesselMap map;
  map.width = truth.vessels.cols;
  map.height = truth.vessels.rows;
  map.origin_x = truth.vessels_origin.x;
  map.origin_y = truth.vessels_origin.y;
  map.um_per_px = truth.um_per_px;
  for (const std::uint8_t calibre : truth.vessels) {
    map.probability.push_back(calibre >= least_px ? std::uint8_t{255} : std::uint8_t{0});
  }
  map.seen.assign(map.probability.size(), 255);
  return map;
}

/// Share of the centrelines whose vessel is at least so wide.
double shareOfCentrelines(const files::Truth& truth, int least_px)
{
  const cv::Mat_<std::uint8_t> lines = files::thinned(truth.vessels);
  int all = 0, wide = 0;
  for (int i = 0; i < static_cast<int>(lines.total()); ++i) {
    all += lines(i) != 0;
    wide += lines(i) != 0 && truth.vessels(i) >= least_px;
  }
  return all > 0 ? static_cast<double>(wide) / all : 0.0;
}

}  // namespace

PlanCheck checkPlan(const retina::VesselMap& map, const fixtures::BurnPrescription& prescription)
{
  const double start = threadCpuMilliseconds();
  const fixtures::BurnPlan plan = fixtures::planBurns(map, prescription);
  PlanCheck check;
  check.cpu_ms = threadCpuMilliseconds() - start;
  const double um_per_cell = map.um_per_px * map.px_per_cell;
  for (const fixtures::BurnTarget& target : plan.targets) {
    if (!target.valid()) continue;
    const double wanted_um = target.burn_um / 2.0 + prescription.safety.margin_um + prescription.safety.localization_um;
    const double x = (target.position_px.x() - map.origin_x) / map.px_per_cell;
    const double y = (target.position_px.y() - map.origin_y) / map.px_per_cell;
    const int reach = static_cast<int>(wanted_um / um_per_cell) + 3;
    const double gap_um =
        bruteDistance(map, x, y, reach, prescription.safety.vessel_probability) * um_per_cell - wanted_um;
    check.least_gap_um = check.valid == 0 ? gap_um : std::min(check.least_gap_um, gap_um);
    check.too_near += gap_um <= 0.0;
    ++check.valid;
  }
  return check;
}

retina::VesselMap perfectMap(const std::string& photograph, const std::string& mask, double um_per_px)
{
  const cv::Mat picture = cv::imread(photograph, cv::IMREAD_COLOR), vessels = cv::imread(mask, cv::IMREAD_GRAYSCALE);
  if (picture.empty()) throw files::FileError(photograph + ": is no picture");
  if (vessels.size() != picture.size()) throw files::FileError(mask + ": is no picture of the photograph's size");
  retina::VesselMap map;
  map.width = vessels.cols;
  map.height = vessels.rows;
  map.um_per_px = um_per_px;
  map.probability.assign(vessels.data, vessels.data + vessels.total());
  map.seen.reserve(vessels.total());
  for (const auto& pixel : cv::Mat_<cv::Vec3b>(picture)) {
    map.seen.push_back(pixel[2] > kDarkest ? std::uint8_t{255} : std::uint8_t{0});
  }
  return map;
}

std::vector<BurnRisk> studyRisks(const std::string& sequence, const std::string& track)
{
  const files::Truth truth = files::readTestSequence(sequence).truth;
  std::vector<BurnRisk> risks;
  std::vector<TouchedPlaces> touched;
  for (const double spot_um : kSpots_um) touched.emplace_back(truth, spot_um);
  std::vector<files::MapScorer> scorers;  // each counts what has been seen so far
  for (std::size_t i = 0; i < std::size(kThresholds); ++i) scorers.emplace_back(truth);
  for (const int frame : keptFrames(track)) {
    const retina::VesselMap map = files::readMap(track, frame).map;
    for (std::size_t t = 0; t < std::size(kThresholds); ++t) {
      retina::VesselMap drawn = map;
      for (std::uint8_t& cell : drawn.probability) cell = cell >= kThresholds[t] ? 255 : 0;
      const double coverage = scorers[t].score(frame, drawn).coverage;
      for (std::size_t s = 0; s < std::size(kSpots_um); ++s) {
        for (const double margin_um : kMargins_um) {
          risks.push_back({nameOf(sequence), frame, kThresholds[t], coverage, kSpots_um[s], margin_um});
          countPlaces(map, touched[s], risks.back());
        }
      }
    }
  }
  return risks;
}

std::vector<BurnRisk> studyMissingThinVessels(const std::string& sequence)
{
  const files::Truth truth = files::readTestSequence(sequence).truth;
  std::vector<BurnRisk> risks;
  for (const double spot_um : kSpots_um) {
    const TouchedPlaces touched(truth, spot_um);
    for (int least_px = 1; least_px <= 10; ++least_px) {
      const retina::VesselMap map = mapFrom(truth, least_px);
      const double coverage = shareOfCentrelines(truth, least_px);
      for (const double margin_um : kMargins_um) {
        risks.push_back({nameOf(sequence), least_px, 128, coverage, spot_um, margin_um});
        countPlaces(map, touched, risks.back());
      }
    }
  }
  return risks;
}

}  // namespace eyeslam::apps
