// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/vector_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "eyeslam/files/markup.h"
#include "eyeslam/retina/units.h"
#include "eyeslam/tracking/sub_pixel.h"

namespace eyeslam::files {

namespace {

using tracking::kSubPixelBits;

constexpr double kCapital_px = 21.0;  // height of a capital of OpenCV's font at size 1
constexpr int kCircleCorners = 24;
constexpr int kJpegQuality = 90;

std::string hex(const cv::Scalar& bgr)
{
  return fmt::format("#{:02x}{:02x}{:02x}", cvRound(bgr[2]), cvRound(bgr[1]), cvRound(bgr[0]));
}

cv::Point fixedPoint(const cv::Point2d& point, double scale)
{
  // The background's pixel centres keep their places when it grows about its corner.
  const double unit = scale * (1 << kSubPixelBits);
  const double half = 0.5 * (scale - 1.0) * (1 << kSubPixelBits);
  return {cvRound(point.x * unit + half), cvRound(point.y * unit + half)};
}

}  // namespace

void VectorPicture::line(std::vector<cv::Point2d> points, const Ink& ink)
{
  if (points.size() < 2) return;
  if (!clip_.empty() && std::find(clips_.begin(), clips_.end(), clip_) == clips_.end()) clips_.push_back(clip_);
  shapes_.emplace_back(Line{std::move(points), false, ink, clip_});
}

void VectorPicture::arrow(cv::Point2d from, cv::Point2d to, const Ink& ink)
{
  const cv::Point2d way = to - from;
  const double length = std::hypot(way.x, way.y);
  if (!(length > 0.0)) return;
  const cv::Point2d along = way / length;
  const cv::Point2d across(-along.y, along.x);
  const double head = std::min(3.5 * ink.width_px + 1.5, 0.6 * length);
  const cv::Point2d neck = to - head * along;
  line({from, neck}, ink);
  line({to, neck + 0.45 * head * across, neck - 0.45 * head * across, to}, ink);
  std::get<Line>(shapes_.back()).filled = true;
}

void VectorPicture::disc(cv::Point2d centre, double radius_px, const Ink& ink)
{
  std::vector<cv::Point2d> corners;
  corners.reserve(kCircleCorners + 1);
  for (int i = 0; i <= kCircleCorners; ++i) {
    const double angle = kTwoPi * i / kCircleCorners;
    corners.push_back(centre + radius_px * cv::Point2d(std::cos(angle), std::sin(angle)));
  }
  line(std::move(corners), ink);
  std::get<Line>(shapes_.back()).filled = true;
}

void VectorPicture::rectangle(cv::Rect2d area, const Ink& ink)
{
  const cv::Point2d a = area.tl();
  const cv::Point2d b = area.br();
  line({a, {b.x, a.y}, b, {a.x, b.y}, a}, ink);
}

void VectorPicture::words(const std::string& text, cv::Point2d at, double height_px, const Ink& ink)
{
  shapes_.emplace_back(Words{text, at, height_px, ink});
}

std::string VectorPicture::svgOf(const Line& line) const
{
  std::string points;
  for (const cv::Point2d& point : line.points) points += fmt::format("{:.2f},{:.2f} ", point.x, point.y);
  std::string how = line.filled
                        ? fmt::format("fill=\"{}\" fill-opacity=\"{:.2f}\"", hex(line.ink.colour), line.ink.opacity)
                        : fmt::format("fill=\"none\" stroke=\"{}\" stroke-opacity=\"{:.2f}\" stroke-width=\"{:.2f}\"",
                                      hex(line.ink.colour), line.ink.opacity, line.ink.width_px);
  const auto clip = std::find(clips_.begin(), clips_.end(), line.clip);
  if (clip != clips_.end()) how += fmt::format(" clip-path=\"url(#clip{})\"", clip - clips_.begin());
  points.pop_back();
  return fmt::format("<polyline points=\"{}\" {}/>\n", points, how);
}

std::string VectorPicture::svgOf(const Words& words)
{
  return fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{:.1f}\" fill=\"{}\" fill-opacity=\"{:.2f}\">{}</text>\n",
      words.at.x, words.at.y, words.height_px / 0.72, hex(words.ink.colour), words.ink.opacity, escaped(words.text));
}

