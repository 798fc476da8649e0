// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/truth_publisher.h"

namespace eyeslam::simulation {

namespace {

template <class Vector, std::size_t N>
void copy(const Vector& from, double (&to)[N])
{
  for (std::size_t i = 0; i < N; ++i) to[i] = from[static_cast<Eigen::Index>(i)];
}

}  // namespace

TruthPublisher::TruthPublisher(messaging::Link& link, double um_per_px) : truths_(link)
{
  message_.um_per_px = um_per_px;
  message_.frame = -1;
}

void TruthPublisher::expose(const FrameDue& due)
{
  const retina::Pose2 pose = due.view.at(due.t_s);
  message_.frame = due.frame;
  message_.frame_utime = due.utime;
  message_.frame_x_px = pose.x;
  message_.frame_y_px = pose.y;
  message_.frame_theta = pose.theta;
}

void TruthPublisher::publish(const HardwareTruth& truth, std::int64_t utime)
{
  const RetinaPose& pose = truth.eye.world_T_retina;
  message_.utime = utime;
  copy(pose.centre, message_.retina_centre);
  copy(pose.shift, message_.retina_shift);
  message_.retina_theta = pose.theta;
  copy(truth.tipRetina(), message_.tip);
  copy(truth.nullRetina(), message_.null);
  copy(truth.spotRetina(), message_.spot);
  copy(Eigen::Vector3d(pose.rotation().transpose() * truth.shaft), message_.shaft);
  message_.pivot_error = truth.pivot_error;
  message_.saturated = truth.saturated ? 1 : 0;
  message_.jerk = truth.jerk ? 1 : 0;
  copy(truth.jerked, message_.jerked);
  message_.emitting = truth.emitting ? 1 : 0;
  truths_.publish(message_, utime);
}

}  // namespace eyeslam::simulation
