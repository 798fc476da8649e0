// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "eyeslam/files/map_score.h"
#include "eyeslam/files/output_folder.h"
#include "eyeslam/files/score.h"
#include "eyeslam/files/test_sequence.h"
#include "eyeslam/files/truth_figures.h"
#include "track/frame_observer.h"

namespace eyeslam::apps {

/// `--truth DIR`: the paper's Fig. 4 as `truth_pose.png` and its Fig. 6 as `truth_map.png`.
class TruthReport : public FrameObserver {
 public:
  /// @param truth_folder  a sequence as contracts, section 5, has it
  /// @throws FileError when it cannot be read
  TruthReport(const std::string& truth_folder, const files::OutputFolder& out);

  void onFrame(const files::VideoFrame& frame, const tracking::TrackResult& result, baselines::Method& method) override;
  void finish() override;

 private:
  std::int64_t mapPeriod() const;  // frames
  void judge(int frame, const retina::VesselMap& map);

  std::string name_;
  const files::OutputFolder& out_;
  files::TestSequence sequence_;
  std::unique_ptr<files::MapScorer> scorer_;  // none without a vessel picture
  std::vector<files::EstimatedPose> poses_;
  std::vector<files::JudgedMap> maps_;
};

}  // namespace eyeslam::apps
