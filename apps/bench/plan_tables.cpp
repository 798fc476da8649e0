// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/plan_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "bench/plan_study.h"
#include "command_line/progress.h"
#include "eyeslam/files/file_error.h"
#include "eyeslam/files/map_reader.h"

namespace eyeslam::apps {
namespace {

namespace fs = std::filesystem;

/// Dense plans of different patterns, spots and margins: as many targets as a map has room for.
std::vector<fixtures::BurnPrescription> densePrescriptions()
{
  struct Dense {
    const char* kind;
    double spot_um, spacing_um, margin_um;
  };
  std::vector<fixtures::BurnPrescription> prescriptions;
  for (const auto& [kind, spot_um, spacing_um, margin_um] :
       {Dense{"hexagonal", 50.0, 50.0, 100.0}, Dense{"grid", 50.0, 60.0, 50.0}, Dense{"hexagonal", 40.0, 45.0, 25.0},
        Dense{"hexagonal", 100.0, 100.0, 100.0}, Dense{"grid", 100.0, 120.0, 50.0},
        Dense{"hexagonal", 200.0, 200.0, 100.0}, Dense{"grid", 40.0, 40.0, 25.0},
        Dense{"hexagonal", 45.0, 45.0, 10.0}}) {
    fixtures::BurnPrescription prescription;
    prescription.pattern.kind = kind;
    prescription.pattern.spacing_um = spacing_um;
    prescription.laser.spot_um = spot_um;
    prescription.safety.margin_um = margin_um;
    prescriptions.push_back(prescription);
  }
  return prescriptions;
}

class CheckTable {
 public:
  explicit CheckTable(std::string maps) : maps_(std::move(maps)) {}

  void add(const retina::VesselMap& map)
  {
    ++count_;
    for (const fixtures::BurnPrescription& prescription : densePrescriptions()) {
      const PlanCheck check = checkPlan(map, prescription);
      ++plans_;
      if (check.valid > 0) least_gap_um_ = std::min(least_gap_um_, check.least_gap_um);
      valid_ += check.valid;
      too_near_ += check.too_near;
    }
  }

  void print() const
  {
    if (count_ == 0) return;
    fmt::print("| {} | {} | {} | {} | {} | {:.2g} |\n", maps_, count_, plans_, valid_, too_near_, least_gap_um_);
  }

 private:
  std::string maps_;
  std::size_t count_ = 0, plans_ = 0, valid_ = 0, too_near_ = 0;
  double least_gap_um_ = 1e9;
};

std::string trackOf(const PlanInputs& inputs, const std::string& sequence)
{
  fs::path path = fs::path(sequence).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  return (fs::path(inputs.tracks) / path.filename()).string();
}

std::vector<fs::path> photographsIn(const std::string& folder)
{
  std::vector<fs::path> paths;
  if (folder.empty()) return paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".jpg") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

void printChecks(const PlanInputs& inputs, Progress& progress)
{
  fmt::print("| maps | number | plans | valid targets | nearer than allowed | least distance left, um |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- |\n");
  std::int64_t done = 0;
  CheckTable tracked("made by the tracker"), perfect("manual masks");
  for (const std::string& sequence : inputs.sequences) {
    tracked.add(files::readMap(trackOf(inputs, sequence)).map);
    progress.show(++done);
  }
  for (const fs::path& path : photographsIn(inputs.photographs)) {
    const fs::path mask = path.parent_path() / (path.stem().string() + "_vessels.png");
    perfect.add(perfectMap(path.string(), mask.string(), inputs.um_per_px));
    progress.show(++done);
  }
  tracked.print();
  perfect.print();
}

/// Sums of places in maps of like coverage.
struct RiskSum {
  int maps = 0;
  double places = 0.0, seen = 0.0, touching = 0.0, touching_6 = 0.0, touching_10 = 0.0;

  void add(const BurnRisk& risk)
  {
    ++maps;
    places += static_cast<double>(risk.places);
    seen += static_cast<double>(risk.seen);
    touching += static_cast<double>(risk.touching);
    touching_6 += static_cast<double>(risk.touching_6);
    touching_10 += static_cast<double>(risk.touching_10);
  }
};

const char* coverageClass(double coverage)
{
  if (coverage < 0.6) return "0 to 60 %";
  if (coverage < 0.7) return "60 to 70 %";
  if (coverage < 0.8) return "70 to 80 %";
  if (coverage < 0.9) return "80 to 90 %";
  if (coverage < 0.95) return "90 to 95 %";
  if (coverage < 0.98) return "95 to 98 %";
  if (coverage < 0.99) return "98 to 99 %";
  return "99 to 100 %";
}

using RiskSums = std::map<std::tuple<double, std::string, double>, RiskSum>;  // by spot, coverage, margin

void printSums(const RiskSums& sums)
{
  fmt::print(
      "\n| spot, um | coverage | margin, um | maps | allowed of seen | burns touching a vessel | from 6 px | "
      "from 10 px |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const auto& [key, sum] : sums) {
    const auto& [spot_um, coverage, margin_um] = key;
    const double share = 100.0 / std::max(sum.places, 1.0);
    fmt::print("| {} | {} | {} | {} | {:.1f} % | {:.3f} % | {:.3f} % | {:.3f} % |\n", spot_um, coverage, margin_um,
               sum.maps, 100.0 * sum.places / std::max(sum.seen, 1.0), share * sum.touching, share * sum.touching_6,
               share * sum.touching_10);
  }
}

/// From which coverage on, in these maps, at most one burn in a thousand touches a vessel.
void printSafeCoverage(const RiskSums& sums)
{
  constexpr double kTolerated = 0.001;
  std::map<std::pair<double, double>, std::string> from;  // by spot and margin
  for (const auto& [key, sum] : sums) {
    const auto& [spot_um, coverage, margin_um] = key;
    std::string& least = from[{spot_um, margin_um}];
    const bool tolerable = sum.touching <= kTolerated * sum.places;
    if (!tolerable) least.clear();
    if (tolerable && least.empty()) least = coverage;
  }
  fmt::print(
      "\n| spot, um | margin, um | coverage from which on at most 0.1 % touch a vessel |\n| --- | --- | --- |\n");
  for (const auto& [key, least] : from) {
    fmt::print("| {} | {} | {} |\n", key.first, key.second, least.empty() ? "none of these" : least);
  }
}

template <class Study>
void printRisks(const PlanInputs& inputs, Progress& progress, Study study)
{
  RiskSums sums;
  std::int64_t done = 0;
  for (const std::string& sequence : inputs.sequences) {
    for (const BurnRisk& risk : study(sequence)) {
      sums[{risk.spot_um, coverageClass(risk.coverage), risk.margin_um}].add(risk);
    }
    progress.show(++done);
  }
  printSums(sums);
  printSafeCoverage(sums);
}

}  // namespace

void printPlanTables(const PlanInputs& inputs)
{
  const Verbosity verbosity = inputs.quiet ? Verbosity::quiet : Verbosity::normal;
  Progress checks("maps planned on", std::nullopt, verbosity);
  printChecks(inputs, checks);
  Progress risks("sequences compared with their truth", std::nullopt, verbosity);
  fmt::print("\nMaps made by the tracker:\n");
  printRisks(inputs, risks,
             [&](const std::string& sequence) { return studyRisks(sequence, trackOf(inputs, sequence)); });
  Progress cuts("sequences with thin vessels taken out", std::nullopt, verbosity);
  fmt::print("\nMaps that hold exactly the true vessels from a calibre of 1, 2, ... 10 px on:\n");
  printRisks(inputs, cuts, studyMissingThinVessels);
}

}  // namespace eyeslam::apps
