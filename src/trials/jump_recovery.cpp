// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/trials/jump_recovery.h"

#include <cmath>
#include <limits>

namespace eyeslam::trials {

namespace {

constexpr double kBeforeOnset_s = 0.02;  // a frame spoilt so shortly before a jump is missing when it begins

}  // namespace

void JumpRecovery::spoilt(double t_s)
{
  if (open_ && t_s > current_.onset_s - kBeforeOnset_s) current_.whole = false;
}

void JumpRecovery::step(double t_s, bool jumping, double eye_x, double eye_y, double error)
{
  if (jumping && !jumping_) {
    if (open_) {
      current_.disturbed = true;
    } else {
      current_ = {t_s, 0.0, true, false, std::numeric_limits<double>::infinity()};
      open_ = true;
      exceeded_ = back_ = false;
      from_x_ = eye_x;
      from_y_ = eye_y;
    }
  }
  jumping_ = jumping;
  if (!open_) return;
  if (!current_.disturbed) current_.way = std::hypot(eye_x - from_x_, eye_y - from_y_);
  if (error > bound_) exceeded_ = true;
  if (exceeded_ && !back_ && error < bound_ && !jumping) {
    back_ = true;
    current_.recovery_s = t_s - current_.onset_s;
  }
  if (t_s - current_.onset_s < window_s_) return;
  if (!exceeded_) current_.recovery_s = 0.0;
  done_.push_back(current_);
  open_ = false;
}

}  // namespace eyeslam::trials
