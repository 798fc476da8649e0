// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace eyeslam::trials {

using Points = std::vector<Eigen::Vector2d>;
/// A rectangle; in drawings px, y down.
using Box = Eigen::AlignedBox2d;

Box boxAt(double x, double y, double width, double height);

/// How a shape is painted; colours as in CSS.
struct Paint {
  std::string fill = "none";
  std::string stroke = "none";
  double width = 1.0;  ///< of the stroke, px
  double opacity = 1.0;
  std::string dash;  ///< lengths of dashes and gaps, px; empty: drawn through

  static Paint line(const std::string& colour, double width = 1.0, double opacity = 1.0);
  static Paint dashed(const std::string& colour, double width, const std::string& dash);
  static Paint area(const std::string& colour, double opacity = 1.0);
};

/// How words are set.
struct Lettering {
  double size = 12.0;            ///< px
  std::string anchor = "start";  ///< start, middle, end: what of the words lies at the place
  std::string colour = "#222";
  std::string weight = "normal";
  double turned_deg = 0.0;
  bool halo = false;  ///< a white rim, for words over a picture
};

/// A drawing of a report: shapes in the order in which they are laid over each other, as inline SVG.
///
///   SvgCanvas canvas(800, 300, "error over time");
///   canvas.path(points, Paint::line("#0072b2", 1.5));
///   page += canvas.svg();
class SvgCanvas {
 public:
  /// @param width, height  px at 100 %; @param description  for readers who do not see it
  SvgCanvas(double width, double height, const std::string& description);

  void path(const Points& points, const Paint& paint);
  void polygon(const Points& corners, const Paint& paint);
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Paint& paint) { path({from, to}, paint); }
  void box(const Box& box, const Paint& paint);
  /// @param tooltip  shown under the pointer; may be empty
  void circle(const Eigen::Vector2d& centre, double radius, const Paint& paint, const std::string& tooltip = {});
  void text(const Eigen::Vector2d& at, const std::string& words, const Lettering& lettering);
  /// What follows is drawn within the box alone, until `unclip`.
  void clip(const Box& box);
  void unclip() { body_ += "</svg>\n"; }
  /// Shapes written elsewhere, well-formed.
  void insert(const std::string& svg) { body_ += svg; }

  std::string svg() const;

 private:
  double width_, height_;
  std::string description_, body_;
};

/// Drops points that lie within `tolerance` of the line through those kept (Douglas and Peucker 1973).
Points simplified(const Points& points, double tolerance);

/// About how wide words are in the report's font, px.
double widthOf(const std::string& words, double size);

}  // namespace eyeslam::trials
