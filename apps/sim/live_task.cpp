// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/live_task.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "eyeslam/simulation/traced_path.h"

namespace eyeslam::apps {
namespace {

using simulation::SurgeonTask;

constexpr double kSpeed = 0.4e-3;   // m/s along a path; loop study, section 1
constexpr double kHeight = 0.3e-3;  // m above the retina: the tip touches nothing

double across(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return (a - b).head<2>().norm(); }

LiveTask hold(const Eigen::Vector3d& place)
{
  return {simulation::holdPlace(place), place, [place](const Eigen::Vector3d& tip) { return across(tip, place); }};
}

LiveTask trace(const Eigen::Vector3d& middle)
{
  std::vector<Eigen::Vector3d> points = simulation::sineVessel(0.3, 1.1);
  const Eigen::Vector3d shift = middle - points[points.size() / 2];
  for (Eigen::Vector3d& point : points) point += shift;
  const auto path = std::make_shared<simulation::TracedPath>(points, kSpeed);  // shared by both functions
  return {[path](double t_s) {
            return SurgeonTask{path->at(t_s), {}, false, {}};
          },
          points.front(),
          [path](const Eigen::Vector3d& tip) {
            double nearest = std::numeric_limits<double>::infinity();
            for (const Eigen::Vector3d& point : path->points()) nearest = std::min(nearest, across(tip, point));
            return nearest;
          }};
}

// The hand stays over the pattern; the tip goes where the laser is needed.
LiveTask laser(const Eigen::Vector3d& place)
{
  LiveTask task = hold(place);
  task.surgeon = [place](double) { return SurgeonTask{{place, Eigen::Vector3d::Zero()}, {}, true, {}}; };
  return task;
}

}  // namespace

LiveTask liveTask(const std::string& name, const simulation::EyeCameraOptions& camera, double um_per_px)
{
  const cv::Point2d centre = simulation::imageCentre(camera);
  const double m_per_px = 1e-6 * um_per_px;
  const Eigen::Vector3d middle(m_per_px * centre.x, m_per_px * centre.y, -kHeight);
  if (name == "trace") return trace(middle);
  if (name == "laser") return laser(middle);
  return hold(middle + Eigen::Vector3d(0.4e-3, -0.3e-3, 0.0));
}

}  // namespace eyeslam::apps
