// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "eyeslam/trials/svg_canvas.h"
#include "eyeslam/trials/trial_record.h"

namespace eyeslam::trials {

/// The part of a true retina that a page's figures show, toned so that what is drawn over it stands out: written once,
/// used by its name as often as wanted.
class RetinaBackground {
 public:
  /// @param region  retina frame, m; what of it the picture does not have stays empty
  /// @param margin  m, drawn dashed around the true vessels; 0: none
  /// @param name    unlike any other on the page
  RetinaBackground(const RetinaPicture& picture, const Box& region, double margin, std::string name);

  bool empty() const { return place_.isEmpty(); }
  /// The picture itself, before its first use.
  std::string definition() const;
  const std::string& name() const { return name_; }
  /// Retina frame, m.
  const Box& place() const { return place_; }

 private:
  std::string outlines(const cv::Mat_<std::uint8_t>& mask, const std::string& how) const;

  std::string name_, shapes_;
  Box place_;
  cv::Size size_;
};

/// A piece of retina as an area of a figure.
class RetinaPanel {
 public:
  /// @param plot  px; @param region  retina frame, m, of the plot's proportions
  RetinaPanel(SvgCanvas& canvas, const Box& plot, const Box& region);

  /// Clipped to the panel until `finish`.
  void begin(const RetinaBackground& background);
  /// Frame, scale bar in um, title above.
  void finish(const std::string& title);

  /// px, of a place on the retina
  Eigen::Vector2d place(const Eigen::Vector2d& retina_m) const;
  Points places(const Points& retina_m) const;
  double pxPerMetre() const { return plot_.sizes().x() / region_.sizes().x(); }
  const Box& region() const { return region_; }

 private:
  void scaleBar();

  SvgCanvas& canvas_;
  Box plot_, region_;
};

/// The smallest region of the wanted proportions around another, and never narrower than `least`.
Box grownTo(const Box& region, double width_by_height, double least);

}  // namespace eyeslam::trials