std::string VectorPicture::svg() const
{
  std::vector<unsigned char> jpeg;
  cv::imencode(".jpg", background_, jpeg, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  const int width = background_.cols;
  const int height = background_.rows;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"Helvetica, Arial, sans-serif\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n",
      width, height);
  svg +=
      fmt::format("<image width=\"{}\" height=\"{}\" href=\"{}\"/>\n", width, height, dataAddress("image/jpeg", jpeg));
  for (std::size_t i = 0; i < clips_.size(); ++i) {
    svg += fmt::format("<clipPath id=\"clip{}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n", i,
                       clips_[i].x, clips_[i].y, clips_[i].width, clips_[i].height);
  }
  // A pixel's centre has whole coordinates (contracts, section 1), in SVG its corner has.
  svg += "<g transform=\"translate(0.5 0.5)\">\n";
  for (const auto& shape : shapes_) {
    svg += std::holds_alternative<Line>(shape) ? svgOf(std::get<Line>(shape)) : svgOf(std::get<Words>(shape));
  }
  return svg + "</g>\n</svg>\n";
}

void VectorPicture::draw(const Line& line, double scale, cv::Mat& picture)
{
  std::vector<cv::Point> points;
  points.reserve(line.points.size());
  for (const cv::Point2d& point : line.points) points.push_back(fixedPoint(point, scale));
  const int width = std::max(1, cvRound(line.ink.width_px * scale));
  cv::Rect touched = cv::boundingRect(points);
  const int margin = width + 2;
  touched = {(touched.x >> kSubPixelBits) - margin, (touched.y >> kSubPixelBits) - margin,
             (touched.width >> kSubPixelBits) + 2 * margin, (touched.height >> kSubPixelBits) + 2 * margin};
  cv::Rect shown({}, picture.size());
  if (!line.clip.empty()) {
    shown &= cv::Rect(cvRound(line.clip.x * scale), cvRound(line.clip.y * scale), cvRound(line.clip.width * scale),
                      cvRound(line.clip.height * scale));
  }
  touched &= shown;
  if (touched.empty()) return;
  for (cv::Point& point : points) point -= cv::Point(touched.x << kSubPixelBits, touched.y << kSubPixelBits);
  cv::Mat below = picture(touched);
  cv::Mat drawn = below.clone();
  if (line.filled) {
    cv::fillPoly(drawn, std::vector<std::vector<cv::Point>>{points}, line.ink.colour, cv::LINE_AA, kSubPixelBits);
  } else {
    cv::polylines(drawn, std::vector<std::vector<cv::Point>>{points}, false, line.ink.colour, width, cv::LINE_AA,
                  kSubPixelBits);
  }
  cv::addWeighted(drawn, line.ink.opacity, below, 1.0 - line.ink.opacity, 0.0, below);
}

void VectorPicture::draw(const Words& words, double scale, cv::Mat& picture)
{
  const cv::Point at(cvRound(words.at.x * scale), cvRound(words.at.y * scale));
  const double size = words.height_px * scale / kCapital_px;
  cv::putText(picture, words.text, at, cv::FONT_HERSHEY_SIMPLEX, size, words.ink.colour,
              std::max(1, cvRound(1.9 * size)), cv::LINE_AA);
}

cv::Mat VectorPicture::pixels(double scale) const
{
  cv::Mat picture;
  cv::resize(background_, picture, {}, scale, scale, scale > 1.0 ? cv::INTER_CUBIC : cv::INTER_AREA);
  for (const auto& shape : shapes_) std::visit([&](const auto& it) { draw(it, scale, picture); }, shape);
  return picture;
}

}  // namespace eyeslam::files
