// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace eyeslam::files {

/// The part of an axis that is shown.
struct Interval {
  double from = 0.0;
  double to = 1.0;

  double length() const { return to - from; }
  /// Widened to hold the finite values of a list.
  Interval holding(const std::vector<double>& values) const;
  /// With a twentieth more on both sides, and never shorter than `least`.
  Interval padded(double least) const;
};

/// About `wanted` round values within the interval, at steps of 1, 2 or 5 times a power of ten.
std::vector<double> ticks(Interval interval, int wanted);

/// A colour of a legend and what it stands for.
struct LegendEntry {
  std::string name;
  cv::Scalar colour;
};

/// A chart drawn into an area of a picture (BGR, 8 bit): title above, ticks left and below, curves within.
///
///   Chart chart(picture, {0, 0, 800, 300}, {0.0, 12.0}, {0.0, 1.0});
///   chart.shade(3.0, 4.5);
///   chart.axes("coverage", "s");
///   chart.curve(times, values, kBlue, 2);
class Chart {
 public:
  Chart(cv::Mat& picture, cv::Rect area, Interval x, Interval y);

  /// Background for a stretch of x; call it before `axes`.
  void shade(double from, double to);
  void axes(const std::string& title, const std::string& x_unit);
  /// Values that are not finite interrupt the curve.
  void curve(const std::vector<double>& x, const std::vector<double>& y, const cv::Scalar& colour, int thickness);
  void dots(const std::vector<double>& x, const std::vector<double>& y, const cv::Scalar& colour);
  void squares(const std::vector<double>& x, const std::vector<double>& y, const cv::Scalar& colour);
  /// Right above the plot.
  void legend(const std::vector<LegendEntry>& entries);

 private:
  cv::Point2d place(double x, double y) const;

  cv::Mat picture_;
  cv::Rect plot_;
  Interval x_, y_;
};

/// Text as the figures have it; `at` is the left end of its base line.
void writeText(cv::Mat& picture, const std::string& text, cv::Point at, double size, const cv::Scalar& colour);

/// Width of such a text, px.
int textWidth(const std::string& text, double size);

}  // namespace eyeslam::files
