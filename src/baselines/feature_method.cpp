// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/baselines/feature_method.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "eyeslam/baselines/contrast_picture.h"
#include "eyeslam/tracking/full_pixels.h"

namespace eyeslam::baselines {

using retina::Pose2;
using retina::Reason;

namespace {

constexpr float kRatio = 0.8F;             // of the best distance to the second best; source: Lowe 2004
constexpr double kMatchedWithin_px = 1.5;  // frame px; 1 to 3 alike
constexpr int kLeastMatched = 12;          // a chance similarity gathers 4 or 5
constexpr double kKeyframe_px = 40.0;      // moved so far from every keyframe, a frame becomes one
constexpr int kKeyframeInliers = 30;       // if it lies well

}  // namespace

FeatureMethod::FeatureMethod(const tracking::TrackerOptions& options, cv::Ptr<cv::Feature2D> features, int norm)
    : masked_(options), features_(std::move(features)), matcher_(norm)
{}

const tracking::TrackResult& FeatureMethod::track(const cv::Mat& image)
{
  ++result_.frame;
  if (const Reason why = observe(image); why != Reason::none) return refuseFrame(result_, why);
  if (keyframes_.empty()) {
    keyframes_.push_back({now_.keypoints, now_.descriptors.clone(), {}});
    return accept({}, static_cast<int>(now_.keypoints.size()));
  }
  const Keyframe& keyframe = nearestKeyframe();
  const std::optional<Fit> fit = fitTo(keyframe);
  if (!fit) return refuseFrame(result_, Reason::poor_match);
  const Pose2 map_T_frame = keyframe.map_T_keyframe * fit->keyframe_T_frame;
  if (fit->inliers >= kKeyframeInliers && fit->keyframe_T_frame.translation().norm() > kKeyframe_px) {
    keyframes_.push_back({now_.keypoints, now_.descriptors.clone(), map_T_frame});
  }
  return accept(map_T_frame, fit->inliers);
}

Reason FeatureMethod::observe(const cv::Mat& image)
{
  if (const Reason why = masked_.assign(image); why != Reason::none) return why;
  makeContrastPicture(masked_.frame(), masked_.mask(), picture_, visible_);
  features_->detectAndCompute(picture_, visible_, now_.keypoints, now_.descriptors);
  return static_cast<int>(now_.keypoints.size()) < kLeastMatched ? Reason::too_few_points : Reason::none;
}

const FeatureMethod::Keyframe& FeatureMethod::nearestKeyframe() const
{
  const auto distance = [&](const Keyframe& keyframe) {
    return (keyframe.map_T_keyframe.translation() - map_T_frame_.translation()).norm();
  };
  return *std::min_element(keyframes_.begin(), keyframes_.end(),
                           [&](const Keyframe& a, const Keyframe& b) { return distance(a) < distance(b); });
}

std::optional<FeatureMethod::Fit> FeatureMethod::fitTo(const Keyframe& keyframe)
{
  std::vector<std::vector<cv::DMatch>> pairs;
  matcher_.knnMatch(now_.descriptors, keyframe.descriptors, pairs, 2);
  std::vector<cv::Point2f> from, to;
  const Eigen::Vector2f centre = masked_.frame().centre().cast<float>();
  const cv::Point2f middle(centre.x(), centre.y());
  for (const auto& pair : pairs) {
    if (pair.size() < 2 || pair[0].distance > kRatio * pair[1].distance) continue;
    from.push_back(now_.keypoints[static_cast<std::size_t>(pair[0].queryIdx)].pt - middle);
    to.push_back(keyframe.keypoints[static_cast<std::size_t>(pair[0].trainIdx)].pt - middle);
  }
  if (static_cast<int>(from.size()) < kLeastMatched) return std::nullopt;
  cv::Mat inliers;
  const cv::Mat similarity =
      cv::estimateAffinePartial2D(from, to, inliers, cv::RANSAC, kMatchedWithin_px, 2000, 0.999, 20);
  if (similarity.empty()) return std::nullopt;
  Fit fit;
  fit.inliers = cv::countNonZero(inliers);
  if (fit.inliers < kLeastMatched) return std::nullopt;
  const double c = similarity.at<double>(0, 0), s = similarity.at<double>(1, 0);
  fit.keyframe_T_frame = {similarity.at<double>(0, 2), similarity.at<double>(1, 2), std::atan2(s, c), std::hypot(c, s)};
  return fit;
}

const tracking::TrackResult& FeatureMethod::accept(const Pose2& map_T_frame, int inliers)
{
  map_T_frame_ = map_T_frame;
  result_.tracked = true;
  result_.reason = Reason::none;
  result_.map_T_frame = tracking::inFullPixels(map_T_frame, masked_.frame());
  result_.points = inliers;
  result_.score = static_cast<double>(inliers) / static_cast<double>(now_.keypoints.size());
  return result_;
}

}  // namespace eyeslam::baselines
