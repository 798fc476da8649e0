// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "eyeslam/fixtures/vessel_graph.h"
#include "eyeslam/fixtures/vessel_walk.h"
#include "eyeslam/retina/vessel_map.h"
#include "eyeslam/simulation/procedural_fundus.h"
#include "eyeslam/simulation/random.h"
#include "eyeslam/trials/bootstrap.h"
#include "eyeslam/trials/error_figures.h"
#include "eyeslam/trials/trial_record.h"

namespace eyeslam::support {

/// Records of trials as they might be, without running any: to see and test reports.
class SyntheticTrials {
 public:
  explicit SyntheticTrials(double duration_s = 20.0) : duration_s_(duration_s) {}

  /// @param aid  none, soft or hard
  trials::TrialRecord traced(const std::string& aid, std::uint64_t seed)
  {
    trials::TrialRecord record = begun("vessel_tracing", "trace", aid, seed);
    record.path = pathOf(seed);
    moveTip(record);
    scoreTip(record);
    addTiming(record);
    return record;
  }

  /// @param aid  manual or automated
  trials::TrialRecord burnt(const std::string& aid, std::uint64_t seed)
  {
    trials::TrialRecord record = begun("laser_rings", "laser", aid, seed);
    planRings(record);
    burn(record);
    scoreBurns(record);
    addTiming(record);
    return record;
  }

 private:
  static constexpr double kMetre_um = 1e6;
  static constexpr double kTwoPi = 6.283185307179586;

  // One retina serves two seeds, for they cost a second each.
  static std::uint64_t retinaOf(std::uint64_t seed) { return 1 + seed % 2; }

  const trials::RetinaPicture& pictureOf(std::uint64_t seed)
  {
    auto& kept = pictures_[retinaOf(seed) - 1];
    if (kept.bgr.empty()) kept = drawn(retinaOf(seed));
    return kept;
  }

  static trials::RetinaPicture drawn(std::uint64_t seed)
  {
    simulation::ProceduralFundusOptions options;
    options.um_per_px = 5.0;
    options.width_mm = 7.0;
    options.height_mm = 5.5;
    const simulation::Fundus fundus = simulation::proceduralFundus(options, seed);
    trials::RetinaPicture picture;
    fundus.bgr.convertTo(picture.bgr, CV_8UC3, 255.0);
    cv::Mat vessel;
    cv::compare(fundus.calibre_px, 0.0, vessel, cv::CMP_GT);
    picture.vessel = vessel;
    picture.m_per_px = 5e-6;
    return picture;
  }

  std::vector<Eigen::Vector2d> pathOf(std::uint64_t seed)
  {
    auto& kept = paths_[retinaOf(seed) - 1];
    if (!kept.empty()) return kept;
    const trials::RetinaPicture& picture = pictureOf(seed);
    retina::VesselMap map;
    map.width = picture.vessel.cols;
    map.height = picture.vessel.rows;
    map.um_per_px = 5.0;
    map.version = 1;
    map.probability.assign(picture.vessel.begin(), picture.vessel.end());
    map.seen.assign(map.probability.size(), 255);
    map.calibre_px.assign(map.probability.size(), 12);
    fixtures::VesselGraph graph;
    graph.update(map);
    const Eigen::Vector2d centre(0.5 * map.width, 0.5 * map.height);
    for (const Eigen::Vector2d& place : fixtures::longestWay(graph.network(), centre, 300.0, 500.0))
      kept.emplace_back(picture.m_per_px * place);
    return kept;
  }

  trials::TrialRecord begun(const std::string& scenario, const std::string& task, const std::string& aid,
                            std::uint64_t seed)
  {
    trials::TrialRecord record;
    record.task = task;
    record.variant = "aid=" + aid;
    record.configuration = "task: " + task + "\naid: " + aid +
                           "\nlaser:\n  manual_gain_hz: 2.6\n  manual_within_um: 100\n  manual_delay_ms: 30\n"
                           "hardware:\n  hand:\n    surgeon:\n      gain_hz: 1.8\n      reaction_ms: 200\n"
                           "prescription:\n  safety:\n    margin_um: 100\n";
    record.retina = pictureOf(seed);
    record.score.scenario = scenario;
    record.score.seed = seed;
    record.score.aid = aid;
    record.score.motion = "in_situ";
    record.score.condition = "in_vivo";
    record.score.retina = "procedural";
    record.score.camera_hz = 30.0;
    record.score.latency_ms = 20.0;
    record.score.duration_s = duration_s_;
    record.score.version = "0.1.0";
    record.score.config_hash = "5f2c0a7e";
    record.events.push_back({-4.0, "fixture", "asked", false});
    return record;
  }

