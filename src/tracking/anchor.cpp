// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/anchor.h"

#include <algorithm>
#include <cmath>

namespace eyeslam::tracking {

namespace {

constexpr int kBorder_px = 6;
constexpr double kFarthest_px = 3.0;
constexpr double kLeastNcc = 0.4;
constexpr int kCluster_px = 64;
constexpr int kBlockWidth = Mosaic::kBlockWidth, kBlockHeight = Mosaic::kBlockHeight;
constexpr float kLeastGradient = 0.006F * Frame::kContrastUnit;  // per px; source: tracker study 2.14

}  // namespace

Anchor::Anchor(const AnchorOptions& options, const RefinerOptions& refiner, const SmearModelOptions& smear,
               const DenseSearchOptions& dense)
    : options_(options), refiner_(refiner), smear_model_(smear, refiner), dense_search_(dense)
{
  template_.reserve(1 << 14);
}

void Anchor::start(const MaskedContrast& frame)
{
  frame.contrast.copyTo(contrast_);
  frame.hidden.copyTo(hidden_);
  sharpness_ = sharpness(frame);
  smeared_ = false;
  goal_ = now_ = {};
  next_ = options_.first_frame;
  // Touched now, so that the frame of the first registration does not pay for the pages.
  mean_ = cv::Mat_<std::int16_t>::zeros(contrast_.size());
  count_ = cv::Mat_<std::uint8_t>::zeros(contrast_.size());
}

bool Anchor::isBetterStart(const MaskedContrast& frame, std::int64_t frames_since_start) const
{
  return frames_since_start <= options_.settle_frames && sharpness(frame) > options_.sharper * sharpness_;
}

void Anchor::startAgain(const Mosaic& mosaic, std::int64_t frames_since_start)
{
  smeared_ = true;
  sharpness_ /= options_.sharper;
  goal_ = now_ = {};
  const auto rough = dense_search_.find(mosaic, picture(), {});
  if (!rough) return;  // nothing better is known than that the view stood still
  motion_ = -rough->translation() / static_cast<double>(std::max<std::int64_t>(1, frames_since_start));
  const Refinement found = registerSmeared(mosaic, *rough);
  goal_ = now_ = found.valid && found.ncc > kLeastNcc ? found.map_T_frame : *rough;
}

void Anchor::update(const Mosaic& mosaic, std::int64_t frames_since_start)
{
  if (frames_since_start >= next_ && next_ <= options_.last_frame) {
    registerStart(mosaic);
    next_ *= 2;
  }
  const double share = 1.0 / options_.slew_frames;
  now_.x += share * (goal_.x - now_.x);
  now_.y += share * (goal_.y - now_.y);
  now_.theta += share * (goal_.theta - now_.theta);
}

void Anchor::restore(Mosaic& mosaic) const
{
  if (next_ <= options_.first_frame && !smeared_) mosaic.start(picture());
}

void Anchor::registerStart(const Mosaic& mosaic)
{
  const Refinement found = smeared_ ? registerSmeared(mosaic, goal_) : registerSharp(mosaic);
  const double moved = (found.map_T_frame.translation() - goal_.translation()).norm();
  // The last registration is nearly right: a result far off is an error of this one.
  if (found.valid && found.ncc >= kLeastNcc && moved < kFarthest_px) goal_ = found.map_T_frame;
}

Refinement Anchor::registerSharp(const Mosaic& mosaic)
{
  collect(mosaic);
  return refiner_.refine(contrast_, template_, goal_, Freedom::rigid);
}

Refinement Anchor::registerSmeared(const Mosaic& mosaic, const retina::Pose2& from)
{
  collectTemplate(mosaic, picture(), from, template_);
  return smear_model_.refine(mosaic, picture(), template_, from, motion_, Freedom::rigid, 1.0);
}

// The strongest pixel of each block of the mosaic without frame 0's share: M' = (k M - n0) / (k - 1).
void Anchor::collect(const Mosaic& mosaic)
{
  mosaic.read({0, 0, contrast_.cols, contrast_.rows}, mean_, count_);
  for (int y = 0; y < mean_.rows; ++y) {
    for (int x = 0; x < mean_.cols; ++x) {
      const int k = count_(y, x);
      const bool shared = hidden_(y / Frame::kCell, x / Frame::kCell) == OcclusionMask::kVisible;
      if (!shared) continue;
      if (k < 2) {
        count_(y, x) = 0;
      } else {
        mean_(y, x) = static_cast<std::int16_t>((k * mean_(y, x) - contrast_(y, x)) / (k - 1));
      }
    }
  }
  template_.clear();
  for (int cy = 0; cy < mean_.rows; cy += kCluster_px) {
    for (int cx = 0; cx < mean_.cols; cx += kCluster_px) {
      const std::size_t begin = template_.size();
      for (int by = cy; by < std::min(cy + kCluster_px, mean_.rows); by += kBlockHeight) {
        for (int bx = cx; bx < std::min(cx + kCluster_px, mean_.cols); bx += kBlockWidth) pushStrongest(bx, by);
      }
      if (template_.size() > begin) template_.cluster_begins.push_back(begin);
    }
  }
}

void Anchor::pushStrongest(int bx, int by)
{
  float most = kLeastGradient * kLeastGradient, best_gx = 0.0F, best_gy = 0.0F;
  cv::Point best(-1, -1);
  const int right = std::min(bx + kBlockWidth, mean_.cols - kBorder_px);
  const int bottom = std::min(by + kBlockHeight, mean_.rows - kBorder_px);
  for (int y = std::max(by, kBorder_px); y < bottom; ++y) {
    for (int x = std::max(bx, kBorder_px); x < right; ++x) {
      const std::int16_t *above = mean_[y - 1] + x, *here = mean_[y] + x, *below = mean_[y + 1] + x;
      const float gx =
          0.125F * static_cast<float>(above[1] - above[-1] + 2 * (here[1] - here[-1]) + below[1] - below[-1]);
      const float gy =
          0.125F * static_cast<float>(below[-1] - above[-1] + 2 * (below[0] - above[0]) + below[1] - above[1]);
      const float strength = gx * gx + gy * gy;
      if (strength <= most || !isKnown(x, y)) continue;
      most = strength;
      best = {x, y};
      best_gx = gx;
      best_gy = gy;
    }
  }
  if (best.x < 0) return;
  const float centre_x = static_cast<float>(mean_.cols - 1) / 2.0F,
              centre_y = static_cast<float>(mean_.rows - 1) / 2.0F;
  template_.push(static_cast<float>(best.x) - centre_x, static_cast<float>(best.y) - centre_y,
                 static_cast<float>(mean_(best)), best_gx, best_gy);
}

bool Anchor::isKnown(int x, int y) const
{
  if (hidden_(y / Frame::kCell, x / Frame::kCell) != OcclusionMask::kVisible) return false;
  for (int v = y - 1; v <= y + 1; ++v) {
    const std::uint8_t* row = count_[v] + x;
    if (row[-1] == 0 || row[0] == 0 || row[1] == 0) return false;
  }
  return true;
}

}  // namespace eyeslam::tracking
