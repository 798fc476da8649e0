// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/detector_study.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "command_line/clocks.h"
#include "eyeslam/files/score.h"
#include "eyeslam/files/test_sequence.h"
#include "eyeslam/files/thinning.h"
#include "eyeslam/files/video_source.h"
#include "eyeslam/retina/pose2.h"
#include "eyeslam/retina/units.h"
#include "eyeslam/tracking/cross_vessel_smoother.h"
#include "eyeslam/tracking/ridge_detector.h"
#include "eyeslam/tracking/spurious_detection_filter.h"
#include "eyeslam/tracking/vessel_tracer.h"

namespace eyeslam::apps {

namespace {

using namespace eyeslam::tracking;

constexpr float kTolerance_px = 4.0F;  // as for maps (files::MapScorer)
constexpr int kWide_px = 6;

// The paper's whole detection behind the interface of a detector.
class CulledTracing : public VesselDetector {
 public:
  void detect(const Frame& frame, const OcclusionMask& mask, VesselPoints& points) override
  {
    tracer_.detect(frame, mask, points);
    filter_.removeFrom(points, frame, mask);
    smoother_.smoothAcross(points, frame, mask);
  }

 private:
  VesselTracer tracer_;
  SpuriousDetectionFilter filter_;
  CrossVesselSmoother smoother_;
};

std::unique_ptr<VesselDetector> makeDetector(const std::string& name)
{
  if (name == "ridge") return std::make_unique<RidgeDetector>();
  if (name == "tracing") return std::make_unique<VesselTracer>();
  return std::make_unique<CulledTracing>();
}

// The vessels of a sequence as they lie in its map, and what has been found of them.
class VesselTruth {
 public:
  explicit VesselTruth(const files::Truth& truth) : truth_(truth)
  {
    if (truth.vessels.empty()) throw std::invalid_argument("the sequence has no vessels.png to compare with");
    cv::distanceTransform(truth.vessels == 0, to_vessel_, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    cv::findNonZero(files::thinned(truth.vessels), centreline_);
  }

  void count(const VesselPoints& points, const Frame& frame, const OcclusionMask& mask, const files::TruthPose& pose)
  {
    const retina::Pose2 map_T_frame{pose.x_px, pose.y_px, pose.theta_deg * kPi / 180.0, pose.scale};
    ++frames_;
    countPoints(points, frame, map_T_frame);
    countCentrelines(frame, mask, map_T_frame.inverse());
  }

  DetectorScore score() const
  {
    return {points_ / std::max(1.0, frames_), on_vessel_ / std::max(1.0, points_), covered_ / std::max(1.0, in_view_),
            wide_covered_ / std::max(1.0, wide_in_view_), 0.0};
  }

 private:
  static cv::Point rounded(const Eigen::Vector2d& place)
  {
    return {static_cast<int>(std::lround(place.x())), static_cast<int>(std::lround(place.y()))};
  }
  Eigen::Vector2d centre() const { return {(truth_.size.width - 1) / 2.0, (truth_.size.height - 1) / 2.0}; }
  Eigen::Vector2d origin() const { return {truth_.vessels_origin.x, truth_.vessels_origin.y}; }

  // How many lie on a vessel; marks the frame around each.
  void countPoints(const VesselPoints& points, const Frame& frame, const retina::Pose2& map_T_frame)
  {
    found_.create(truth_.size.height, truth_.size.width);
    found_.setTo(0);
    for (const VesselPoint& point : points) {
      const Eigen::Vector2d in_frame = Eigen::Vector2d(point.x, point.y) - frame.centre();
      const Eigen::Vector2d full = frame.pixelSize().cwiseProduct(in_frame) + frame.centreInImage();
      const cv::Point at = rounded(map_T_frame * (full - centre()) + centre() - origin());
      on_vessel_ += cv::Rect({0, 0}, to_vessel_.size()).contains(at) && to_vessel_(at) <= kTolerance_px;
      cv::circle(found_, rounded(full), static_cast<int>(kTolerance_px), 255, cv::FILLED);
    }
    points_ += static_cast<double>(points.size());
  }

  // How much of what is in view has a mark.
  void countCentrelines(const Frame& frame, const OcclusionMask& mask, const retina::Pose2& frame_T_map)
  {
    for (const cv::Point& place : centreline_) {
      const Eigen::Vector2d full = frame_T_map * (Eigen::Vector2d(place.x, place.y) + origin() - centre()) + centre();
      const cv::Point in_frame =
          rounded((full - frame.centreInImage()).cwiseQuotient(frame.pixelSize()) + frame.centre());
      const cv::Point in_image = rounded(full);
      if (!mask.isVisible(in_frame.x, in_frame.y) || !cv::Rect({0, 0}, found_.size()).contains(in_image)) continue;
      const bool covered = found_(in_image) != 0;
      const bool wide = truth_.vessels(place) >= kWide_px;
      ++in_view_;
      covered_ += covered;
      wide_in_view_ += wide;
      wide_covered_ += wide && covered;
    }
  }

  const files::Truth& truth_;
  cv::Mat_<float> to_vessel_;
  std::vector<cv::Point> centreline_;
  cv::Mat_<std::uint8_t> found_;  // the frame, where a point is near
  double frames_ = 0.0, points_ = 0.0, on_vessel_ = 0.0;
  double in_view_ = 0.0, covered_ = 0.0, wide_in_view_ = 0.0, wide_covered_ = 0.0;
};

}  // namespace

std::vector<std::string> detectorNames() { return {"ridge", "tracing", "paper"}; }

DetectorScore scoreDetector(const std::string& detector, const std::string& sequence, int period)
{
  const files::TestSequence truth = files::readTestSequence(sequence);
  const auto source = files::openVideoSource(files::videoOfTestSequence(sequence), {});
  const auto found_by = makeDetector(detector);
  VesselTruth vessels(truth.truth);
  Frame frame;
  OcclusionMask mask;
  VesselPoints points;
  std::vector<double> cpu_us;
  for (files::VideoFrame image; source->read(image);) {
    const auto number = static_cast<std::size_t>(image.number);
    if (image.number % period != 0 || number >= truth.truth.poses.size() || !truth.truth.poses[number].visible)
      continue;
    if (frame.assign(image.image) != retina::Reason::none) continue;
    mask.update(frame);
    frame.normalise(mask);
    found_by->detect(frame, mask, points);  // the ridges' threshold follows from frame to frame: these are far apart
    const double start = threadCpuMilliseconds();
    found_by->detect(frame, mask, points);
    cpu_us.push_back(1000.0 * (threadCpuMilliseconds() - start));
    vessels.count(points, frame, mask, truth.truth.poses[number]);
  }
  DetectorScore score = vessels.score();
  if (!cpu_us.empty()) score.cpu_us = files::percentile(cpu_us, 50.0);
  return score;
}

}  // namespace eyeslam::apps