  /// Noise of some frequency: a swinging state kicked by chance, of the given RMS.
  struct Swing {
    double hz, damping, x = 0.0, v = 0.0;
    double step(simulation::Random& random)
    {
      const double w = kTwoPi * hz, dt = 1e-3;
      const double kick = std::sqrt(4.0 * damping * w * w * w / dt);
      v += dt * (-w * w * x - 2.0 * damping * w * v + kick * random.normal());
      x += dt * v;
      return x;
    }
  };

  void moveTip(trials::TrialRecord& record) const
  {
    simulation::Random random(record.score.seed, record.score.aid == "none" ? 1U : 2U);
    const double share = record.score.aid == "none" ? 1.0 : record.score.aid == "soft" ? 0.22 : 0.09;
    Swing tremor_x{9.5, 0.15}, tremor_y{9.5, 0.15}, drift_x{0.3, 0.7}, drift_y{0.3, 0.7};
    const double tremor = 1e-6 * random.uniform(55.0, 85.0) * share, drift = 90e-6 * share;
    double jerk = 0.0, jerk_ends = -1.0, place = 0.0, way = 0.4e-6;
    for (int ms = 0; ms < static_cast<int>(1e3 * duration_s_); ++ms) {
      if (random.chance(1e-4)) {
        jerk = 1e-6 * random.uniform(60.0, 160.0);
        jerk_ends = ms + 150.0;
      }
      jerk *= 0.985;
      advance(record.path, place, way);
      const Eigen::Vector2d wanted = record.path[static_cast<std::size_t>(place)];
      const Eigen::Vector2d off(tremor * tremor_x.step(random) + drift * drift_x.step(random) + jerk,
                                tremor * tremor_y.step(random) + drift * drift_y.step(random));
      trials::TipSample sample;
      sample.t_s = 1e-3 * ms;
      sample.tip << wanted + off, -300e-6;
      sample.error = distance(record.path, wanted + off, static_cast<std::size_t>(place));
      sample.calm = ms >= jerk_ends;
      record.tip.push_back(sample);
    }
  }

  static void advance(const std::vector<Eigen::Vector2d>& path, double& place, double& way)
  {
    const auto at = std::min(static_cast<std::size_t>(place), path.size() - 2);
    place += way / std::max(1e-7, (path[at + 1] - path[at]).norm());
    if (place < 0.0 || place > static_cast<double>(path.size() - 1)) way = -way;
    place = std::clamp(place, 0.0, static_cast<double>(path.size() - 1));
  }

  static double distance(const std::vector<Eigen::Vector2d>& path, const Eigen::Vector2d& tip, std::size_t near)
  {
    double nearest = 1.0;
    const std::size_t to = std::min(near + 60, path.size());
    for (std::size_t i = near > 60 ? near - 60 : 0; i < to; ++i) nearest = std::min(nearest, (path[i] - tip).norm());
    return nearest;
  }

  static double mean(const std::vector<double>& values) { return trials::meanOverSeeds(values).mean; }

  static void scoreTip(trials::TrialRecord& record)
  {
    std::vector<double> um;
    double travel = 0.0;
    for (std::size_t i = 0; i < record.tip.size(); ++i) {
      um.push_back(kMetre_um * record.tip[i].error);
      if (i > 0) travel += 1e3 * (record.tip[i].tip - record.tip[i - 1].tip).norm();
    }
    const trials::ErrorFigures figures = trials::errorFigures(um);
    record.score.mean_um = mean(um);
    record.score.rms_um = figures.rms;
    record.score.median_um = figures.median;
    record.score.p95_um = figures.p95;
    record.score.max_um = figures.max;
    record.score.path_coverage = record.score.aid == "none" ? 0.93 : 0.998;
    record.score.tip_travel_mm = travel;
  }

