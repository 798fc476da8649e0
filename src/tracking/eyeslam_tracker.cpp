// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/eyeslam_tracker.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "eyeslam/tracking/detection.h"
#include "eyeslam/tracking/full_pixels.h"
#include "eyeslam/tracking/localizer.h"
#include "eyeslam/tracking/masked_frame.h"
#include "eyeslam/tracking/mosaic_picture.h"
#include "eyeslam/tracking/track_display.h"

namespace eyeslam::tracking {

using retina::Pose2;
using retina::Reason;

class EyeSlamTracker::Steps {
 public:
  explicit Steps(const TrackerOptions& options);

  const TrackResult& track(const cv::Mat& image);
  void updateMap();
  void finishMap();

  const TrackerOptions& options() const { return options_; }
  const TrackResult& result() const { return result_; }
  const ToolTip& tool() const { return tool_result_; }
  const AimingSpot& spot() const { return spot_result_; }
  const retina::VesselMap& vesselMap() const { return published_.map(); }
  bool isMapCutOff() const { return published_.isCutOff(); }
  std::vector<cv::Point2f> pointsInImage() const;
  cv::Mat drawMosaic(cv::Point2d& origin) const;
  double pixelSize() const { return masked_.frame().pixelSize().x(); }

  cv::Mat bgr;  // a ViSP image as the frame wants it

 private:
  void removePointsInSpot();
  const TrackResult& startMap();
  const TrackResult& startAgain(const MaskedContrast& picture);
  void beginAt(const MaskedContrast& picture, const PoseEstimate& mosaic_T_frame);
  const TrackResult& refuse(Reason why);
  const TrackResult& accept(const PoseEstimate& mosaic_T_frame, double score);
  std::int64_t framesSinceStart() const { return result_.frame - start_frame_; }

  TrackerOptions options_;
  MaskedFrame masked_;
  ToolTipTracker tool_;
  AimingSpotFinder spot_;
  std::unique_ptr<VesselDetector> detector_;
  StructureCheck structure_;
  PointSelector selector_;
  Localizer localizer_;
  PoseFilter filter_;
  OccupancyMap occupancy_;
  Mosaic mosaic_;
  Anchor anchor_;
  ScaleEvidence scale_;
  PublishedMap published_;
  MosaicPicture picture_;

