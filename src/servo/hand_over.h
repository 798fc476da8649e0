// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/retina/options.h"
#include "eyeslam/retina/smoothstep.h"

namespace eyeslam::servo {

struct HandOverOptions {
  double ramp_ms = 150.0;

  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& visitor)
  {
    visitor.field("ramp_ms", self.ramp_ms, retina::Range{100.0, 200.0}, "ms",
                  "from guidance to tremor cancelling and back; source: issue of the servo loop, 100 to 200 ms");
  }
};

/// How much of the guidance counts: 0 = tremor cancelling alone, 1 = the fixture. It never steps.
class HandOver {
 public:
  explicit HandOver(const HandOverOptions& options = {}) : rate_(1e3 / options.ramp_ms) {}

  /// @param dt  s since the last call; what is not positive and finite leaves the share as it is
  double update(bool guides, double dt);
  /// [0, 1], with a slope of zero at both ends.
  double share() const { return retina::smoothstep(progress_); }

 private:
  double rate_;
  double progress_ = 0.0;
};

}  // namespace eyeslam::servo
