// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <variant>
#include <vector>

namespace eyeslam::files {

inline const cv::Scalar kWhite{255, 255, 255};

/// How something is drawn. `colour` is BGR, 0 to 255.
struct Ink {
  cv::Scalar colour = kWhite;
  double width_px = 1.0;
  double opacity = 1.0;
};

/// Lines, arrows, discs and words over a picture, in its px. The same list becomes an SVG file, for print, or pixels.
///
///   VectorPicture figure(retina);
///   figure.line(vessel, {kCyan, 1.5});
///   writeWholeFile("figure.svg", figure.svg());
///   cv::imwrite("figure.png", figure.pixels(2.0));
class VectorPicture {
 public:
  /// @param background  8 bit, BGR; not copied
  explicit VectorPicture(cv::Mat background) : background_(std::move(background)) {}

  /// What is outside of it is not drawn, until the next call. An empty rectangle: all is drawn.
  void clipTo(cv::Rect area) { clip_ = area; }
  void line(std::vector<cv::Point2d> points, const Ink& ink);
  /// With a head at `to`.
  void arrow(cv::Point2d from, cv::Point2d to, const Ink& ink);
  void disc(cv::Point2d centre, double radius_px, const Ink& ink);
  void rectangle(cv::Rect2d area, const Ink& ink);
  /// `at` is the left end of the base line.
  void words(const std::string& text, cv::Point2d at, double height_px, const Ink& ink);

  cv::Size size() const { return background_.size(); }
  /// One file, the background in it as JPEG.
  std::string svg() const;
  /// `scale` times as many pixels as the background has.
  cv::Mat pixels(double scale = 1.0) const;

 private:
  struct Line {
    std::vector<cv::Point2d> points;
    bool filled;
    Ink ink;
    cv::Rect clip;
  };
  struct Words {
    std::string text;
    cv::Point2d at;
    double height_px;
    Ink ink;
  };

  std::string svgOf(const Line& line) const;
  static std::string svgOf(const Words& words);
  static void draw(const Line& line, double scale, cv::Mat& picture);
  static void draw(const Words& words, double scale, cv::Mat& picture);

  cv::Mat background_;
  cv::Rect clip_;
  std::vector<cv::Rect> clips_;  // those in use, for the SVG's list
  std::vector<std::variant<Line, Words>> shapes_;
};

}  // namespace eyeslam::files