  VesselPoints points_;
  ScanPoints chosen_;
  Pose2 last_pose_;  // of the last localized frame in the mosaic, frame px
  std::int64_t start_frame_ = 0;
  TrackResult result_;
  ToolTip tool_result_;
  AimingSpot spot_result_;
};

EyeSlamTracker::Steps::Steps(const TrackerOptions& options)
    : options_(options),
      masked_(options),
      tool_(options.tool),
      spot_(options.aiming_spot),
      detector_(makeDetector(options)),
      structure_(options.structure),
      selector_(options.selector),
      localizer_(options),
      filter_(options.filter),
      occupancy_(options.occupancy),
      mosaic_(options.mosaic),
      anchor_(options.anchor, options.refiner, options.smear, options.dense),
      scale_(options.scale, options.refiner),
      published_(options.published)
{}

// The paper's Fig. 2: detect, predict, match, smooth, update.
const TrackResult& EyeSlamTracker::Steps::track(const cv::Mat& image)
{
  ++result_.frame;
  const PosePrediction predicted = filter_.predict(1.0);
  if (const Reason why = masked_.assign(image); why != Reason::none) return refuse(why);
  const Frame& frame = masked_.frame();
  const OcclusionMask& mask = masked_.mask();
  const MaskedContrast picture = masked_.contrast();
  tool_result_ = tool_.update(frame, mask, image);
  spot_result_ = spot_.update(image, frame.white(), tool_result_);
  // Detect: Z_t, the vessel points of this frame.
  detector_->detect(frame, mask, points_);
  removePointsInSpot();
  selector_.choose(points_, frame.centre(), chosen_);
  if (mosaic_.empty()) return startMap();
  if (anchor_.isBetterStart(picture, framesSinceStart())) return startAgain(picture);
  // Localize: B_t by scan matching around the prediction, refined and verified; then L_t.
  const Freedom freedom = scale_.isMagnified() ? Freedom::similarity : Freedom::rigid;
  const Localization found = localizer_.localize(picture, chosen_, occupancy_, mosaic_, predicted, last_pose_, freedom);
  if (found.reason != Reason::none) return refuse(found.reason);
  const PoseEstimate mosaic_T_frame = filter_.correct(found.pose);
  // Map: what is seen is added, what is seen missing decays, the rest stays.
  const Pose2& pose = mosaic_T_frame.map_T_frame;
  occupancy_.decay(mask, picture.size(), pose, result_.frame);
  occupancy_.add(chosen_, pose);
  mosaic_.blend(picture, pose, found.sigma, framesSinceStart());
  anchor_.update(mosaic_, framesSinceStart());
  if (scale_.update(picture, mosaic_, pose, framesSinceStart())) anchor_.restore(mosaic_);
  return accept(mosaic_T_frame, found.score);
}

// The red light passes the colour test, and its edge is a line like any other (facts, A6).
void EyeSlamTracker::Steps::removePointsInSpot()
{
  if (!spot_result_.present) return;
  const Frame& frame = masked_.frame();
  const Eigen::Vector2d image(spot_result_.x_px, spot_result_.y_px);
  const Eigen::Vector2d spot = (image - frame.centreInImage()).cwiseQuotient(frame.pixelSize()) + frame.centre();
  const double reach = spot_.reach() / frame.pixelSize().x();
  const auto isInSpot = [&](const VesselPoint& point) {
    return (Eigen::Vector2d(point.x, point.y) - spot).squaredNorm() < reach * reach;
  };
  points_.erase(std::remove_if(points_.begin(), points_.end(), isInSpot), points_.end());
}

const TrackResult& EyeSlamTracker::Steps::startMap()
{
  // A white wall has no vessels either: nothing could ever be matched against such a map.
  if (static_cast<int>(chosen_.size()) < options_.matcher.min_points) return refuse(Reason::too_few_points);
  if (structure_.isNoise(masked_.frame(), masked_.mask())) return refuse(Reason::noise);
  const PoseEstimate origin{{}, 1e-6 * Eigen::Matrix3d::Identity()};
  const MaskedContrast picture = masked_.contrast();
  start_frame_ = result_.frame;
  localizer_.reserve(picture.size());
  published_.start(pixelSize());
  anchor_.start(picture);
  beginAt(picture, origin);
  return accept(origin, 0.0);
}

// Frame 0 was smeared, this one is sharp: the map starts from here, and frame 0 is found in it.
const TrackResult& EyeSlamTracker::Steps::startAgain(const MaskedContrast& picture)
{
  const PoseEstimate origin{{}, 1e-6 * Eigen::Matrix3d::Identity()};
  occupancy_.clear();
  beginAt(picture, origin);
  anchor_.startAgain(picture, mosaic_, framesSinceStart());
  return accept(origin, 0.0);
}

void EyeSlamTracker::Steps::beginAt(const MaskedContrast& picture, const PoseEstimate& mosaic_T_frame)
{
  filter_.reset(mosaic_T_frame);
  localizer_.restart();
  occupancy_.add(chosen_, mosaic_T_frame.map_T_frame);
  mosaic_.start(picture);
  scale_.start(picture, mosaic_);
}

const TrackResult& EyeSlamTracker::Steps::refuse(Reason why)
{
  filter_.coast();
  // Time to prepare the search of the whole map, which a lost view will need.
  if (why == Reason::blackout) localizer_.prepare(occupancy_);
  if (why == Reason::blackout || why == Reason::wrong_size) {  // nothing was detected: no findings of the frame before
    points_.clear();
    chosen_.clear();
    tool_result_ = {};
    spot_result_ = {};
  }
  return refuseFrame(result_, why, static_cast<int>(chosen_.size()));
}

const TrackResult& EyeSlamTracker::Steps::accept(const PoseEstimate& mosaic_T_frame, double score)
{
  const Frame& frame = masked_.frame();
  const Eigen::Vector3d unit(frame.pixelSize().x(), frame.pixelSize().y(), 1.0);
  const Pose2 map_T_mosaic = anchor_.mosaic_T_start().inverse();
  Eigen::Vector3d velocity = filter_.velocity();
  velocity.head<2>() = map_T_mosaic.linear() * velocity.head<2>();
  last_pose_ = mosaic_T_frame.map_T_frame;
  result_.tracked = true;
  result_.reason = Reason::none;
  result_.map_T_frame = inFullPixels(map_T_mosaic * last_pose_, frame);
  result_.velocity = unit.cwiseProduct(velocity);
  result_.covariance = unit.asDiagonal() * mosaic_T_frame.covariance * unit.asDiagonal();
  result_.points = static_cast<int>(chosen_.size());
  result_.score = score;
  return result_;
}

void EyeSlamTracker::Steps::updateMap()
{
  if (mosaic_.empty()) return;
  if (result_.tracked) {
    published_.observe(masked_.mask(), masked_.size(), mosaic_.centre(), last_pose_);
    picture_.observe(masked_.frame(), masked_.mask(), mosaic_.centre(), last_pose_);
    published_.moveTo(anchor_.mosaic_T_start().inverse(), mosaic_.centre());
  }
  published_.slice(mosaic_);
}

void EyeSlamTracker::Steps::finishMap()
{
  if (!mosaic_.empty()) published_.finish(mosaic_);
}

std::vector<cv::Point2f> EyeSlamTracker::Steps::pointsInImage() const
{
  std::vector<cv::Point2f> points;
  points.reserve(points_.size());
  const Frame& frame = masked_.frame();
  for (const VesselPoint& point : points_) {
    const Eigen::Vector2d centred = Eigen::Vector2d(point.x, point.y) - frame.centre();
    const Eigen::Vector2d image = frame.pixelSize().cwiseProduct(centred) + frame.centreInImage();
    points.emplace_back(static_cast<float>(image.x()), static_cast<float>(image.y()));
  }
  return points;
}

cv::Mat EyeSlamTracker::Steps::drawMosaic(cv::Point2d& origin) const
{
  origin = {0.0, 0.0};
  if (mosaic_.empty()) return {};
  cv::Point corner;
  cv::Mat picture = picture_.draw(mosaic_, corner);
  // Moved as a whole with frame 0; the turn of some 0.01 deg is left out.
  const Eigen::Vector2d at(corner.x, corner.y);
  const Eigen::Vector2d moved = at + anchor_.mosaic_T_start().inverse().translation();
  const Eigen::Vector2d full = (masked_.frame().pixelSize().array() * (moved.array() + 0.5) - 0.5).matrix();
  origin = {full.x(), full.y()};
  return picture;
}

EyeSlamTracker::EyeSlamTracker(const TrackerOptions& options) : steps_(std::make_unique<Steps>(options))
{
  p.resize(4);
}
EyeSlamTracker::~EyeSlamTracker() = default;

const TrackResult& EyeSlamTracker::initTracking(const vpImage<vpRGBa>& I)
{
  steps_ = std::make_unique<Steps>(steps_->options());
  return track(I);
}

const TrackResult& EyeSlamTracker::initTracking(const vpImage<unsigned char>& I)
{
  steps_ = std::make_unique<Steps>(steps_->options());
  return track(I);
}

const TrackResult& EyeSlamTracker::initTracking(const cv::Mat& image)
{
  steps_ = std::make_unique<Steps>(steps_->options());
  return track(image);
}

const TrackResult& EyeSlamTracker::track(const vpImage<vpRGBa>& I)
{
  if (I.getSize() == 0) return track(cv::Mat());  // refused by size, where the conversion would throw
  // Shares the pixels for the conversion: OpenCV has no const view of a foreign buffer, and this one is only read.
  auto* pixels = const_cast<vpRGBa*>(I.bitmap);
  cv::cvtColor(cv::Mat(static_cast<int>(I.getRows()), static_cast<int>(I.getCols()), CV_8UC4, pixels), steps_->bgr,
               cv::COLOR_RGBA2BGR);
  return track(steps_->bgr);
}

const TrackResult& EyeSlamTracker::track(const vpImage<unsigned char>& I)
{
  auto* pixels = const_cast<unsigned char*>(I.bitmap);
  return track(cv::Mat(static_cast<int>(I.getRows()), static_cast<int>(I.getCols()), CV_8UC1, pixels));
}

const TrackResult& EyeSlamTracker::track(const cv::Mat& image)
{
  const TrackResult& result = steps_->track(image);
  p[0] = result.map_T_frame.x;
  p[1] = result.map_T_frame.y;
  p[2] = result.map_T_frame.theta;
  p[3] = result.map_T_frame.scale;
  return result;
}

void EyeSlamTracker::updateMap() { steps_->updateMap(); }
void EyeSlamTracker::finishMap() { steps_->finishMap(); }
const TrackResult& EyeSlamTracker::getResult() const { return steps_->result(); }
const ToolTip& EyeSlamTracker::getToolTip() const { return steps_->tool(); }
const AimingSpot& EyeSlamTracker::getAimingSpot() const { return steps_->spot(); }
std::vector<cv::Point2f> EyeSlamTracker::getPoints() const { return steps_->pointsInImage(); }
bool EyeSlamTracker::isMapCutOff() const { return steps_->isMapCutOff(); }
const retina::VesselMap& EyeSlamTracker::getVesselMap() const { return steps_->vesselMap(); }

cv::Mat EyeSlamTracker::getMosaic(cv::Point2d& origin, double& px_per_pixel) const
{
  px_per_pixel = steps_->pixelSize();
  return steps_->drawMosaic(origin);
}

void EyeSlamTracker::display(const vpImage<vpRGBa>& I, const vpColor& color, unsigned int thickness) const
{
  displayTrack(I, getVesselMap(), getResult(), getToolTip(), color, thickness);
}

void EyeSlamTracker::display(const vpImage<unsigned char>& I, const vpColor& color, unsigned int thickness) const
{
  displayTrack(I, getVesselMap(), getResult(), getToolTip(), color, thickness);
}

}  // namespace eyeslam::tracking
