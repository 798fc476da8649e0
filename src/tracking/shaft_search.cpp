// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/shaft_search.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/retina/vector_kernel.h"

namespace eyeslam::tracking {

namespace {

constexpr double kLeastLevel = 0.08;  // of the median red: darker cells have no colour, only noise
constexpr int kLeastBlue = 12;
constexpr int kNear = 2;  // cells between the region and the outside: the field's edge is soft
constexpr double kLeastCells = 4.0;
constexpr double kLeastLength = 3.0;  // cells
constexpr double kLeastElongation = 1.6;
constexpr double kLeastElongationGrey = 5.0;  // the shine is a thin line; brightly lit retina is as bright
constexpr double kEnd = 1.5;                  // cells of each end that are asked whether they come in from outside
constexpr int kTrims = 4;

struct Levels {
  int share = 0;  // 256 times blue's share of the red
  int least = 0;
};

EYESLAM_VECTOR_KERNEL void classifyRow(const std::uint8_t* red, const std::uint8_t* blue, int count, Levels levels,
                                       std::uint8_t* kinds)
{
  for (int i = 0; i < count; ++i) {
    const bool steel = 256 * blue[i] > levels.share * red[i] && blue[i] > levels.least;
    const bool outside = red[i] <= Frame::kBlack;
    kinds[i] = static_cast<std::uint8_t>(steel     ? ShaftSearch::kTool
                                         : outside ? ShaftSearch::kOutside
                                                   : ShaftSearch::kRetina);
  }
}

/// Sums over the cells near an axis.
struct Moments {
  double count = 0.0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();

  void add(const Eigen::Vector2d& at)
  {
    count += 1.0;
    sum += at;
    squares += at * at.transpose();
  }
  Eigen::Vector2d mean() const { return sum / count; }
  Eigen::Vector2d majorAxis() const
  {
    const Eigen::Matrix2d spread = squares / count - mean() * mean().transpose();
    const double angle = 0.5 * std::atan2(2.0 * spread(0, 1), spread(0, 0) - spread(1, 1));
    return {std::cos(angle), std::sin(angle)};
  }
};

struct Extent {
  double lowest = 1e9;
  double highest = -1e9;
  double count = 0.0;

  void add(double along)
  {
    lowest = std::min(lowest, along);
    highest = std::max(highest, along);
    count += 1.0;
  }
  double length() const { return highest - lowest + 1.0; }
  double width() const { return count / length(); }
};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

Eigen::Vector2d place(cv::Point cell) { return {static_cast<double>(cell.x), static_cast<double>(cell.y)}; }

}  // namespace

std::optional<Shaft> ShaftSearch::find(const Frame& frame, const OcclusionMask& mask)
{
  classify(frame, mask);
  least_elongation_ = frame.isGrey() ? kLeastElongationGrey : kLeastElongation;
  members_.clear();
  members_.reserve(kinds_.total());
  std::optional<Shaft> longest;
  for (int row = 0; row < kinds_.rows; ++row) {
    const std::uint8_t* begin = kinds_[row];
    const std::uint8_t* end = begin + kinds_.cols;
    for (const std::uint8_t* at = begin; (at = std::find(at, end, kTool)) != end; ++at) {
      const std::optional<Shaft> shaft = fit(collect(static_cast<int>(at - begin), row));
      if (shaft && (!longest || shaft->length > longest->length)) longest = shaft;
    }
  }
  if (!longest) return longest;
  const Eigen::Vector2d in_frame = longest->end * Frame::kCell + Eigen::Vector2d::Constant((Frame::kCell - 1) / 2.0);
  longest->end = frame.centreInImage() + frame.pixelSize().cwiseProduct(in_frame - frame.centre());
  const double cell_px = Frame::kCell * frame.pixelSize().mean();
  longest->length *= cell_px;
  longest->width *= cell_px;
  return longest;
}

void ShaftSearch::classify(const Frame& frame, const OcclusionMask& mask)
{
  // Without colour red is blue: brightness alone decides.
  const Levels levels = frame.isGrey() ? Levels{0, static_cast<int>(bright_share_ * mask.medianRed())}
                                       : Levels{static_cast<int>(grey_share_ * 256.0),
                                                std::max(kLeastBlue, static_cast<int>(kLeastLevel * mask.medianRed()))};
  kinds_.create(frame.cellRed().rows, frame.cellRed().cols);
  for (int row = 0; row < kinds_.rows; ++row) {
    classifyRow(frame.cellRed()[row], frame.cellBlue()[row], kinds_.cols, levels, kinds_[row]);
  }
}

bool ShaftSearch::touchesOutside(int column, int row) const
{
  for (int y = row - kNear; y <= row + kNear; ++y) {
    for (int x = column - kNear; x <= column + kNear; ++x) {
      if (y < 0 || x < 0 || y >= kinds_.rows || x >= kinds_.cols) return true;
      if (kinds_(y, x) == kOutside) return true;
    }
  }
  return false;
}

ShaftSearch::Region ShaftSearch::collect(int column, int row)
{
  Region region{members_.size(), members_.size()};
  members_.emplace_back(column, row);
  kinds_(row, column) = kTaken;
  for (std::size_t next = region.first; next < members_.size(); ++next) {
    const cv::Point at = members_[next];
    for (int y = std::max(0, at.y - 1); y <= std::min(kinds_.rows - 1, at.y + 1); ++y) {
      for (int x = std::max(0, at.x - 1); x <= std::min(kinds_.cols - 1, at.x + 1); ++x) {
        if (kinds_(y, x) != kTool) continue;
        kinds_(y, x) = kTaken;
        members_.emplace_back(x, y);
      }
    }
  }
  region.last = members_.size();
  return region;
}

std::optional<Shaft> ShaftSearch::fit(Region region)
{
  if (static_cast<double>(region.last - region.first) < kLeastCells) return std::nullopt;
  Eigen::Vector2d centre, axis;
  Extent extent;
  double reach = 1e9;  // cells farther from the axis belong to a bloom beside the shaft
  for (int trim = 0; trim < kTrims; ++trim) {
    Moments moments;
    const auto isNear = [&](cv::Point cell) { return std::abs(cross(axis, place(cell) - centre)) <= reach; };
    for (std::size_t i = region.first; i < region.last; ++i) {
      if (trim == 0 || isNear(members_[i])) moments.add(place(members_[i]));
    }
    if (moments.count < kLeastCells) return std::nullopt;
    centre = moments.mean();
    axis = moments.majorAxis();
    extent = Extent();
    for (std::size_t i = region.first; i < region.last; ++i) {
      if (isNear(members_[i])) extent.add(axis.dot(place(members_[i]) - centre));
    }
    reach = 0.75 * extent.width() + 0.5;
  }
  if (extent.length() < kLeastLength || extent.length() < least_elongation_ * extent.width()) return std::nullopt;
  bool low = false, high = false;  // which end comes in from outside
  for (std::size_t i = region.first; i < region.last; ++i) {
    const double along = axis.dot(place(members_[i]) - centre);
    if (!low && along < extent.lowest + kEnd) low = touchesOutside(members_[i].x, members_[i].y);
    if (!high && along > extent.highest - kEnd) high = touchesOutside(members_[i].x, members_[i].y);
  }
  if (low == high) return std::nullopt;  // it lies within, or crosses the whole view: no tip
  const Eigen::Vector2d direction = low ? axis : Eigen::Vector2d(-axis);
  return Shaft{centre + axis * (low ? extent.highest : extent.lowest), direction, extent.length(), extent.width()};
}

}  // namespace eyeslam::tracking
