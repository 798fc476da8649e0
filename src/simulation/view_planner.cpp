// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/view_planner.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "eyeslam/simulation/random.h"

namespace eyeslam::simulation {

namespace {

constexpr int kTries = 600;
constexpr int kWatchedFrames = 60;
constexpr double kLeastKnown = 0.9;
constexpr int kMargin_px = 24;
constexpr double kThickVessel_um = 40.0;

// Points around the view's edge, frame px relative to the image centre; those behind the rim are drawn back to it.
std::vector<Eigen::Vector2d> outline(const ViewPlanRequest& request)
{
  std::vector<Eigen::Vector2d> points;
  const Eigen::Vector2d half(request.view.width / 2.0, request.view.height / 2.0);
  for (int i = -2; i <= 2; ++i) {
    for (const double side : {-1.0, 1.0}) {
      points.emplace_back(half.x() * i / 2.0, half.y() * side);
      points.emplace_back(half.x() * side, half.y() * i / 2.0);
    }
  }
  for (Eigen::Vector2d& point : points) {
    const double length = point.norm();
    if (request.field_radius > 0.0 && length > request.field_radius) point *= request.field_radius / length;
  }
  return points;
}

// The outline over the whole motion, relative to the start.
std::vector<Eigen::Vector2d> swept(const ViewMotion& motion, const ViewPlanRequest& request)
{
  const auto edge = outline(request);
  std::vector<Eigen::Vector2d> points;
  const int step = std::max(1, request.frames / kWatchedFrames);
  for (int frame = 0; frame < request.frames; frame += step) {
    const retina::Pose2 pose = motion.at(frame / request.fps);
    for (const Eigen::Vector2d& point : edge) points.push_back(pose * point);
  }
  return points;
}

double shareOnKnown(const Fundus& fundus, cv::Point start, const std::vector<Eigen::Vector2d>& points)
{
  int on = 0;
  for (const Eigen::Vector2d& point : points) {
    const cv::Point place(start.x + cvRound(point.x()), start.y + cvRound(point.y()));
    if (place.inside({{0, 0}, fundus.known.size()}) && fundus.known(place)) ++on;
  }
  return static_cast<double>(on) / static_cast<double>(points.size());
}

double vesselShare(const cv::Mat_<int>& sums, cv::Point start, cv::Size view)
{
  const cv::Rect first = cv::Rect(start - cv::Point(view.width / 3, view.height / 3), view * 2 / 3) &
                         cv::Rect({0, 0}, cv::Size(sums.cols - 1, sums.rows - 1));
  if (first.empty()) return 0.0;
  const int count = sums(first.br()) - sums(first.y, first.br().x) - sums(first.br().y, first.x) + sums(first.tl());
  return static_cast<double>(count) / (255.0 * first.area());
}

cv::Rect areaOf(const std::vector<Eigen::Vector2d>& points, cv::Point start, cv::Size view, cv::Size fundus)
{
  // Corners behind the rim are rendered as well; the margin leaves room for the frames between those watched.
  Eigen::Vector2d low(-view.width / 2.0, -view.height / 2.0);
  Eigen::Vector2d high = -low;
  for (const Eigen::Vector2d& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const int margin = kMargin_px + view.width / 20;
  const cv::Rect all(cv::Point(start.x + cvFloor(low.x()) - margin, start.y + cvFloor(low.y()) - margin),
                     cv::Point(start.x + cvCeil(high.x()) + margin, start.y + cvCeil(high.y()) + margin));
  return all & cv::Rect({0, 0}, fundus);
}

}  // namespace

ViewPlan planView(const Fundus& fundus, const ViewMotion& motion, const ViewPlanRequest& request)
{
  const cv::Size size = fundus.known.size();
  const std::string sizes = std::to_string(size.width) + "x" + std::to_string(size.height) +
                            " px at this magnification, the view " + std::to_string(request.view.width) + "x" +
                            std::to_string(request.view.height);
  if (size.width < request.view.width || size.height < request.view.height) {
    throw std::invalid_argument("the retina is smaller than the view: " + sizes);
  }
  const auto points = swept(motion, request);
  cv::Mat_<int> sums;
  cv::integral(fundus.calibre_px > kThickVessel_um / fundus.um_per_px, sums, CV_32S);
  Random random(request.seed, 17);
  ViewPlan best;
  double best_score = -1.0;
  if (request.start) best = {*request.start, {}, shareOnKnown(fundus, *request.start, points)};
  for (int i = 0; i < kTries && !request.start; ++i) {
    const cv::Point start(static_cast<int>(random.uniform(0, size.width)),
                          static_cast<int>(random.uniform(0, size.height)));
    const double known = shareOnKnown(fundus, start, points);
    const double vessels = std::min(0.15, vesselShare(sums, start, request.view));
    // All on known retina first, then among vessels, then by chance.
    const double score = 20.0 * std::min(known, 0.995) + 10.0 * vessels + random.uniform(0.0, 0.5);
    if (score > best_score) {
      best_score = score;
      best = {start, {}, known};
    }
  }
  if (best.known_share < kLeastKnown) throw std::invalid_argument("the retina is too small for this motion: " + sizes);
  best.area = areaOf(points, best.start, request.view, size);
  return best;
}

}  // namespace eyeslam::simulation
