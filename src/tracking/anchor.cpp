// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/anchor.h"

#include <algorithm>
#include <cmath>

namespace eyeslam::tracking {

namespace {

constexpr double kFarthest_px = 3.0, kFarthestSmeared_px = 16.0;
constexpr double kLeastAnchorNcc = 0.4;

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
}

bool Anchor::isBetterStart(const MaskedContrast& frame, std::int64_t frames_since_start) const
{
  return frames_since_start <= options_.settle_frames && sharpness(frame) > options_.sharper * sharpness_;
}

void Anchor::startAgain(const MaskedContrast& frame, const Mosaic& mosaic, std::int64_t frames_since_start)
{
  smeared_ = true;
  sharpness_ = sharpness(frame);
  goal_ = now_ = {};
  const auto rough = dense_search_.find(mosaic, picture(), {});
  if (!rough) return;  // nothing better is known than that the view stood still
  motion_ = -rough->translation() / static_cast<double>(std::max<std::int64_t>(1, frames_since_start));
  const Refinement found = registerSmeared(mosaic, *rough);
  goal_ = now_ = found.valid && found.ncc > kLeastAnchorNcc ? found.map_T_frame : *rough;
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
  if (found.valid && found.ncc >= kLeastAnchorNcc && moved < (smeared_ ? kFarthestSmeared_px : kFarthest_px))
    goal_ = found.map_T_frame;
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

// The mosaic's template pixels without frame 0's share: M' = (k M - n0) / (k - 1), and the gradient alike, or the noise
// of frame 0 would find itself and hold frame 0 where it is.
void Anchor::collect(const Mosaic& mosaic)
{
  collectTemplate(mosaic, picture(), goal_, template_);
  const Eigen::Vector2d& centre = mosaic.centre();
  for (std::size_t i = 0; i < template_.size(); ++i) {
    const int x = static_cast<int>(std::lround(static_cast<double>(template_.x[i]) + centre.x()));
    const int y = static_cast<int>(std::lround(static_cast<double>(template_.y[i]) + centre.y()));
    const bool inside = x > 0 && y > 0 && x < contrast_.cols - 1 && y < contrast_.rows - 1;
    if (!inside || !picture().isVisible(x, y)) continue;
    const auto k = static_cast<float>(mosaic.count(x, y));
    if (k < 2.0F) continue;
    const std::int16_t *above = contrast_[y - 1] + x, *here = contrast_[y] + x, *below = contrast_[y + 1] + x;
    const int dx = above[1] - above[-1] + 2 * (here[1] - here[-1]) + below[1] - below[-1];
    const int dy = below[-1] - above[-1] + 2 * (below[0] - above[0]) + below[1] - above[1];
    const auto without = [k](float mean, float own) { return (k * mean - own) / (k - 1.0F); };
    template_.value[i] = without(template_.value[i], static_cast<float>(here[0]));
    template_.gx[i] = without(template_.gx[i], 0.125F * static_cast<float>(dx));
    template_.gy[i] = without(template_.gy[i], 0.125F * static_cast<float>(dy));
  }
}

}  // namespace eyeslam::tracking
