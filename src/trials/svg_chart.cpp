// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/svg_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "eyeslam/files/chart.h"

namespace eyeslam::trials {

namespace {

constexpr const char* kAxisColour = "#555";
constexpr const char* kGridColour = "#e8e8e8";
constexpr double kTickText = 11.5, kLabelText = 12.0, kTitleText = 13.0;  // px
constexpr double kPxOfTick = 55.0;

// The round number just at or beyond, among 1, 2, 5 times powers of ten.
double roundDown(double value)
{
  const double decade = std::pow(10.0, std::floor(std::log10(value) + 1e-9));
  const double lead = value / decade + 1e-9;
  return decade * (lead >= 5.0 ? 5.0 : lead >= 2.0 ? 2.0 : 1.0);
}
double roundUp(double value)
{
  const double decade = std::pow(10.0, std::floor(std::log10(value) + 1e-9));
  const double lead = value / decade - 1e-9;
  return decade * (lead > 5.0 ? 10.0 : lead > 2.0 ? 5.0 : lead > 1.0 ? 2.0 : 1.0);
}

double share(const Axis& axis, double value)
{
  if (!axis.logarithmic) return (value - axis.from) / (axis.to - axis.from);
  return std::log(std::max(value, 1e-12) / axis.from) / std::log(axis.to / axis.from);
}

std::vector<double> decadeTicks(const Axis& axis)
{
  const bool wide = axis.to / axis.from > 1e3;
  std::vector<double> result;
  for (double decade = std::pow(10.0, std::floor(std::log10(axis.from) + 1e-9)); decade <= 1.001 * axis.to;
       decade *= 10.0)
    for (const double lead : {1.0, 2.0, 5.0})
      if (lead * decade >= 0.999 * axis.from && lead * decade <= 1.001 * axis.to && (!wide || lead == 1.0))
        result.push_back(lead * decade);
  return result;
}

}  // namespace

Axis Axis::fromZero(const std::string& label, double greatest)
{
  return {label, 0.0, greatest > 0.0 ? 1.05 * greatest : 1.0, false};
}

Axis Axis::decades(const std::string& label, double least, double greatest)
{
  const double from = roundDown(std::max(least, 1e-6));
  return {label, from, std::max(roundUp(std::max(greatest, 1e-6)), 2.0 * from), true};
}

std::vector<double> ticksOf(const Axis& axis, int wanted)
{
  return axis.logarithmic ? decadeTicks(axis) : files::ticks({axis.from, axis.to}, wanted);
}

std::string tickText(double value)
{
  const double magnitude = std::abs(value);
  return magnitude < 1e-12 ? "0" : magnitude >= 1e5 ? fmt::format("{:.2g}", value) : fmt::format("{:.6g}", value);
}

SvgChart::SvgChart(SvgCanvas& canvas, const Box& plot, Axis x, Axis y)
    : canvas_(canvas), plot_(plot), x_(std::move(x)), y_(std::move(y))
{}

Eigen::Vector2d SvgChart::place(double x, double y) const
{
  return {plot_.min().x() + share(x_, x) * plot_.sizes().x(), plot_.max().y() - share(y_, y) * plot_.sizes().y()};
}

void SvgChart::title(const std::string& words)
{
  Lettering lettering{kTitleText};
  lettering.weight = "600";
  canvas_.text({plot_.min().x(), plot_.min().y() - 10.0}, words, lettering);
}

void SvgChart::legend(const std::vector<Key>& keys)
{
  double at = plot_.max().x();
  for (auto key = keys.rbegin(); key != keys.rend(); ++key) {
    at -= widthOf(key->name, kTickText) + 4.0;
    const double y = plot_.min().y() - 10.0;
    canvas_.text({at, y}, key->name, {kTickText});
    at -= 24.0;
    if (key->paint.stroke != "none") {
      canvas_.line({at, y - 4.0}, {at + 20.0, y - 4.0}, key->paint);
    } else {
      canvas_.box(boxAt(at + 6.0, y - 9.0, 14.0, 10.0), key->paint);
    }
    at -= 14.0;
  }
}

void SvgChart::shade(double from, double to, const Paint& paint)
{
  const double left = std::clamp(place(from, y_.from).x(), plot_.min().x(), plot_.max().x());
  const double right = std::clamp(place(to, y_.from).x(), plot_.min().x(), plot_.max().x());
  if (right > left) canvas_.box(boxAt(left, plot_.min().y(), right - left, plot_.sizes().y()), paint);
}

void SvgChart::gridOfY()
{
  for (const double value : ticksOf(y_, std::max(3, static_cast<int>(plot_.sizes().y() / 40.0)))) {
    const double y = place(x_.from, value).y();
    canvas_.line({plot_.min().x(), y}, {plot_.max().x(), y}, Paint::line(kGridColour));
    canvas_.text({plot_.min().x() - 7.0, y + 4.0}, tickText(value), {kTickText, "end"});
  }
}

void SvgChart::frameAndLabels()
{
  const Eigen::Vector2d corner(plot_.min().x(), plot_.max().y());
  canvas_.path({plot_.min(), corner, plot_.max()}, Paint::line(kAxisColour));
  canvas_.text({plot_.center().x(), plot_.max().y() + 38.0}, x_.label, {kLabelText, "middle"});
  Lettering upright{kLabelText, "middle"};
  upright.turned_deg = -90.0;
  canvas_.text({plot_.min().x() - 46.0, plot_.center().y()}, y_.label, upright);
}

void SvgChart::axes()
{
  gridOfY();
  for (const double value : ticksOf(x_, std::max(3, static_cast<int>(plot_.sizes().x() / kPxOfTick)))) {
    const Eigen::Vector2d at = place(value, y_.from);
    canvas_.line(at, at + Eigen::Vector2d(0.0, 4.0), Paint::line(kAxisColour));
    canvas_.text(at + Eigen::Vector2d(0.0, 18.0), tickText(value), {kTickText, "middle"});
  }
  frameAndLabels();
}

void SvgChart::axes(const std::vector<std::string>& categories)
{
  gridOfY();
  for (std::size_t i = 0; i < categories.size(); ++i)
    canvas_.text(place(static_cast<double>(i), y_.from) + Eigen::Vector2d(0.0, 18.0), categories[i],
                 {kTickText, "middle"});
  frameAndLabels();
}

void SvgChart::curve(const std::vector<double>& x, const std::vector<double>& y, const Paint& paint)
{
  Points points;
  for (std::size_t i = 0; i < x.size(); ++i) points.push_back(place(x[i], y[i]));
  canvas_.clip(plot_);
  canvas_.path(simplified(points, 0.1), paint);
  canvas_.unclip();
}

void SvgChart::band(const std::vector<double>& x, const std::vector<double>& low, const std::vector<double>& high,
                    const Paint& paint)
{
  Points corners;
  for (std::size_t i = 0; i < x.size(); ++i) corners.push_back(place(x[i], high[i]));
  for (std::size_t i = x.size(); i-- > 0;) corners.push_back(place(x[i], low[i]));
  canvas_.clip(plot_);
  canvas_.polygon(corners, paint);
  canvas_.unclip();
}

void SvgChart::bar(double from, double to, double height, const Paint& paint)
{
  canvas_.box({place(from, height), place(to, y_.from)}, paint);
}

void SvgChart::dot(double x, double y, double radius, const Paint& paint, const std::string& tooltip)
{
  canvas_.circle(place(x, y), radius, paint, tooltip);
}

void SvgChart::vertical(double x, const Paint& paint) { canvas_.line(place(x, y_.from), place(x, y_.to), paint); }

Envelope envelope(const std::vector<double>& x, const std::vector<double>& y, std::size_t columns)
{
  Envelope result;
  const std::size_t count = std::min(x.size(), y.size());
  const std::size_t wanted = std::min(columns, count);
  for (std::size_t column = 0; column < wanted; ++column) {
    const auto from = static_cast<std::ptrdiff_t>(column * count / wanted);
    const auto to = static_cast<std::ptrdiff_t>((column + 1) * count / wanted);
    const auto [low, high] = std::minmax_element(y.begin() + from, y.begin() + to);
    result.x.push_back(x[static_cast<std::size_t>((from + to) / 2)]);
    result.low.push_back(*low);
    result.high.push_back(*high);
  }
  return result;
}

}  // namespace eyeslam::trials
