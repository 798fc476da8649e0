// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "eyeslam/tracking/sub_pixel.h"

namespace eyeslam::files {
namespace {

const cv::Scalar kChartInk(60, 56, 52), kGrid(232, 230, 228), kShade(226, 222, 218), kFrame(150, 146, 142);
constexpr int kLeft = 66, kRight = 18, kTop = 34, kBottom = 34;  // px around the plot
constexpr double kSmall = 0.45, kTitle = 0.52;

double roundStep(double rough)
{
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough * (1.0 - 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

std::string tickText(double value, double step)
{
  const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
  return fmt::format("{:.{}f}", std::abs(value) < step / 1000.0 ? 0.0 : value, digits);
}

}  // namespace

Interval Interval::holding(const std::vector<double>& values) const
{
  Interval wider = *this;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    wider = {std::min(wider.from, value), std::max(wider.to, value)};
  }
  return wider;
}

Interval Interval::padded(double least) const
{
  const double half = std::max(1.1 * length(), least) / 2.0, middle = (from + to) / 2.0;
  return {middle - half, middle + half};
}

std::vector<double> ticks(Interval interval, int wanted)
{
  const double step = roundStep(interval.length() / wanted);
  std::vector<double> values;
  for (double at = std::ceil(interval.from / step - 1e-9); at * step <= interval.to + 1e-9 * step; at += 1.0) {
    values.push_back(at * step);
  }
  return values;
}

Chart::Chart(cv::Mat& picture, cv::Rect area, Interval x, Interval y)
    : picture_(picture),
      plot_(area.x + kLeft, area.y + kTop, area.width - kLeft - kRight, area.height - kTop - kBottom),
      x_(x),
      y_(y)
{}

cv::Point2d Chart::place(double x, double y) const
{
  return {plot_.x + (x - x_.from) / x_.length() * plot_.width,
          plot_.y + plot_.height - (y - y_.from) / y_.length() * plot_.height};
}

void Chart::shade(double from, double to)
{
  const int left = cvRound(place(std::max(from, x_.from), 0.0).x), right = cvRound(place(std::min(to, x_.to), 0.0).x);
  cv::rectangle(picture_, {left, plot_.y}, {std::max(left, right), plot_.br().y}, kShade, cv::FILLED);
}

void Chart::axes(const std::string& title, const std::string& x_unit)
{
  const std::vector<double> along = ticks(x_, std::max(2, plot_.width / 90));
  const std::vector<double> up = ticks(y_, std::max(2, plot_.height / 45));
  const auto step = [](const std::vector<double>& at) { return at.size() > 1 ? at[1] - at[0] : 1.0; };
  for (const double x : along) {
    const int at = cvRound(place(x, 0.0).x);
    const bool last = x == along.back();
    const std::string text = tickText(x, step(along)) + (last ? " " + x_unit : "");
    cv::line(picture_, {at, plot_.y}, {at, plot_.br().y}, kGrid);
    writeText(picture_, text, {at - textWidth(tickText(x, step(along)), kSmall) / 2, plot_.br().y + 19}, kSmall,
              kChartInk);
  }
  for (const double y : up) {
    const int at = cvRound(place(0.0, y).y);
    const std::string text = tickText(y, step(up));
    cv::line(picture_, {plot_.x, at}, {plot_.br().x, at}, kGrid);
    writeText(picture_, text, {plot_.x - 8 - textWidth(text, kSmall), at + 5}, kSmall, kChartInk);
  }
  cv::rectangle(picture_, plot_.tl(), plot_.br(), kFrame);
  writeText(picture_, title, {plot_.x, plot_.y - 10}, kTitle, kChartInk);
}

void Chart::curve(const std::vector<double>& x, const std::vector<double>& y, const cv::Scalar& colour, int thickness)
{
  cv::Mat inside = picture_(plot_);
  const cv::Point2d corner(plot_.tl());
  for (std::size_t i = 1; i < std::min(x.size(), y.size()); ++i) {
    if (!std::isfinite(y[i - 1]) || !std::isfinite(y[i])) continue;
    cv::line(inside, tracking::inSubPixels(place(x[i - 1], y[i - 1]) - corner),
             tracking::inSubPixels(place(x[i], y[i]) - corner), colour, thickness, cv::LINE_AA,
             tracking::kSubPixelBits);
  }
}

void Chart::dots(const std::vector<double>& x, const std::vector<double>& y, const cv::Scalar& colour)
{
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (std::isfinite(y[i]))
      cv::circle(picture_, tracking::inSubPixels(place(x[i], y[i])), 4 << tracking::kSubPixelBits, colour, cv::FILLED,
                 cv::LINE_AA, tracking::kSubPixelBits);
  }
}

void Chart::squares(const std::vector<double>& x, const std::vector<double>& y, const cv::Scalar& colour)
{
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (x[i] < x_.from || x[i] > x_.to) continue;
    const cv::Point at = place(x[i], y[i]);
    cv::rectangle(picture_, at - cv::Point(5, 5), at + cv::Point(5, 5), colour, 2);
  }
}

void Chart::legend(const std::vector<LegendEntry>& entries)
{
  int right = plot_.br().x;
  for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry) {
    right -= textWidth(entry->name, kSmall);
    writeText(picture_, entry->name, {right, plot_.y - 10}, kSmall, kChartInk);
    cv::line(picture_, {right - 28, plot_.y - 14}, {right - 8, plot_.y - 14}, entry->colour, 3, cv::LINE_AA);
    right -= 46;
  }
}

void writeText(cv::Mat& picture, const std::string& text, cv::Point at, double size, const cv::Scalar& colour)
{
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, size, colour, 1, cv::LINE_AA);
}

int textWidth(const std::string& text, double size)
{
  int baseline = 0;
  return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, 1, &baseline).width;
}

}  // namespace eyeslam::files
