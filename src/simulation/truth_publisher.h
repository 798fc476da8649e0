// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>

#include "eyeslam/messaging/link.h"
#include "eyeslam/retina/pose2.h"
#include "eyeslam/simulation/frame_shutter.h"
#include "eyeslam/simulation/hardware.h"
#include "eyeslam/truth_t.hpp"

namespace eyeslam::simulation {

/// TRUTH: how everything really is, for logs and scores; whoever works in the loop must not listen.
class TruthPublisher {
 public:
  /// @param link  must outlive it
  TruthPublisher(messaging::Link& link, double um_per_px);

  /// A frame's exposure is over; its pose is told from now on.
  void expose(const FrameDue& due);
  void publish(const HardwareTruth& truth, std::int64_t utime);

 private:
  messaging::Publisher<truth_t> truths_;
  truth_t message_{};
};

}  // namespace eyeslam::simulation
