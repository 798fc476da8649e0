// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/shaft_axis.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/tracking/steel_end.h"

namespace eyeslam::tracking {

namespace {

constexpr int kSections = 20;
constexpr std::size_t kLeastSections = 5;
constexpr double kLongest_widths = 16.0;  // farther back the light fades
constexpr double kEdgeStride = 2.5;       // steps of the coarse look for an edge
constexpr float kSteelShare = 0.75F;      // blue of the red in the middle of a section; a pale disc has 0.65
constexpr double kBulge = 1.3;            // wider than this, of the median: a bloom lies on the shaft
constexpr double kBeyond_px = 8.0;        // the rough width lacks the mixed cells on both sides
constexpr double kLeastWeight = 2.5;      // of sections, a whole one where the shaft has its full width
constexpr double kCut_sigma = 3.0;
constexpr double kLeastEdgeSigma_px = 0.4;  // edges are not better known: chroma is sampled every other px

double quantile(std::vector<double>& values, double part)
{
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// A weighted line y = offset + slope x.
struct Line {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;

  void add(double weight, double at, double value)
  {
    n += weight;
    x += weight * at;
    y += weight * value;
    xx += weight * at * at;
    xy += weight * at * value;
  }
  double determinant() const { return n * xx - x * x; }
  double slope() const { return (n * xy - x * y) / determinant(); }
  double offset() const { return (y - slope() * x) / n; }
};

}  // namespace

ShaftEdges::ShaftEdges(double share, double bloom)
    : share_(static_cast<float>(share)), bloom_(static_cast<float>(bloom))
{
  sections_.reserve(kSections);
  widths_.reserve(kSections);
  slopes_.reserve(kSections * kSections / 2);
}

std::optional<ShaftAxis> ShaftEdges::refine(const TintSampler& image, const ShaftAxis& rough, double length)
{
  measure(image, rough, length);
  if (sections_.size() < kLeastSections) return std::nullopt;
  return fit(rough, shaftWidth());
}

void ShaftEdges::measure(const TintSampler& image, const ShaftAxis& rough, double length)
{
  sections_.clear();
  const double step = std::min(length, kLongest_widths * rough.width) / kSections;
  const double farthest = rough.width + kBeyond_px;
  const float steel = image.hasColour() ? std::max(kSteelShare, share_) : share_;  // brightness has one threshold only
  for (int i = 0; i < kSections; ++i) {
    const double along = -(i + 0.5) * step;
    const Eigen::Vector2d from = rough.at(along);
    if (!image.contains(from) || image(from).excess(steel) <= 0.0F) continue;
    const double right = edge(image, from, rough.normal(), farthest);
    const double left = edge(image, from, -rough.normal(), farthest);
    if (left < farthest && right < farthest) sections_.push_back({along, (right - left) / 2.0, left + right});
  }
}

double ShaftEdges::edge(const TintSampler& image, const Eigen::Vector2d& from, const Eigen::Vector2d& outwards,
                        double farthest) const
{
  const double step = std::max(1.0, farthest / 40.0);  // about a px of the usual shaft
  const auto profile = [&](double along) { return image(from + along * outwards); };
  double before = 1.0;
  for (double distance = kEdgeStride * step; distance < farthest; distance += kEdgeStride * step) {
    if (!image.contains(from + distance * outwards)) return farthest;  // cut off by the picture: no middle
    const Tint tint = profile(distance);
    if (tint.blue > bloom_) return farthest;
    const double excess = tint.excess(share_);
    if (excess <= 0.0) {
      const double rough = distance + kEdgeStride * step * excess / (before - excess);
      const std::optional<SteelEnd> end = sharpenSteelEnd(profile, rough, step);
      return end ? end->at : rough;
    }
    before = excess;
  }
  return farthest;
}

double ShaftEdges::shaftWidth()
{
  widths_.clear();
  for (const Section& section : sections_) widths_.push_back(section.width);
  const double usual = quantile(widths_, 0.5);
  const auto bulges = [usual](double width) { return width > kBulge * usual; };
  widths_.erase(std::remove_if(widths_.begin(), widths_.end(), bulges), widths_.end());
  return quantile(widths_, 0.75);
}

// Theil's line: half of the sections may be wrong (a bloom covers one edge) before it follows them.
ShaftEdges::Trend ShaftEdges::robustTrend()
{
  slopes_.clear();
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    for (std::size_t j = i + 2; j < sections_.size(); ++j) {
      slopes_.push_back((sections_[j].middle - sections_[i].middle) / (sections_[j].along - sections_[i].along));
    }
  }
  Trend trend;
  trend.slope = quantile(slopes_, 0.5);
  slopes_.clear();
  for (const Section& section : sections_) slopes_.push_back(section.middle - trend.slope * section.along);
  trend.offset = quantile(slopes_, 0.5);
  for (double& residual : slopes_) residual = std::abs(residual - trend.offset);
  trend.sigma = std::max(1.48 * quantile(slopes_, 0.5), kLeastEdgeSigma_px);
  return trend;
}

std::optional<ShaftAxis> ShaftEdges::fit(const ShaftAxis& rough, double width)
{
  const Trend trend = robustTrend();
  Line line;
  double squares = 0.0;
  for (const Section& section : sections_) {
    const double residual = section.middle - trend.at(section.along);
    if (section.width > kBulge * width || std::abs(residual) > kCut_sigma * trend.sigma) continue;
    // Where the shaft tapers, its highlight comes near one edge and draws it inwards.
    const double weight = std::pow(std::min(section.width / width, 1.0), 4.0);
    line.add(weight, section.along, section.middle);
    squares += weight * residual * residual;
  }
  if (line.n < kLeastWeight || line.determinant() <= 1e-6) return std::nullopt;
  ShaftAxis axis = rough;
  axis.origin = rough.at(0.0, line.offset());
  axis.direction = (rough.direction + line.slope() * rough.normal()).normalized();
  axis.width = width;
  const double variance = std::max(squares / line.n, kLeastEdgeSigma_px * kLeastEdgeSigma_px);
  axis.variance = variance * line.xx / line.determinant();
  return axis;
}

}  // namespace eyeslam::tracking
