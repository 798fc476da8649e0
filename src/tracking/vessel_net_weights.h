// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

namespace eyeslam::tracking {

/// One layer of VesselNet as stored: weights of 8 bit as base64, ordered output, input, tap (3x3, row by row, or one
/// tap for a join), each output with its own step; weight = step x stored value.
struct StoredLayer {
  int inputs;
  int outputs;
  int taps;
  const float* steps;   ///< one an output
  const float* bias;    ///< one an output
  const char* weights;  ///< base64 of int8
};

/// The twelve 3x3 layers in the order in which they run, then the two joins.
extern const std::array<StoredLayer, 14> kVesselNetLayers;

}  // namespace eyeslam::tracking
