// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "eyeslam/files/log_event.h"
#include "eyeslam/files/log_writer.h"
#include "eyeslam/files/output_folder.h"
#include "eyeslam/files/video_file.h"
#include "eyeslam/trials/trial_record.h"
#include "eyeslam/trials/trial_scene.h"
#include "eyeslam/trials/trial_world.h"
#include "trial/trial_list.h"

namespace eyeslam::apps {

/// Runs one trial from its first message to the folder that holds log, scores and report.
class TrialJob {
 public:
  using GoesOn = std::function<bool(double)>;

  /// @param trial, arguments  must outlive it
  /// @param folders  of all jobs: the folders above a trial's are made, and removed where empty, by one at a time
  /// @throws files::FileError
  TrialJob(const PlannedTrial& trial, const TrialArguments& arguments, std::mutex& folders);
  ~TrialJob();
  TrialJob(const TrialJob&) = delete;
  TrialJob& operator=(const TrialJob&) = delete;

  /// @param goesOn  is told the simulated time, s, every so often; false ends the trial, and its folder never appears
  /// @throws what keeps it from being run to its end
  std::optional<trials::TrialRecord> run(const std::shared_ptr<const trials::TrialScene>& scene, const GoesOn& goesOn);

 private:
  using Hear = std::function<void(const files::LogEvent&)>;

  // Whether it was run to its end.
  bool runInLockStep(const trials::TrialScene& scene, const trials::TrialName& name, const Hear& hear,
                     const GoesOn& goesOn);
  bool runLive(const trials::TrialScene& scene, const trials::TrialName& name, const Hear& hear, const GoesOn& goesOn);
  void keep(const trials::TrialRecord& record);

  const PlannedTrial& trial_;
  const TrialArguments& arguments_;
  std::mutex& folders_;
  std::optional<files::OutputFolder> folder_;
  std::optional<files::LogWriter> log_;
  std::optional<files::VideoFile> video_;
};

}  // namespace eyeslam::apps
