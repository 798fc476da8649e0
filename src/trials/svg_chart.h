// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "eyeslam/trials/svg_canvas.h"

namespace eyeslam::trials {

/// A scale of a chart and what it measures, with its unit.
struct Axis {
  std::string label;
  double from = 0.0, to = 1.0;
  bool logarithmic = false;  ///< then from > 0

  /// From 0 to a little more than the greatest; at least 0 to 1.
  static Axis fromZero(const std::string& label, double greatest);
  /// Whole steps of 1, 2, 5 times a power of ten around both.
  static Axis decades(const std::string& label, double least, double greatest);
};

/// What a colour of a chart stands for.
struct Key {
  std::string name;
  Paint paint;  ///< a line where it has a stroke, else a patch
};

/// One coordinate system of a figure: grid, thin axes, ticks, labels, marks within.
///
///   SvgChart chart(canvas, boxAt(60, 30, 400, 200), {"time (s)", 0, 20}, Axis::fromZero("error (um)", 120));
///   chart.axes();
///   chart.curve(times, errors, Paint::line("#0072b2", 1.5));
class SvgChart {
 public:
  /// @param plot  px, within the canvas, which must outlive the chart; ticks and labels stand left of it and below
  SvgChart(SvgCanvas& canvas, const Box& plot, Axis x, Axis y);

  void title(const std::string& words);
  /// In one row right above the plot, ending at its right side.
  void legend(const std::vector<Key>& keys);
  /// Background of a stretch of x; before `axes`.
  void shade(double from, double to, const Paint& paint);
  void axes();
  /// Instead of ticks of x: a word each at x = 0, 1, ...
  void axes(const std::vector<std::string>& categories);
  /// Clipped to the plot.
  void curve(const std::vector<double>& x, const std::vector<double>& y, const Paint& paint);
  /// Between two curves.
  void band(const std::vector<double>& x, const std::vector<double>& low, const std::vector<double>& high,
            const Paint& paint);
  void bar(double from, double to, double height, const Paint& paint);
  void dot(double x, double y, double radius, const Paint& paint, const std::string& tooltip = {});
  void vertical(double x, const Paint& paint);

  /// px
  Eigen::Vector2d place(double x, double y) const;
  const Box& plot() const { return plot_; }

 private:
  void gridOfY();
  void frameAndLabels();

  SvgCanvas& canvas_;
  Box plot_;
  Axis x_, y_;
};

/// Least and greatest of each column of a time series, so that a drawing of few columns hides no peak.
struct Envelope {
  std::vector<double> x, low, high;
};
/// @param x  rising, as many as y
Envelope envelope(const std::vector<double>& x, const std::vector<double>& y, std::size_t columns);

/// Round values on an axis, about `wanted` of them.
std::vector<double> ticksOf(const Axis& axis, int wanted);

/// A number as a tick says it.
std::string tickText(double value);

}  // namespace eyeslam::trials
