// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/tip_judge.h"

#include <algorithm>

namespace eyeslam::trials {

namespace {

constexpr double kBack_m = 50e-6;  // issue: under 50 um after a saccade
constexpr double kLookedAt_s = 0.3;
constexpr double kCalm_s = 0.15;  // loop study, section 4: later than 150 ms after fast motion

}  // namespace

TipJudge::TipJudge(double settling_s) : settling_s_(settling_s), recovery_(kBack_m, kLookedAt_s) {}

void TipJudge::step(const Sample& sample)
{
  if (sample.jumping) calm_from_s_ = sample.t_s + kCalm_s;
  if (sample.t_s <= settling_s_) return;
  recovery_.step(sample.t_s, sample.jumping, sample.jumped.x(), sample.jumped.y(), sample.error);
  result_.errors_m.push_back(sample.error);
  result_.calm.push_back(sample.t_s >= calm_from_s_);
  result_.path.push_back(sample.tip);
  if (sample.saturated) saturated_ += 1.0;
}

TipErrors TipJudge::result() const
{
  TipErrors result = result_;
  result.jumps = recovery_.jumps();
  result.saturated_fraction = saturated_ / static_cast<double>(std::max<std::size_t>(result.errors_m.size(), 1));
  return result;
}

}  // namespace eyeslam::trials
