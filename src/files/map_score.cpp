// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/map_score.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "eyeslam/files/distance_picture.h"
#include "eyeslam/files/thinning.h"
#include "eyeslam/retina/units.h"

namespace eyeslam::files {
namespace {

constexpr int kEvery = 3;  // views are counted in every third frame

/// Where a frame shows retina: the disc of light without its soft edge, or the frame without a margin of 8 px.
cv::Mat_<std::uint8_t> fieldOfView(const Truth& truth)
{
  cv::Mat_<std::uint8_t> view(truth.size, std::uint8_t{0});
  if (truth.rim) {
    const int radius = cvRound(truth.rim->r - 12.0 * truth.size.width / 800.0);
    cv::circle(view, {cvRound(truth.rim->cx), cvRound(truth.rim->cy)}, radius, 1, -1);
  } else {
    const cv::Rect inner = cv::Rect(8, 8, truth.size.width - 16, truth.size.height - 16) & cv::Rect({}, truth.size);
    view(inner) = 1;
  }
  return view;
}

/// truth_T_frame: the pose as a 2 x 3 matrix into the px of the vessel picture.
cv::Matx23d intoPicture(const Truth& truth, const TruthPose& pose)
{
  const double cx = (truth.size.width - 1) / 2.0, cy = (truth.size.height - 1) / 2.0;
  const double theta = pose.theta_deg * kPi / 180.0;
  const double c = pose.scale * std::cos(theta), s = pose.scale * std::sin(theta);
  return {c, -s, cx + pose.x_px - (c * cx - s * cy) - truth.vessels_origin.x,
          s, c,  cy + pose.y_px - (s * cx + c * cy) - truth.vessels_origin.y};
}

/// The map's vessels drawn into the truth picture: 1 where a cell is at or above the threshold.
cv::Mat_<std::uint8_t> drawn(const Truth& truth, const retina::VesselMap& map)
{
  cv::Mat_<std::uint8_t> picture(truth.vessels.size(), std::uint8_t{0});
  if (map.empty()) return picture;
  cv::Mat_<std::uint8_t> vessels(map.height, map.width);
  for (std::size_t i = 0; i < map.probability.size(); ++i) vessels.data[i] = map.probability[i] >= 128 ? 1 : 0;
  const cv::Matx23d picture_T_map(map.px_per_cell, 0.0, map.origin_x - truth.vessels_origin.x,  //
                                  0.0, map.px_per_cell, map.origin_y - truth.vessels_origin.y);
  cv::warpAffine(vessels, picture, picture_T_map, picture.size(), cv::INTER_NEAREST);
  return picture;
}

/// Counts what is wanted and how much of it was reached.
struct Share {
  int reached = 0;
  int wanted = 0;

  void add(bool is_reached)
  {
    ++wanted;
    reached += is_reached ? 1 : 0;
  }
  double value() const { return wanted ? static_cast<double>(reached) / wanted : 0.0; }
};

}  // namespace

MapScorer::MapScorer(const Truth& truth) : truth_(truth)
{
  if (truth.vessels.empty()) throw std::invalid_argument("the truth has no vessels.png: maps cannot be scored");
  skeleton_ = thinned(truth.vessels);
  to_vessel_ = distanceTo(truth.vessels);
  view_ = fieldOfView(truth);
  views_ = cv::Mat_<std::uint16_t>(truth.vessels.size(), std::uint16_t{0});
  verdicts_ = cv::Mat_<std::uint8_t>(truth.vessels.size(), std::uint8_t{0});
}

void MapScorer::lookUntil(int frame)
{
  cv::Mat_<std::uint8_t> seen;
  for (; next_frame_ <= frame; next_frame_ += kEvery) {
    const TruthPose& pose = truth_.poses[static_cast<std::size_t>(next_frame_)];
    if (!pose.visible) continue;
    cv::warpAffine(view_, seen, intoPicture(truth_, pose), views_.size(), cv::INTER_NEAREST);
    cv::add(views_, seen, views_, cv::noArray(), CV_16U);
  }
}

MapScore MapScorer::score(int frame, const retina::VesselMap& map)
{
  if (frame < 0 || frame >= static_cast<int>(truth_.poses.size())) {
    throw std::invalid_argument("the sequence has no frame " + std::to_string(frame));
  }
  if (frame + kEvery < next_frame_) throw std::invalid_argument("maps must be scored in the order of their frames");
  lookUntil(frame);
  const cv::Mat_<std::uint8_t> claimed = drawn(truth_, map);
  const cv::Mat_<float> to_map = distanceTo(claimed);
  Share all, from_6, from_10, wrong;
  for (int i = 0; i < static_cast<int>(views_.total()); ++i) {
    if (kEvery * views_(i) < kSeenFrames) continue;
    if (skeleton_(i)) {
      const bool found = to_map(i) <= kTolerance_px;
      all.add(found);
      if (truth_.vessels(i) >= 6) from_6.add(found);
      if (truth_.vessels(i) >= 10) from_10.add(found);
    }
    if (claimed(i)) wrong.add(to_vessel_(i) > kTolerance_px);
  }
  judge(claimed, to_map);
  const auto cells = std::count_if(map.probability.begin(), map.probability.end(), [](auto p) { return p >= 128; });
  return {frame, all.value(), from_6.value(), from_10.value(), wrong.value(), static_cast<int>(cells)};
}

void MapScorer::judge(const cv::Mat_<std::uint8_t>& claimed, const cv::Mat_<float>& to_map)
{
  for (int i = 0; i < static_cast<int>(views_.total()); ++i) {
    MapVerdict verdict = MapVerdict::unseen;
    if (kEvery * views_(i) >= kSeenFrames) {
      verdict = MapVerdict::seen;
      if (claimed(i)) verdict = to_vessel_(i) <= kTolerance_px ? MapVerdict::found : MapVerdict::wrong;
      // A whole missed vessel is shown, not only its centreline, or thin lines would vanish in a small figure.
      else if (truth_.vessels(i) && to_map(i) > kTolerance_px)
        verdict = MapVerdict::missed;
    }
    verdicts_(i) = static_cast<std::uint8_t>(verdict);
  }
}

}  // namespace eyeslam::files
