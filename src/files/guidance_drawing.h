// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "eyeslam/files/map_files.h"
#include "eyeslam/files/vector_picture.h"
#include "eyeslam/fixtures/vessel_graph.h"

namespace eyeslam::files {

/// Where a fixture puts the goal for a hand that is at rest; map frame, px.
struct FieldArrow {
  Eigen::Vector2d hand_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d goal_px = Eigen::Vector2d::Zero();
};

/// Where a tip was; map frame, px.
struct DrawnTrace {
  std::string caption;
  cv::Scalar colour;  ///< BGR
  std::vector<Eigen::Vector2d> points_px;
};

/// What guidance makes of a retina, for people to look at.
struct GuidanceFigure {
  cv::Mat retina;  ///< the mosaic, or the map itself; 8 bit, BGR
  PictureGeometry geometry;
  double um_per_px = 0.0;  ///< of map px
  fixtures::VesselNetwork network;
  Eigen::Vector2d window_middle_px = Eigen::Vector2d::Zero();  ///< what the close-ups show; map frame
  double window_px = 0.0;                                      ///< width of the square that they show, map px
  std::string field_caption;
  std::vector<FieldArrow> field;
  std::vector<DrawnTrace> traces;  ///< each gets a close-up of its own
};

/// Square panels, two a row: the retina with its graph and the close-ups' place, the fixture's field, and a panel a
/// trace over the retina. Each has its letter, a caption and a scale bar. Arrows point from the hand to its goal; those
/// that would reach the next hand end before it, and their colour is the distance.
VectorPicture drawGuidance(const GuidanceFigure& figure);

}  // namespace eyeslam::files
