// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/svg_canvas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "eyeslam/files/markup.h"
#include "eyeslam/trials/segment.h"

namespace eyeslam::trials {

using files::escaped;

namespace {

// In Helvetica and its kin.
constexpr std::string_view kNarrow = "fijlrtI .,:;!|()'-/", kBroad = "mwMWGOQCD%";

std::string attributes(const Paint& paint)
{
  std::string text = fmt::format("fill=\"{}\"", paint.fill);
  if (paint.stroke != "none") text += fmt::format(" stroke=\"{}\" stroke-width=\"{:.4g}\"", paint.stroke, paint.width);
  if (paint.opacity < 1.0) text += fmt::format(" opacity=\"{:.3g}\"", paint.opacity);
  if (!paint.dash.empty()) text += fmt::format(" stroke-dasharray=\"{}\"", paint.dash);
  return text;
}

// Relative steps: half as long as absolute places. Rounded places are subtracted, so that no error adds up.
std::string wayOf(const Points& points)
{
  const auto tenths = [](double value) { return std::lround(10.0 * value); };
  long x = tenths(points.front().x()), y = tenths(points.front().y());
  std::string way = fmt::format("M{:.4g} {:.4g}l", 0.1 * static_cast<double>(x), 0.1 * static_cast<double>(y));
  const auto written = [](long value) {
    return value % 10 == 0 ? fmt::format("{}", value / 10)
                           : fmt::format("{}{}.{}", value < 0 ? "-" : "", std::abs(value) / 10, std::abs(value) % 10);
  };
  for (std::size_t i = 1; i < points.size(); ++i) {
    const long next_x = tenths(points[i].x()), next_y = tenths(points[i].y());
    if (i > 1) way += ' ';
    way += written(next_x - x) + ' ' + written(next_y - y);
    x = next_x;
    y = next_y;
  }
  return way;
}

}  // namespace

Box boxAt(double x, double y, double width, double height)
{
  return {Eigen::Vector2d(x, y), Eigen::Vector2d(x + width, y + height)};
}

Paint Paint::line(const std::string& colour, double width, double opacity)
{
  return {"none", colour, width, opacity, {}};
}
Paint Paint::dashed(const std::string& colour, double width, const std::string& dash)
{
  return {"none", colour, width, 1.0, dash};
}
Paint Paint::area(const std::string& colour, double opacity) { return {colour, "none", 1.0, opacity, {}}; }

SvgCanvas::SvgCanvas(double width, double height, const std::string& description)
    : width_(width), height_(height), description_(escaped(description))
{}

void SvgCanvas::path(const Points& points, const Paint& paint)
{
  if (points.size() < 2) return;
  body_ += fmt::format("<path d=\"{}\" {}/>\n", wayOf(points), attributes(paint));
}

void SvgCanvas::polygon(const Points& corners, const Paint& paint)
{
  if (corners.size() < 3) return;
  body_ += fmt::format("<path d=\"{}z\" {}/>\n", wayOf(corners), attributes(paint));
}

void SvgCanvas::box(const Box& box, const Paint& paint)
{
  body_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" {}/>\n", box.min().x(),
                       box.min().y(), box.sizes().x(), box.sizes().y(), attributes(paint));
}

void SvgCanvas::circle(const Eigen::Vector2d& centre, double radius, const Paint& paint, const std::string& tooltip)
{
  const std::string title = tooltip.empty() ? "" : "<title>" + escaped(tooltip) + "</title>";
  body_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.2f}\" {}>{}</circle>\n", centre.x(), centre.y(),
                       radius, attributes(paint), title);
}

void SvgCanvas::text(const Eigen::Vector2d& at, const std::string& words, const Lettering& lettering)
{
  std::string how = fmt::format("font-size=\"{:.4g}\" fill=\"{}\"", lettering.size, lettering.colour);
  if (lettering.anchor != "start") how += fmt::format(" text-anchor=\"{}\"", lettering.anchor);
  if (lettering.weight != "normal") how += fmt::format(" font-weight=\"{}\"", lettering.weight);
  if (lettering.halo) how += " stroke=\"#fff\" stroke-width=\"3\" stroke-opacity=\"0.85\" paint-order=\"stroke\"";
  if (lettering.turned_deg != 0.0)
    how += fmt::format(" transform=\"rotate({:.4g} {:.1f} {:.1f})\"", lettering.turned_deg, at.x(), at.y());
  body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", at.x(), at.y(), how, escaped(words));
}

void SvgCanvas::clip(const Box& box)
{
  // A drawing within the drawing: a clip path would need a name that no other figure of the page has.
  const std::string place =
      fmt::format("{:.1f} {:.1f} {:.1f} {:.1f}", box.min().x(), box.min().y(), box.sizes().x(), box.sizes().y());
  body_ += fmt::format("<svg x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" viewBox=\"{}\">\n",
                       box.min().x(), box.min().y(), box.sizes().x(), box.sizes().y(), place);
}

std::string SvgCanvas::svg() const
{
  return fmt::format(
             "<svg viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" role=\"img\" "
             "aria-label=\"{2}\" stroke-linejoin=\"round\" stroke-linecap=\"butt\">\n",
             width_, height_, description_) +
         body_ + "</svg>\n";
}

Points simplified(const Points& points, double tolerance)
{
  if (points.size() < 3) return points;
  std::vector<bool> kept(points.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [from, to] = open.back();
    open.pop_back();
    double farthest = tolerance;
    std::size_t corner = 0;
    for (std::size_t i = from + 1; i < to; ++i) {
      const double distance = distanceToSegment(points[i], points[from], points[to]);
      if (distance > farthest) {
        farthest = distance;
        corner = i;
      }
    }
    if (corner == 0) continue;
    kept[corner] = true;
    open.emplace_back(from, corner);
    open.emplace_back(corner, to);
  }
  Points result;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (kept[i]) result.push_back(points[i]);
  return result;
}

double widthOf(const std::string& words, double size)
{
  double letters = 0.0;
  for (const char letter : words) {
    if ((static_cast<unsigned char>(letter) & 0xc0U) == 0x80U) continue;  // goes on with a letter of UTF-8
    const bool narrow = kNarrow.find(letter) != std::string_view::npos;
    const bool broad = kBroad.find(letter) != std::string_view::npos;
    letters += narrow ? 0.28 : broad ? 0.78 : 0.55;
  }
  return letters * size;
}

}  // namespace eyeslam::trials
