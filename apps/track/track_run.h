// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <set>
#include <vector>

#include "command_line/interruption.h"
#include "command_line/progress.h"
#include "eyeslam/baselines/method.h"
#include "eyeslam/files/output_folder.h"
#include "eyeslam/files/pixel_size.h"
#include "eyeslam/files/trajectory_file.h"
#include "eyeslam/files/video_source.h"
#include "eyeslam/vision/frozen_picture.h"
#include "track/frame_observer.h"
#include "track/run_summary.h"
#include "track/track_arguments.h"

namespace eyeslam::apps {

/// One run of `eyeslam-track`: from the first frame to results in place. Whatever fails before the end leaves nothing.
class TrackRun {
 public:
  /// Opens input and output. @throws FileError
  explicit TrackRun(const TrackArguments& arguments);

  /// Tracks all frames, or those before Ctrl-C, and writes what contracts, section 3, asks for. @throws FileError
  void run();

 private:
  void addObservers();
  void addMessages(double frames_per_second);
  void addOverlay(double frames_per_second);
  void trackFrames();
  void trackFrame(const files::VideoFrame& frame);
  const tracking::TrackResult& localize(const files::VideoFrame& frame);
  void keep(const files::TrajectoryRow& row, const files::VideoFrame& frame);
  void finishMaps();
  void writeRecord(double wall_s) const;
  void publish();
  void sayNotices();
  void sayFramesLeftOut() const;
  void sayInterrupted() const;
  void saySnapshotsMissed() const;
  void sayMapCutOff() const;
  void sayDone() const;

  const TrackArguments& arguments_;
  const TrackConfiguration options_;
  Interruption interruption_;
  std::unique_ptr<files::VideoSource> source_;
  files::PixelSize pixel_size_;
  std::unique_ptr<baselines::Method> method_;
  vision::FrozenPicture live_;
  files::OutputFolder folder_;
  files::TrajectoryFile trajectory_;
  std::vector<std::unique_ptr<FrameObserver>> observers_;
  std::set<std::int64_t> snapshots_;
  RunSummary summary_;
  std::int64_t last_frame_ = -1;
  bool interrupted_ = false;
  std::size_t notices_said_ = 0;
};

}  // namespace eyeslam::apps
