// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "eyeslam/simulation/retina_pose.h"
#include "eyeslam/simulation/view_motion.h"

namespace eyeslam::simulation {

/// The bridge from the 1 kHz simulation to the renderer: keeps the newest poses of the retina and gives the view's pose
/// at any instant between them.
///
///   RecordedView view(image_centre_px, um_per_px, 0.1);
///   each millisecond: view.add(retina.step(hand).world_T_retina);
///   each frame:       microscope.expose(frame, view);   // when the end of its exposure has been added
///
/// Between two poses it is linear: at 1 kHz within 1 um of a saccade of 1.3 mm in 40 ms. Never allocates in `add`.
class RecordedView : public ViewMotion {
 public:
  /// @param kept_s  how far back it remembers; instants before that give the oldest pose, later ones the newest
  RecordedView(const Eigen::Vector2d& image_centre_px, double um_per_px, double kept_s, double period_s = 1e-3);

  /// The pose one period after the last; the first is that at t = 0.
  void add(const RetinaPose& world_T_retina);

  retina::Pose2 at(double t_s) const override;
  /// No warp: tissue that is stretched is not simulated at 1 kHz.
  std::array<double, 6> warpAt(double t_s) const override;

 private:
  const retina::Pose2& kept(std::size_t number) const { return ring_[number % ring_.size()]; }

  Eigen::Vector2d image_centre_px_;
  double um_per_px_, period_s_;
  std::vector<retina::Pose2> ring_;
  std::size_t added_ = 0;
};

}  // namespace eyeslam::simulation
