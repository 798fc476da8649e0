// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/scale_evidence.h"

#include <cmath>

namespace eyeslam::tracking {

namespace {

constexpr double kLeastShare = 0.4;  // of the first frame's pixels in view; fewer do not fix a scale well
constexpr double kLeastScaleNcc = 0.4;

}  // namespace

ScaleEvidence::ScaleEvidence(const ScaleEvidenceOptions& options, const RefinerOptions& refiner)
    : options_(options), refiner_(refiner)
{
  first_.reserve(1 << 14);
  seen_.reserve(1 << 14);
}

void ScaleEvidence::start(const MaskedContrast& frame, const Mosaic& mosaic)
{
  collectTemplate(mosaic, frame, {}, first_);
  in_a_row_ = 0;
  magnified_ = false;
}

bool ScaleEvidence::update(const MaskedContrast& frame, const Mosaic& mosaic, const retina::Pose2& map_T_frame,
                           std::int64_t number)
{
  if (magnified_ || number % options_.period != 0) return false;
  selectVisible(first_, frame, map_T_frame, seen_);
  if (static_cast<double>(seen_.size()) < kLeastShare * static_cast<double>(first_.size())) {
    collectTemplate(mosaic, frame, map_T_frame, seen_);
  }
  const Refinement found = refiner_.refine(frame.contrast, seen_, map_T_frame, Freedom::similarity);
  if (!found.valid || found.ncc < kLeastScaleNcc) return false;
  const double change = found.map_T_frame.scale - 1.0;
  const bool significant = std::abs(change) > options_.least_change &&
                           std::abs(change) > options_.sigmas * std::sqrt(found.covariance(3, 3));
  in_a_row_ = significant ? (change * last_change_ > 0.0 ? in_a_row_ + 1 : 1) : 0;
  last_change_ = change;
  magnified_ = in_a_row_ >= options_.in_a_row;
  return magnified_;
}

}  // namespace eyeslam::tracking