  void planRings(trials::TrialRecord& record) const
  {
    const trials::RetinaPicture& picture = record.retina;
    cv::Mat_<float> clear;
    cv::distanceTransform(255 - picture.vessel, clear, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    const Eigen::Vector2d centre = 0.5 * picture.m_per_px * Eigen::Vector2d(clear.cols, clear.rows);
    int id = 0;
    for (const auto& [radius, count] : {std::pair{0.5e-3, 5}, {1.0e-3, 11}, {1.5e-3, 16}}) {
      for (int i = 0; i < count; ++i) {
        const double angle = kTwoPi * i / count;
        trials::PlannedTarget target{id++, centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)), 100e-6,
                                     "done", ""};
        const Eigen::Vector2d px = target.wanted / picture.m_per_px;
        const double away = picture.m_per_px * static_cast<double>(clear(cvRound(px.y()), cvRound(px.x())));
        if (away < 85e-6) {
          target.fate = "refused";
          target.reason = "near_vessel";
        } else if (id == 21) {
          target.fate = "missed";
          target.reason = "retina_moves";
        }
        record.targets.push_back(target);
      }
    }
  }

  static void burn(trials::TrialRecord& record)
  {
    const bool manual = record.score.aid == "manual";
    simulation::Random random(record.score.seed, manual ? 3U : 4U);
    double t_s = 0.0;
    for (const trials::PlannedTarget& target : record.targets) {
      if (target.fate != "done") continue;
      t_s += manual ? random.uniform(0.7, 2.2) : random.uniform(0.33, 0.4);
      const double spread = 1e-6 * (manual ? 85.0 : 9.5);
      trials::PulseRecord pulse;
      pulse.t_s = t_s;
      pulse.target = target.id;
      pulse.wanted = target.wanted;
      pulse.spot = target.wanted + spread * Eigen::Vector2d(random.normal(), random.normal());
      pulse.placement = (pulse.spot - pulse.wanted).norm();
      pulse.duration = 0.02;
      pulse.clearance = 110e-6 - 0.7 * pulse.placement;
      pulse.touched_calibre = pulse.clearance < 20e-6 ? 18e-6 : 0.0;
      pulse.far = pulse.explained = pulse.placement > 60e-6;
      record.pulses.push_back(pulse);
    }
  }

  static void scoreBurns(trials::TrialRecord& record)
  {
    std::vector<double> um;
    double clearance = 1.0;
    std::int64_t far = 0;
    for (const trials::PulseRecord& pulse : record.pulses) {
      um.push_back(kMetre_um * pulse.placement);
      clearance = std::min(clearance, pulse.clearance);
      far += pulse.far ? 1 : 0;
    }
    const auto fated = [&](const char* fate) {
      return std::count_if(record.targets.begin(), record.targets.end(), [&](const auto& t) { return t.fate == fate; });
    };
    const trials::ErrorFigures figures = trials::errorFigures(um);
    trials::TrialScore& score = record.score;
    score.placement_mean_um = mean(um);
    score.placement_p95_um = figures.p95;
    score.placement_max_um = figures.max;
    score.targets = static_cast<std::int64_t>(record.targets.size());
    score.fired = static_cast<std::int64_t>(um.size());
    score.refused = fated("refused");
    score.missed = fated("missed");
    score.far_pulses = far;
    score.far_unexplained = score.interlock_violations = 0;
    score.burns_per_s = static_cast<double>(um.size()) / (record.pulses.empty() ? 1.0 : record.pulses.back().t_s);
    score.min_vessel_clearance_um = kMetre_um * clearance;
  }

  void addTiming(trials::TrialRecord& record) const
  {
    if (record.score.aid == "none" || record.score.aid == "manual") return;
    simulation::Random random(record.score.seed, 5U);
    std::vector<double> degrees;
    for (int frame = 0; frame < static_cast<int>(30.0 * duration_s_); ++frame) {
      record.pose_errors_px.push_back(0.4 * std::abs(random.normal()));
      record.pose_ages_s.push_back(random.uniform(0.014, 0.020));
      record.frame_to_command_s.push_back(record.pose_ages_s.back() + random.uniform(0.0, 0.001));
    }
    record.score.pose_rms_px = trials::errorFigures(record.pose_errors_px).rms;
    record.score.pose_rms_deg = 0.03;
    record.score.tracked_fraction = 1.0;
    record.score.saturated_fraction = 0.001;
  }

  double duration_s_;
  trials::RetinaPicture pictures_[2];
  std::vector<Eigen::Vector2d> paths_[2];
};

}  // namespace eyeslam::support
