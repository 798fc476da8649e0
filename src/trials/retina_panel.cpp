// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/retina_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "eyeslam/files/markup.h"

namespace eyeslam::trials {

using files::pngAddress;

namespace {

constexpr int kWidest_px = 900;                     // of an embedded picture: twice what the panels of a page have
constexpr double kAround = 0.5e-3;                  // m; light changes over more, vessels over less
constexpr double kPaper[] = {214.0, 226.0, 238.0};  // BGR
constexpr int kSteps = 3;                           // px, over which an outline is smoothed to each side
constexpr std::size_t kShortest = 24;               // places of an outline, at those thirds
constexpr int kFiner = 3;                           // outlines are traced at thirds of a pixel
constexpr const char* kVesselOutline = "stroke=\"#8c2d2d\" stroke-width=\"0.8\" stroke-opacity=\"0.8\"";
constexpr const char* kMarginOutline =
    "stroke=\"#222\" stroke-width=\"0.8\" stroke-opacity=\"0.7\" stroke-dasharray=\"4 3\"";

// Light and even, whatever lit the picture: what is darker than its surroundings, on warm paper. Reds keep more of it,
// so that vessels stay red.
cv::Mat toned(const cv::Mat& bgr, double m_per_px)
{
  cv::Mat picture, around;
  bgr.convertTo(picture, CV_32FC3, 1.0 / 255.0, 0.02);
  const int reach = std::max(3, static_cast<int>(kAround / m_per_px));
  cv::blur(picture, around, {reach, reach}, {-1, -1}, cv::BORDER_REFLECT);
  cv::Mat_<cv::Vec3f> contrast;
  cv::divide(picture, around, contrast);
  cv::Mat_<cv::Vec3b> result(contrast.size());
  std::transform(contrast.begin(), contrast.end(), result.begin(), [](const cv::Vec3f& pixel) {
    const double green = std::clamp(static_cast<double>(pixel[1]), 0.4, 1.25);
    return cv::Vec3b(cv::saturate_cast<std::uint8_t>(kPaper[0] * std::pow(green, 1.1)),
                     cv::saturate_cast<std::uint8_t>(kPaper[1] * std::pow(green, 1.0)),
                     cv::saturate_cast<std::uint8_t>(kPaper[2] * std::pow(green, 0.45)));
  });
  return result;
}

/// A closed curve averaged over some places before and behind each: the steps of pixels go, thin vessels stay.
Points withoutSteps(const std::vector<cv::Point>& curve)
{
  const int count = static_cast<int>(curve.size());
  const int reach = std::min(kSteps * kFiner, (count - 1) / 4);
  Points smooth;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector2d sum(0.0, 0.0);
    for (int k = -reach; k <= reach; ++k) {
      const cv::Point& point = curve[static_cast<std::size_t>((i + k + count) % count)];
      sum += Eigen::Vector2d(point.x, point.y);
    }
    smooth.emplace_back((sum / (2.0 * reach + 1.0) + Eigen::Vector2d(0.5, 0.5)) / kFiner);
  }
  smooth.push_back(smooth.front());
  return smooth;
}

cv::Mat_<std::uint8_t> dilated(const cv::Mat_<std::uint8_t>& mask, double radius_px)
{
  cv::Mat_<float> distance;
  cv::distanceTransform(255 - mask, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::Mat_<std::uint8_t> result;
  cv::compare(distance, radius_px, result, cv::CMP_LE);
  return result;
}

}  // namespace

RetinaBackground::RetinaBackground(const RetinaPicture& picture, const Box& region, double margin, std::string name)
    : name_(std::move(name))
{
  place_.setEmpty();
  if (picture.bgr.empty() || !(picture.m_per_px > 0.0)) return;
  const Eigen::Vector2d from = (region.min() - picture.origin) / picture.m_per_px;
  const Eigen::Vector2d to = (region.max() - picture.origin) / picture.m_per_px;
  const cv::Rect wanted(cv::Point(static_cast<int>(std::floor(from.x())), static_cast<int>(std::floor(from.y()))),
                        cv::Point(static_cast<int>(std::ceil(to.x())) + 1, static_cast<int>(std::ceil(to.y())) + 1));
  const cv::Rect part = wanted & cv::Rect({}, picture.bgr.size());
  if (part.empty()) return;
  size_ = part.size();
  // A pixel's centre has whole coordinates, in SVG its corner has.
  const Eigen::Vector2d corner = picture.origin + picture.m_per_px * Eigen::Vector2d(part.x - 0.5, part.y - 0.5);
  place_ = {corner, corner + picture.m_per_px * Eigen::Vector2d(part.width, part.height)};
  cv::Mat shown = toned(picture.bgr(part), picture.m_per_px);
  if (shown.cols > kWidest_px)
    cv::resize(shown, shown, {kWidest_px, kWidest_px * shown.rows / shown.cols}, 0.0, 0.0, cv::INTER_AREA);
  shapes_ = fmt::format("<image width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" href=\"{}\"/>\n", part.width,
                        part.height, pngAddress(shown));
  if (picture.vessel.size() != picture.bgr.size()) return;
  const cv::Mat_<std::uint8_t> mask = picture.vessel(part).clone();
  if (margin > 0.0) shapes_ += outlines(dilated(mask, margin / picture.m_per_px), kMarginOutline);
  shapes_ += outlines(mask, kVesselOutline);
}

std::string RetinaBackground::outlines(const cv::Mat_<std::uint8_t>& mask, const std::string& how) const
{
  cv::Mat fine;
  cv::resize(mask, fine, {}, kFiner, kFiner, cv::INTER_LINEAR);
  cv::threshold(fine, fine, 127, 255, cv::THRESH_BINARY);
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(fine, contours, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  std::string ways;
  for (const std::vector<cv::Point>& contour : contours) {
    if (contour.size() < kShortest) continue;
    char step = 'M';
    for (const Eigen::Vector2d& corner : simplified(withoutSteps(contour), 0.12)) {
      ways += fmt::format("{}{:.1f} {:.1f}", step, corner.x(), corner.y());
      step = 'L';
    }
    ways += 'z';
  }
  return fmt::format("<path d=\"{}\" fill=\"none\" {} vector-effect=\"non-scaling-stroke\"/>\n", ways, how);
}

std::string RetinaBackground::definition() const
{
  return fmt::format("<symbol id=\"{}\" viewBox=\"0 0 {} {}\" preserveAspectRatio=\"none\">\n{}</symbol>\n", name_,
                     size_.width, size_.height, shapes_);
}

RetinaPanel::RetinaPanel(SvgCanvas& canvas, const Box& plot, const Box& region)
    : canvas_(canvas), plot_(plot), region_(region)
{}

Eigen::Vector2d RetinaPanel::place(const Eigen::Vector2d& retina_m) const
{
  return plot_.min() + pxPerMetre() * (retina_m - region_.min());
}

Points RetinaPanel::places(const Points& retina_m) const
{
  Points result;
  for (const Eigen::Vector2d& point : retina_m) result.push_back(place(point));
  return result;
}

void RetinaPanel::begin(const RetinaBackground& background)
{
  canvas_.box(plot_, Paint::area("#f2f0ee"));
  canvas_.clip(plot_);
  if (background.empty()) return;
  const Eigen::Vector2d from = place(background.place().min()), to = place(background.place().max());
  canvas_.insert(fmt::format("<use href=\"#{}\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"/>\n",
                             background.name(), from.x(), from.y(), to.x() - from.x(), to.y() - from.y()));
}

void RetinaPanel::scaleBar()
{
  const double wanted_um = 1e6 * region_.sizes().x() / 5.0;
  const double decade = std::pow(10.0, std::floor(std::log10(wanted_um)));
  const double lead = wanted_um / decade;
  const double um = decade * (lead >= 5.0 ? 5.0 : lead >= 2.0 ? 2.0 : 1.0);
  const double length = 1e-6 * um * pxPerMetre();
  const Eigen::Vector2d right = plot_.max() - Eigen::Vector2d(14.0, 14.0);
  const Eigen::Vector2d left = right - Eigen::Vector2d(length, 0.0);
  canvas_.line(left, right, Paint::line("#fff", 6.0, 0.85));
  canvas_.line(left, right, Paint::line("#111", 3.0));
  Lettering lettering{12.0, "middle"};
  lettering.halo = true;
  canvas_.text(0.5 * (left + right) - Eigen::Vector2d(0.0, 7.0), fmt::format("{:.0f} \u00b5m", um), lettering);
}

void RetinaPanel::finish(const std::string& title)
{
  scaleBar();
  canvas_.unclip();
  canvas_.box(plot_, Paint::line("#555"));
  Lettering lettering{13.0};
  lettering.weight = "600";
  canvas_.text(plot_.min() - Eigen::Vector2d(0.0, 8.0), title, lettering);
}

Box grownTo(const Box& region, double width_by_height, double least)
{
  const Eigen::Vector2d centre = region.isEmpty() ? Eigen::Vector2d(0.0, 0.0) : Eigen::Vector2d(region.center());
  Eigen::Vector2d size = region.isEmpty() ? Eigen::Vector2d(0.0, 0.0) : Eigen::Vector2d(region.sizes());
  size.x() = std::max({size.x(), width_by_height * size.y(), least});
  size.y() = size.x() / width_by_height;
  return {centre - 0.5 * size, centre + 0.5 * size};
}

}  // namespace eyeslam::trials
