// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/baselines/klt_method.h"

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "eyeslam/baselines/contrast_picture.h"
#include "eyeslam/tracking/full_pixels.h"

namespace eyeslam::baselines {

using retina::Reason;

namespace {

constexpr int kCorners = 400;
constexpr int kRenewBelow = 150;            // corners left
constexpr int kLeastFollowed = 20;          // a chance similarity gathers 4 or 5
constexpr double kFollowedWithin_px = 1.5;  // frame px
const cv::Size kWindow(21, 21);             // frame px
constexpr int kPyramid = 3;                 // levels above the frame: jumps to some 40 px

}  // namespace

KltMethod::KltMethod(const tracking::TrackerOptions& options) : masked_(options) {}

const tracking::TrackResult& KltMethod::track(const cv::Mat& image)
{
  ++result_.frame;
  if (const Reason why = observe(image); why != Reason::none) return refuseFrame(result_, why);
  if (!last_picture_.empty() && !follow()) return refuseFrame(result_, Reason::poor_match);
  if (static_cast<int>(corners_.size()) < kRenewBelow) chooseCorners();
  picture_.copyTo(last_picture_);
  return accept();
}

Reason KltMethod::observe(const cv::Mat& image)
{
  if (const Reason why = masked_.assign(image); why != Reason::none) return why;
  makeContrastPicture(masked_.frame(), masked_.mask(), picture_, visible_);
  return Reason::none;
}

// Moves the corners on, keeps those that agree on one similarity, and takes the pose from it.
bool KltMethod::follow()
{
  if (static_cast<int>(corners_.size()) < kLeastFollowed) return false;
  std::vector<cv::Point2f> moved;
  std::vector<std::uint8_t> found;
  std::vector<float> errors;
  cv::calcOpticalFlowPyrLK(last_picture_, picture_, corners_, moved, found, errors, kWindow, kPyramid);
  const cv::Point2f middle(static_cast<float>(masked_.frame().centre().x()),
                           static_cast<float>(masked_.frame().centre().y()));
  std::vector<cv::Point2f> from, to, places;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const int x = static_cast<int>(std::lround(moved[i].x));
    const int y = static_cast<int>(std::lround(moved[i].y));
    if (!found[i] || !masked_.mask().isVisible(x, y)) continue;
    from.push_back(moved[i] - middle);
    to.push_back(chosen_[i]);
    places.push_back(moved[i]);
  }
  if (static_cast<int>(from.size()) < kLeastFollowed) return false;
  std::vector<std::uint8_t> inliers;
  const cv::Mat similarity =
      cv::estimateAffinePartial2D(from, to, inliers, cv::RANSAC, kFollowedWithin_px, 2000, 0.999, 20);
  if (similarity.empty() || cv::countNonZero(inliers) < kLeastFollowed) return false;
  corners_.clear();
  chosen_.clear();
  for (std::size_t i = 0; i < inliers.size(); ++i) {
    if (!inliers[i]) continue;
    corners_.push_back(places[i]);
    chosen_.push_back(to[i]);
  }
  const double c = similarity.at<double>(0, 0), s = similarity.at<double>(1, 0);
  map_T_frame_ = map_T_chosen_ * retina::Pose2{similarity.at<double>(0, 2), similarity.at<double>(1, 2),
                                               std::atan2(s, c), std::hypot(c, s)};
  return true;
}

void KltMethod::chooseCorners()
{
  cv::goodFeaturesToTrack(picture_, corners_, kCorners, 0.01, 8.0, visible_, 5);
  const cv::Point2f middle(static_cast<float>(masked_.frame().centre().x()),
                           static_cast<float>(masked_.frame().centre().y()));
  chosen_.clear();
  for (const cv::Point2f& corner : corners_) chosen_.push_back(corner - middle);
  map_T_chosen_ = map_T_frame_;
}

const tracking::TrackResult& KltMethod::accept()
{
  result_.tracked = true;
  result_.reason = Reason::none;
  result_.map_T_frame = tracking::inFullPixels(map_T_frame_, masked_.frame());
  result_.points = static_cast<int>(corners_.size());
  result_.score = static_cast<double>(corners_.size()) / kCorners;
  return result_;
}

}  // namespace eyeslam::baselines
