// SPDX-License-Identifier: GPL-3.0-or-later
#include "trial/trial_job.h"

#include <cmath>

#include "command_line/clocks.h"
#include "command_line/version.h"
#include "eyeslam/trials/trial.h"
#include "eyeslam/trials/trial_judge.h"
#include "eyeslam/trials/trial_report.h"
#include "trial/real_time_trial.h"

namespace eyeslam::apps {
namespace {

const char* const kLog = "trial.lcm";
const char* const kVideo = "video.mkv";
const char* const kScores = "results.json";
const char* const kReport = "report.html";
constexpr std::int64_t kStepsToAsk = 100;

}  // namespace

TrialJob::TrialJob(const PlannedTrial& trial, const TrialArguments& arguments, std::mutex& folders)
    : trial_(trial), arguments_(arguments), folders_(folders)
{
  const std::lock_guard lock(folders_);
  folder_.emplace(arguments.out + "/" + trial.folder, std::vector<std::string>{kLog, kVideo, kScores, kReport});
}

TrialJob::~TrialJob()
{
  const std::lock_guard lock(folders_);
  log_.reset();
  video_.reset();
  folder_.reset();
}

std::optional<trials::TrialRecord> TrialJob::run(const std::shared_ptr<const trials::TrialScene>& scene,
                                                 const GoesOn& goesOn)
{
  const double start = monotonicSeconds();
  if (!arguments_.no_logs) log_.emplace(folder_->staged(kLog));
  trials::TrialJudge judge(scene);
  const trials::TrialName name{trial_.variant->setting.scenario.name, trial_.variant->name, trial_.seed};
  const auto hear = [&](const files::LogEvent& event) {
    judge.take(event);
    if (log_) log_->append(event.channel, event.data, event.size, event.utime);
  };
  const bool whole =
      arguments_.real_time ? runLive(*scene, name, hear, goesOn) : runInLockStep(*scene, name, hear, goesOn);
  if (!whole) return std::nullopt;
  trials::TrialRecord record = judge.record();
  record.score.wall_s = std::round(1e3 * (monotonicSeconds() - start)) * 1e-3;
  keep(record);
  return record;
}

bool TrialJob::runInLockStep(const trials::TrialScene& scene, const trials::TrialName& name, const Hear& hear,
                             const GoesOn& goesOn)
{
  const trials::TrialSetting& setting = trial_.variant->setting;
  if (arguments_.video)
    video_.emplace(folder_->staged(kVideo), folder_->final(kVideo), files::VideoCoding::lossless,
                   setting.scenario.camera_hz);
  trials::Trial trial(setting, name, kVersion, scene, hear);
  for (std::int64_t steps = 1; trial.step(); ++steps) {
    if (video_ && trial.frame() != nullptr) video_->add(*trial.frame());
    if (steps % kStepsToAsk == 0 && !goesOn(trial.time())) return false;
  }
  return true;
}

bool TrialJob::runLive(const trials::TrialScene& scene, const trials::TrialName& name, const Hear& hear,
                       const GoesOn& goesOn)
{
  const std::string video = arguments_.video ? folder_->staged(kVideo) : "";
  return RealTimeTrial(trial_.variant->setting, name, scene, video, hear).run(goesOn);
}

void TrialJob::keep(const trials::TrialRecord& record)
{
  if (log_) log_->finish();
  if (video_) video_->close();
  folder_->write(kScores, trials::jsonOf(record.score));
  folder_->write(kReport, trials::trialReport(record));
  folder_->publish();
}

}  // namespace eyeslam::apps
