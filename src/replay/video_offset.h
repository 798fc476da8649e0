// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "eyeslam/replay/image_motion.h"
#include "eyeslam/replay/sorted_log.h"

namespace eyeslam::replay {

/// How far a video's clock is from its log's.
struct OffsetEstimate {
  double offset_s = 0.0;     ///< to be added to the video's time to have the log's
  double frame_s = 0.0;      ///< period of the video's frames
  double sigma_s = 0.0;      ///< standard error of the offset
  double correlation = 0.0;  ///< of image motion and logged motion there, [0, 1]
  double second = 0.0;       ///< the best one elsewhere
  std::int64_t steps = 0;    ///< from frame to frame, compared there
  std::string against;       ///< what moved in the log: "RETINA_POSE", "port_displacement", "tip_position"

  double frames() const { return offset_s / frame_s; }
  /// Nowhere else would nearly do: three standard errors between the best and the second, half a frame for itself.
  bool isCertain() const;
};

/// Finds that offset: the motion between neighbouring frames, measured in the pictures, is held against the motion that
/// the log tells of between the same times, for all offsets within 10 s; the best one is refined within the frame. Axes
/// and scale between the two are fitted, so that the eye's port or the tip will do where no pose was logged. Keeps the
/// first 1800 frames and 120 s.
///
/// The video's time is that of the poses that belong to its pictures (side_video.h), or its own from the log's first
/// event on, where there are no poses.
class VideoOffset {
 public:
  /// Beyond which no picture is looked at where no pose tells where it belongs.
  static constexpr std::int64_t kMostPictures = 2400;

  /// @param shift  as of SideVideo
  explicit VideoOffset(double frames_per_second, std::int64_t shift = 0);

  /// The next picture of the video.
  void addPicture(std::int64_t number, const cv::Mat& image);
  /// Whether more pictures would be looked at.
  bool wantsPictures() const { return steps_.size() < kMostSteps; }
  /// The next event of the log.
  void take(const SortedEvent& event);

  /// None where too little moved, or was measured, to say anything.
  std::optional<OffsetEstimate> estimate() const;

 private:
  static constexpr std::size_t kMostSteps = 1800;

  struct Step {
    std::int64_t picture = 0;
    Eigen::Vector2d moved_px;
  };
  struct Stamp {
    std::int64_t pose = 0;
    double t_s = 0.0;
  };
  struct Place {
    double t_s = 0.0;
    Eigen::Vector3d at;
  };
  struct Path {
    std::string name;
    std::vector<Place> places;
  };
  struct Timed {
    double begin_s = 0.0, end_s = 0.0;
    Eigen::Vector2d moved_px;
  };
  struct Fit {
    double correlation = 0.0;
    std::int64_t steps = 0;
  };

  void takePose(const SortedEvent& event);
  void takeState(const SortedEvent& event);
  const Path* path() const;
  double timeOf(std::int64_t picture) const;
  std::vector<Timed> timedSteps() const;
  static Fit fit(const std::vector<Timed>& steps, const Path& path, double offset_s);

  double period_s_;
  std::int64_t shift_;
  ImageMotion motion_;
  std::vector<Step> steps_;
  std::vector<Stamp> stamps_;
  Path poses_{"RETINA_POSE", {}}, port_{"port_displacement", {}}, tip_{"tip_position", {}};
  std::int64_t start_ = 0, session_ = 0;
};

}  // namespace eyeslam::replay
