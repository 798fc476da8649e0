// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/published_map.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>

namespace eyeslam::tracking {

namespace {

constexpr int kMapBlock = MapVesselDetector::kBlock;
constexpr int kSeenStep = 4;  // cells: views are counted for squares of them
static_assert(kMapBlock % Mosaic::kTile == 0 && kMapBlock % kSeenStep == 0);

std::uint32_t rowsBlended(const Mosaic& mosaic, const cv::Rect& region)
{
  std::uint32_t rows = 0;
  constexpr int kTile = Mosaic::kTile;
  for (int ty = floorDivide(region.y, kTile); ty <= floorDivide(region.br().y - 1, kTile); ++ty) {
    for (int tx = floorDivide(region.x, kTile); tx <= floorDivide(region.br().x - 1, kTile); ++tx) {
      if (const Mosaic::Tile* tile = mosaic.tiles().find(tx, ty)) rows += tile->version;
    }
  }
  return rows;
}

cv::Rect wholeBlocks(const cv::Rect& cells)
{
  const cv::Point from(floorDivide(cells.x, kMapBlock), floorDivide(cells.y, kMapBlock));
  const cv::Point to(floorDivide(cells.br().x - 1, kMapBlock) + 1, floorDivide(cells.br().y - 1, kMapBlock) + 1);
  return {from * kMapBlock, to * kMapBlock};
}

template <class Value>
void enlarge(std::vector<Value>& grid, const cv::Rect& from, const cv::Rect& to)
{
  std::vector<Value> grown(static_cast<std::size_t>(to.area()));
  for (int y = 0; y < from.height; ++y) {
    const auto* row = grid.data() + static_cast<std::ptrdiff_t>(y) * from.width;
    std::copy_n(row, from.width,
                grown.data() + static_cast<std::ptrdiff_t>(y + from.y - to.y) * to.width + from.x - to.x);
  }
  grid = std::move(grown);
}

template <class Value>
void enlarge(cv::Mat_<Value>& grid, const cv::Rect& from, const cv::Rect& to, Value empty)
{
  cv::Mat_<Value> grown(to.height, to.width, empty);
  if (!from.empty()) grid.copyTo(grown(from - to.tl()));
  grid = grown;
}

// Of what is wanted, as much as may be had without giving up what is there.
cv::Range limited(const cv::Range& there, const cv::Range& wanted)
{
  constexpr int kMost = PublishedMap::kLargestSide;
  static_assert(kMost % kMapBlock == 0);
  if (wanted.size() <= kMost) return wanted;
  if (there.empty()) return {wanted.start, wanted.start + kMost};
  const int start = std::max(wanted.start, there.end - kMost);
  return {start, std::min(wanted.end, start + kMost)};
}

cv::Rect inBlocks(const cv::Rect& cells)
{
  return {floorDivide(cells.x, kMapBlock), floorDivide(cells.y, kMapBlock), cells.width / kMapBlock,
          cells.height / kMapBlock};
}

}  // namespace

PublishedMap::PublishedMap(const PublishedMapOptions& options) : options_(options)
{
  const double unit = MapVesselDetector::kLogOddsUnit;
  const double threshold = std::round(options_.threshold_log_odds * unit);
  for (int i = 0; i < 256; ++i) {
    // The threshold itself is 128; odds are kept in whole steps, so that both sides of it are told apart.
    const double above = (i - 128 - threshold) / unit;
    const auto value = static_cast<int>(std::round(255.0 / (1.0 + std::exp(-above))));
    probability_[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(above < 0.0 ? std::min(value, 127) : value);
  }
  probability_[0] = 0;  // never seen
}

void PublishedMap::start(double px_per_cell)
{
  const PublishedMapOptions options = options_;
  *this = PublishedMap(options);
  map_.px_per_cell = px_per_cell;
}

void PublishedMap::grow(const cv::Rect& wanted)
{
  const cv::Rect whole = wholeBlocks(wanted);
  const cv::Rect all = cells_.empty() ? whole : (cells_ | whole);
  const cv::Range columns = limited({cells_.x, cells_.br().x}, {all.x, all.br().x});
  const cv::Range rows = limited({cells_.y, cells_.br().y}, {all.y, all.br().y});
  const cv::Rect to(columns.start, rows.start, columns.size(), rows.size());
  cut_off_ = cut_off_ || to != all;
  if (to == cells_) return;
  enlarge(states_, inBlocks(cells_), inBlocks(to));
  enlarge(map_.probability, cells_, to);
  enlarge(map_.calibre_px, cells_, to);
  enlarge(map_.seen, cells_, to);
  enlarge(log_odds_, cells_, to, MapVesselDetector::kNeverSeen);
  enlarge(calibre_, cells_, to, std::uint8_t{0});
  cells_ = to;
  map_.width = to.width;
  map_.height = to.height;
  ++map_.version;
  place();
}

void PublishedMap::observe(const OcclusionMask& mask, const cv::Size& frame, const Eigen::Vector2d& mosaic_centre,
                           const retina::Pose2& mosaic_T_frame)
{
  const cv::Rect seen_now = viewBox(frame, mosaic_T_frame, mosaic_centre);
  grow(seen_now);
  const cv::Rect view = seen_now & cells_;
  mosaic_centre_ = mosaic_centre;
  const retina::Pose2 frame_T_mosaic = mosaic_T_frame.inverse();
  const Eigen::Vector2d frame_centre((frame.width - 1) / 2.0, (frame.height - 1) / 2.0);
  const Eigen::Vector2d step = kSeenStep * frame_T_mosaic.linear().col(0);
  for (int y = floorDivide(view.y, kSeenStep) * kSeenStep; y < view.br().y; y += kSeenStep) {
    const int first = floorDivide(view.x, kSeenStep) * kSeenStep;
    constexpr double kMiddle = (kSeenStep - 1) / 2.0;
    Eigen::Vector2d at =
        frame_T_mosaic * (Eigen::Vector2d(first + kMiddle, y + kMiddle) - mosaic_centre) + frame_centre;
    for (int x = first; x < view.br().x; x += kSeenStep, at += step) {
      if (!mask.isVisible(static_cast<int>(std::floor(at.x() + 0.5)), static_cast<int>(std::floor(at.y() + 0.5))))
        continue;
      std::uint8_t* seen = map_.seen.data() + map_.index(x - cells_.x, y - cells_.y);
      const auto count = static_cast<std::uint8_t>(std::min(255, *seen + 1));
      for (int row = 0; row < kSeenStep; ++row) std::fill_n(seen + row * map_.width, kSeenStep, count);
    }
  }
}

PublishedMap::BlockState& PublishedMap::state(const cv::Point& at)
{
  return states_[static_cast<std::size_t>((at.y - floorDivide(cells_.y, kMapBlock)) * (cells_.width / kMapBlock) +
                                          at.x - floorDivide(cells_.x, kMapBlock))];
}

const PublishedMap::BlockState& PublishedMap::state(const cv::Point& at) const
{
  return const_cast<PublishedMap*>(this)->state(at);
}

PublishedMap::BlockState PublishedMap::stateNow(const Mosaic& mosaic, const cv::Point& at) const
{
  BlockState now;
  now.looked_at = true;
  const cv::Rect block = MapVesselDetector::block(at);
  now.rows = rowsBlended(mosaic, block);
  now.region_rows = rowsBlended(mosaic, MapVesselDetector::region(at));
  constexpr int kTile = Mosaic::kTile;
  for (int ty = block.y / kTile; ty < block.br().y / kTile; ++ty) {
    for (int tx = block.x / kTile; tx < block.br().x / kTile; ++tx) {
      const Mosaic::Tile* tile = mosaic.tiles().find(tx, ty);
      if (!tile) continue;
      for (const std::uint8_t count : tile->count) {
        now.samples += count;
        now.known += count > 0;
      }
    }
  }
  return now;
}

// How far the mosaic went beyond what a block was made from; from 1 on it is looked at again.
double PublishedMap::urgency(const Mosaic& mosaic, const cv::Point& at) const
{
  const BlockState& then = state(at);
  const std::uint32_t rows = rowsBlended(mosaic, MapVesselDetector::block(at)) - then.rows;
  if (rows == 0) return 0.0;
  const BlockState now = stateNow(mosaic, at);
  constexpr double kArea = kMapBlock * kMapBlock;
  // A strip at the end of what was seen counts by its own size, or vessels there would wait for long.
  const double area = (now.known - then.known) / (options_.renewal_area * std::max<double>(then.known, kArea / 4.0));
  if (!then.looked_at) return 1e6 + area;
  const double samples =
      (static_cast<double>(now.samples) / std::max(1U, then.samples) - 1.0) / options_.renewal_samples;
  return std::max({area, samples, static_cast<double>(rows) / options_.renewal_rows});
}

std::optional<cv::Point> PublishedMap::mostUrgent(const Mosaic& mosaic)
{
  std::optional<cv::Point> found;
  double most = 1.0;
  const cv::Rect blocks = inBlocks(cells_);
  for (int y = blocks.y; y < blocks.br().y; ++y) {
    for (int x = blocks.x; x < blocks.br().x; ++x) {
      const double urgent = urgency(mosaic, {x, y});
      if (urgent < most || (found && urgent == most)) continue;
      most = urgent;
      found = cv::Point(x, y);
    }
  }
  return found;
}

void PublishedMap::begin(const Mosaic& mosaic, const cv::Point& at)
{
  state(at) = stateNow(mosaic, at);
  detector_.begin(mosaic, at);
}

void PublishedMap::slice(const Mosaic& mosaic)
{
  if (mosaic.empty()) return;
  grow(mosaic.bounds());
  constexpr std::int64_t kMillion = 1000000;
  for (std::int64_t left = kMillion * options_.slice_work; left > 0;) {
    if (!detector_.isBusy()) {
      const std::optional<cv::Point> next = mostUrgent(mosaic);
      if (!next) return;
      begin(mosaic, *next);
    }
    left -= static_cast<std::int64_t>(detector_.step());
    if (detector_.isDone()) finishBlock();
  }
}

void PublishedMap::finish(const Mosaic& mosaic)
{
  if (mosaic.empty()) return;
  grow(mosaic.bounds());
  const auto complete = [&] {
    while (detector_.step() > 0) {
    }
    if (detector_.isDone()) finishBlock();
  };
  complete();  // what a slice began
  const cv::Rect blocks = inBlocks(cells_);
  for (int y = blocks.y; y < blocks.br().y; ++y) {
    for (int x = blocks.x; x < blocks.br().x; ++x) {
      const cv::Point at(x, y);
      if (rowsBlended(mosaic, MapVesselDetector::region(at)) == state(at).region_rows) continue;
      begin(mosaic, at);
      complete();
    }
  }
}

void PublishedMap::finishBlock()
{
  const cv::Rect cells = MapVesselDetector::block(detector_.at());
  const cv::Rect inside = cells - cells_.tl();
  detector_.finish(map_.px_per_cell, log_odds_(inside), calibre_(inside));
  // A piece at the block's edge may have become long enough, or too short, in the blocks around it too.
  const int reach = options_.least_length;
  publish((inside + cv::Size(2 * reach, 2 * reach) - cv::Point(reach, reach)) & cv::Rect({}, cells_.size()));
}

void PublishedMap::publish(const cv::Rect& cells)
{
  // Within this reach of `cells` every piece is either whole or long enough, so the answer is that of the whole map.
  const int reach = options_.least_length;
  const cv::Rect around =
      (cells + cv::Size(2 * reach, 2 * reach) - cv::Point(reach, reach)) & cv::Rect({}, cells_.size());
  const auto threshold = static_cast<int>(std::round(options_.threshold_log_odds * MapVesselDetector::kLogOddsUnit));
  cv::compare(log_odds_(around), threshold, claimed_, cv::CMP_GE);
  cv::connectedComponentsWithStats(claimed_, labels_, extents_, centroids_, 8, CV_32S);
  bool changed = false;
  for (int y = cells.y; y < cells.br().y; ++y) {
    const int* label = labels_.ptr<int>(y - around.y) + (cells.x - around.x);
    std::size_t to = map_.index(cells.x, y);
    for (int x = cells.x; x < cells.br().x; ++x, ++to, ++label) {
      const int* extent = extents_.ptr<int>(*label);
      const bool vessel = *label > 0 && std::max(extent[cv::CC_STAT_WIDTH], extent[cv::CC_STAT_HEIGHT]) >= reach;
      const std::uint8_t odds = probability_[static_cast<std::size_t>(log_odds_(y, x) + 128)];
      const std::uint8_t probability = vessel ? odds : std::min(odds, std::uint8_t{127});
      const std::uint8_t calibre = vessel ? calibre_(y, x) : std::uint8_t{0};
      changed |= map_.probability[to] != probability || map_.calibre_px[to] != calibre;
      map_.probability[to] = probability;
      map_.calibre_px[to] = calibre;
    }
  }
  if (changed) ++map_.version;
}

void PublishedMap::moveTo(const retina::Pose2& map_T_mosaic, const Eigen::Vector2d& mosaic_centre)
{
  map_T_mosaic_ = map_T_mosaic;
  mosaic_centre_ = mosaic_centre;
  place();
}

// Mosaic px i has its centre at (i + 0.5) px_per_cell - 0.5 full px of frame 0.
void PublishedMap::place()
{
  const Eigen::Vector2d first(cells_.x, cells_.y);
  const Eigen::Vector2d middle = first + 0.5 * Eigen::Vector2d(cells_.width - 1, cells_.height - 1) - mosaic_centre_;
  const Eigen::Vector2d shifted = first + (map_T_mosaic_ * middle - middle);
  map_.origin_x = (shifted.x() + 0.5) * map_.px_per_cell - 0.5;
  map_.origin_y = (shifted.y() + 0.5) * map_.px_per_cell - 0.5;
}

}  // namespace eyeslam::tracking
