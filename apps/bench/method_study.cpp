// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/method_study.h"

#include <cmath>

#include "command_line/clocks.h"
#include "eyeslam/baselines/method.h"
#include "eyeslam/files/test_sequence.h"
#include "eyeslam/files/video_source.h"
#include "eyeslam/retina/units.h"

namespace eyeslam::apps {

files::PoseScore scoreMethod(const std::string& method, const std::string& sequence, int frames,
                             const std::function<void(std::int64_t)>& step)
{
  files::Truth truth = files::readTestSequence(sequence).truth;
  if (frames > 0 && static_cast<std::size_t>(frames) < truth.poses.size())
    truth.poses.resize(static_cast<std::size_t>(frames));
  const auto tracker = baselines::makeMethod(method, {});
  files::VideoSourceOptions options;
  options.last_frame = static_cast<std::int64_t>(truth.poses.size()) - 1;
  const auto source = files::openVideoSource(files::videoOfTestSequence(sequence), options);
  std::vector<files::EstimatedPose> poses;
  files::VideoFrame frame;
  while (poses.size() < truth.poses.size() && source->read(frame)) {
    const double start = threadCpuMilliseconds();
    const tracking::TrackResult& result = tracker->track(frame.image);
    const double cpu_ms = threadCpuMilliseconds() - start;
    const retina::Pose2& pose = result.map_T_frame;
    poses.push_back({result.tracked, pose.x, pose.y, pose.theta * 180.0 / kPi, cpu_ms});
    step(frame.number);
  }
  return files::scorePoses(truth.poses, poses);
}

}  // namespace eyeslam::apps
