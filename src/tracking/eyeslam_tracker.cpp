// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/eyeslam_tracker.h"

#include <opencv2/imgproc.hpp>

#include "eyeslam/tracking/localizer.h"

namespace eyeslam::tracking {

using retina::Pose2;
using retina::Reason;

class EyeSlamTracker::Steps {
 public:
  explicit Steps(const TrackerOptions& options)
      : options_(options),
        frame_(options.frame),
        mask_(options.occlusion),
        detector_(std::make_unique<RidgeDetector>(options.ridge)),
        selector_(options.selector),
        localizer_(options),
        filter_(options.filter),
        occupancy_(options.occupancy),
        mosaic_(options.mosaic),
        anchor_(options.anchor, options.refiner),
        scale_(options.scale, options.refiner)
  {}

  const TrackResult& track(const cv::Mat& image);
  const TrackResult& result() const { return result_; }

  cv::Mat colour_;  // a ViSP image as OpenCV has it
  ToolTip tip_;
  retina::VesselMap published_;

 private:
  const TrackResult& startMap();
  const TrackResult& refuse(Reason why);
  const TrackResult& accept(const PoseEstimate& map_T_frame, const Localization& found);
  Pose2 inFullPixels(const Pose2& map_T_frame) const;

  TrackerOptions options_;
  Frame frame_;
  OcclusionMask mask_;
  std::unique_ptr<VesselDetector> detector_;
  PointSelector selector_;
  Localizer localizer_;
  PoseFilter filter_;
  OccupancyMap occupancy_;
  Mosaic mosaic_;
  Anchor anchor_;
  ScaleEvidence scale_;
  Pose2 last_pose_;  // of the last localized frame, frame px
  VesselPoints points_;
  ScanPoints chosen_;
  TrackResult result_;
};

// The paper's Fig. 2: detect, predict, match, smooth, update.
const TrackResult& EyeSlamTracker::Steps::track(const cv::Mat& image)
{
  ++result_.frame;
  const PosePrediction predicted = filter_.predict(1.0);
  if (const Reason why = frame_.assign(image); why != Reason::none) return refuse(why);
  mask_.update(frame_);
  if (mask_.medianRed() < options_.localizer.least_red || mask_.visibleFraction() < options_.localizer.least_visible) {
    return refuse(Reason::blackout);
  }
  // Detect: Z_t, the vessel points of this frame.
  frame_.normalise(mask_);
  detector_->detect(frame_, mask_, points_);
  selector_.choose(points_, frame_.centre(), chosen_);
  if (mosaic_.empty()) return startMap();
  // Localize: B_t by scan matching around the prediction, refined and verified; then L_t.
  const Freedom freedom = scale_.isMagnified() ? Freedom::similarity : Freedom::rigid;
  const Localization found =
      localizer_.localize(frame_, mask_, chosen_, occupancy_, mosaic_, predicted, last_pose_, freedom);
  if (found.reason != Reason::none) return refuse(found.reason);
  const PoseEstimate map_T_frame = filter_.correct(found.pose);
  // Map: what is seen is added, what is seen missing decays, the rest stays.
  occupancy_.decay(mask_, {frame_.width(), frame_.height()}, map_T_frame.map_T_frame, result_.frame);
  occupancy_.add(chosen_, map_T_frame.map_T_frame);
  mosaic_.blend(frame_, mask_, map_T_frame.map_T_frame, found.sigma, result_.frame);
  anchor_.update(mosaic_, result_.frame);
  if (scale_.update(frame_, mask_, mosaic_, map_T_frame.map_T_frame, result_.frame)) anchor_.restore(mosaic_);
  return accept(map_T_frame, found);
}

const TrackResult& EyeSlamTracker::Steps::startMap()
{
  const PoseEstimate origin{{}, 1e-6 * Eigen::Matrix3d::Identity()};
  filter_.reset(origin);
  occupancy_.add(chosen_, {});
  mosaic_.start(frame_.contrast(), mask_.cells());
  anchor_.start(frame_, mask_);
  scale_.start(frame_, mosaic_, mask_);
  Localization found;
  found.pose = origin;
  return accept(origin, found);
}

const TrackResult& EyeSlamTracker::Steps::refuse(Reason why)
{
  filter_.coast();
  result_.tracked = false;
  result_.reason = why;
  return result_;
}

const TrackResult& EyeSlamTracker::Steps::accept(const PoseEstimate& map_T_frame, const Localization& found)
{
  const Eigen::Vector3d unit(frame_.pixelSize().x(), frame_.pixelSize().y(), 1.0);
  result_.tracked = true;
  result_.reason = Reason::none;
  result_.map_T_frame = inFullPixels(anchor_.mosaic_T_start().inverse() * map_T_frame.map_T_frame);
  last_pose_ = map_T_frame.map_T_frame;
  result_.covariance = unit.asDiagonal() * map_T_frame.covariance * unit.asDiagonal();
  result_.points = static_cast<int>(chosen_.size());
  result_.score = found.score;
  return result_;
}

Pose2 EyeSlamTracker::Steps::inFullPixels(const Pose2& map_T_frame) const
{
  // The frame's centre is not the image's where an odd column was dropped; the pose speaks of the image's.
  const Eigen::Vector2d image_centre((frame_.fullSize().width - 1) / 2.0, (frame_.fullSize().height - 1) / 2.0);
  const Eigen::Vector2d offset = frame_.centreInImage() - image_centre;
  const Eigen::Vector2d t =
      frame_.pixelSize().cwiseProduct(map_T_frame.translation()) + offset - map_T_frame.linear() * offset;
  return {t.x(), t.y(), map_T_frame.theta, map_T_frame.scale};
}

EyeSlamTracker::EyeSlamTracker(const TrackerOptions& options) : steps_(std::make_unique<Steps>(options)) {}
EyeSlamTracker::~EyeSlamTracker() = default;
const TrackResult& EyeSlamTracker::track(const cv::Mat& image) { return steps_->track(image); }
const TrackResult& EyeSlamTracker::getResult() const { return steps_->result(); }
const retina::VesselMap& EyeSlamTracker::getVesselMap() const { return steps_->published_; }
const ToolTip& EyeSlamTracker::getToolTip() const { return steps_->tip_; }
void EyeSlamTracker::updateMap() {}
void EyeSlamTracker::finishMap() {}

}  // namespace eyeslam::tracking
