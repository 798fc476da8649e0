// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/smear_model.h"

#include <algorithm>
#include <cmath>

#include "eyeslam/tracking/cubic_sampler.h"

namespace eyeslam::tracking {

namespace {

constexpr int kSamples = 11;              // along the smear; source: tracker study 2.11
constexpr std::size_t kSearchStride = 4;  // a quarter of the pixels while the extent is sought
constexpr int kSearchSteps = 5;
constexpr double kLongest_px = 200.0;  // of a smear: longer ones hold no detail

RefinerOptions quickOptions(RefinerOptions options)
{
  options.coarse_steps = 0;
  options.most_steps = kSearchSteps;
  return options;
}

}  // namespace

SmearModel::SmearModel(const SmearModelOptions& options, const RefinerOptions& refiner)
    : options_(options), quick_(quickOptions(refiner)), full_(refiner)
{
  smeared_.reserve(1 << 14);
}

Refinement SmearModel::refine(const Mosaic& mosaic, const MaskedContrast& frame, const AlignmentTemplate& sharp,
                              const retina::Pose2& start, const Eigen::Vector2d& motion, Freedom freedom,
                              double scale_sigma)
{
  const double length = motion.norm();
  const Eigen::Vector2d whole = length > kLongest_px ? Eigen::Vector2d(motion * (kLongest_px / length)) : motion;
  const int reach = static_cast<int>(std::ceil(std::min(length, kLongest_px) * 1.2)) + 4;
  region_ = viewBox(frame.size(), start, mosaic.centre());
  region_ = {region_.x - reach, region_.y - reach, region_.width + 2 * reach, region_.height + 2 * reach};
  mosaic_centre_ = mosaic.centre();
  shapeWindow();
  mosaic.read(region_, mean_, count_);

  Refinement best;
  best.map_T_frame = start;
  double best_share = 0.0;
  const auto attempt = [&](double share, double ahead) {
    smear(sharp, share * whole, kSearchStride, smeared_);
    retina::Pose2 from = best.map_T_frame;
    from.x += ahead * share * whole.x();
    from.y += ahead * share * whole.y();
    const Refinement found = quick_.refine(frame.contrast, smeared_, from, freedom, scale_sigma);
    // The robust deviation, not the correlation: blooms and burns leave streaks that outvote the vessels.
    if (!found.valid || (best.valid && found.sigma >= best.sigma)) return false;
    best = found;
    best_share = share;
    return true;
  };
  int worse = 0;
  for (const double share : {0.3, 0.5, 0.7, 1.0, 1.5, 2.0}) {
    worse = attempt(share, 0.0) || !best.valid ? 0 : worse + 1;
    if (worse == 2) break;  // the deviation has one minimum: longer smears are worse still
  }
  if (!best.valid) return best;
  // A sharp template may have caught one end of the smear: look from both.
  for (const double ahead : {-0.3, 0.3}) attempt(best_share, ahead);
  const double centre = best_share;
  for (const double factor : {0.85, 1.15}) attempt(centre * factor, 0.0);
  smear(sharp, best_share * whole, 1, smeared_);
  const Refinement refined = full_.refine(frame.contrast, smeared_, best.map_T_frame, freedom, scale_sigma);
  return refined.valid ? refined : best;
}

// The window's size changes with the motion; planes over storage that only grows allocate nothing in the long run.
void SmearModel::shapeWindow()
{
  const auto cells = static_cast<std::size_t>(region_.area());
  if (mean_store_.size() < cells) mean_store_.resize(cells);
  if (count_store_.size() < cells) count_store_.resize(cells);
  mean_ = cv::Mat_<std::int16_t>(region_.height, region_.width, mean_store_.data());
  count_ = cv::Mat_<std::uint8_t>(region_.height, region_.width, count_store_.data());
}

void SmearModel::smear(const AlignmentTemplate& sharp, const Eigen::Vector2d& extent, std::size_t stride,
                       AlignmentTemplate& smeared) const
{
  smeared.clear();
  const CubicSampler sample(mean_);
  const double from_x = mosaic_centre_.x() - region_.x, from_y = mosaic_centre_.y() - region_.y;
  constexpr float kMargin = CubicSampler::kMargin + 1.0F;
  const auto right = static_cast<float>(region_.width - 1) - kMargin;
  const auto bottom = static_cast<float>(region_.height - 1) - kMargin;
  for (std::size_t c = 0; c < sharp.cluster_begins.size(); ++c) {
    const std::size_t begin = smeared.size();
    for (std::size_t i = sharp.cluster_begins[c]; i < sharp.clusterEnd(c); i += stride) {
      float value = 0.0F, gx = 0.0F, gy = 0.0F;
      bool inside = true;
      for (int k = 0; k < kSamples && inside; ++k) {
        const double along = static_cast<double>(k) / (kSamples - 1) - 0.5;
        const auto x = static_cast<float>(static_cast<double>(sharp.x[i]) + from_x + along * extent.x());
        const auto y = static_cast<float>(static_cast<double>(sharp.y[i]) + from_y + along * extent.y());
        inside = x >= kMargin && y >= kMargin && x <= right && y <= bottom;
        if (!inside) break;
        value += sample(x, y);
        const int ix = static_cast<int>(x + 0.5F), iy = static_cast<int>(y + 0.5F);
        gx += 0.5F * static_cast<float>(mean_(iy, ix + 1) - mean_(iy, ix - 1));
        gy += 0.5F * static_cast<float>(mean_(iy + 1, ix) - mean_(iy - 1, ix));
      }
      constexpr float kShare = 1.0F / kSamples;
      if (inside) smeared.push(sharp.x[i], sharp.y[i], kShare * value, kShare * gx, kShare * gy);
    }
    if (smeared.size() > begin) smeared.cluster_begins.push_back(begin);
  }
}

}  // namespace eyeslam::tracking
