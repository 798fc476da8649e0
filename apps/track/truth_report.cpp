// SPDX-License-Identifier: GPL-3.0-or-later
#include "track/truth_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "eyeslam/retina/units.h"

namespace eyeslam::apps {
namespace {

constexpr double kMapPeriod_s = 0.5;    // as dense as the paper's curve
constexpr std::int64_t kMostMaps = 48;  // each keeps a picture

std::string nameOf(const std::string& folder)
{
  const std::filesystem::path path = std::filesystem::absolute(folder).lexically_normal();
  return path.has_filename() ? path.filename().string() : path.parent_path().filename().string();
}

}  // namespace

TruthReport::TruthReport(const std::string& truth_folder, const files::OutputFolder& out)
    : name_(nameOf(truth_folder)), out_(out), sequence_(files::readTestSequence(truth_folder))
{
  if (!sequence_.truth.vessels.empty()) scorer_ = std::make_unique<files::MapScorer>(sequence_.truth);
}

void TruthReport::onFrame(const files::VideoFrame& frame, const tracking::TrackResult& result,
                          baselines::Method& method)
{
  if (frame.number >= static_cast<std::int64_t>(sequence_.truth.poses.size())) {
    throw files::FileError(
        fmt::format("--truth: its truth.csv has {} frames, the video more", sequence_.truth.poses.size()));
  }
  const retina::Pose2& pose = result.map_T_frame;
  poses_.push_back({result.tracked, pose.x, pose.y, pose.theta * kDegreesPerRadian, 0.0});
  if (frame.number % mapPeriod() == 0) judge(static_cast<int>(frame.number), method.vesselMap());
}

std::int64_t TruthReport::mapPeriod() const
{
  const auto usual = static_cast<std::int64_t>(std::lround(kMapPeriod_s * sequence_.truth.fps));
  return std::max({std::int64_t{1}, usual, static_cast<std::int64_t>(sequence_.truth.poses.size()) / kMostMaps});
}

void TruthReport::judge(int frame, const retina::VesselMap& map)
{
  if (scorer_ == nullptr || map.empty()) return;
  const files::MapScore score = scorer_->score(frame, map);
  maps_.push_back({score, scorer_->verdicts().clone()});
}

// A part of a video is judged against that part.
void TruthReport::finish()
{
  files::Truth truth = sequence_.truth;
  truth.poses.resize(poses_.size());
  out_.writePng("truth_pose.png", files::poseFigure(name_, truth, poses_));
  if (!maps_.empty()) out_.writePng("truth_map.png", files::mapFigure(name_, sequence_.truth, maps_));
}

}  // namespace eyeslam::apps
