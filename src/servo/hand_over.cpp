// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/hand_over.h"

#include <algorithm>
#include <cmath>

namespace eyeslam::servo {

double HandOver::update(bool guides, double dt)
{
  if (std::isfinite(dt) && dt > 0.0) progress_ = std::clamp(progress_ + (guides ? rate_ : -rate_) * dt, 0.0, 1.0);
  return share();
}

}  // namespace eyeslam::servo
