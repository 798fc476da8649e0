// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>

#include "eyeslam/simulation/random.h"

namespace eyeslam::simulation {

/// Smooth noise whose bumps are about `cell` px wide; mean 0, standard deviation 1 over a large picture.
cv::Mat_<float> smoothNoise(cv::Size size, double cell_px, Random& random);

/// Sum of smooth noises from `coarsest_px` down, each half as wide and `falloff` times as strong; standard deviation 1.
cv::Mat_<float> fractalNoise(cv::Size size, double coarsest_px, int octaves, double falloff, Random& random);

}  // namespace eyeslam::simulation
