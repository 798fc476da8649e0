// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "eyeslam/simulation/vessel_tree.h"

namespace eyeslam::simulation {

/// Vessels as pictures of one size.
struct VesselPictures {
  cv::Mat_<float> artery_um;   ///< way of the light through arterial blood
  cv::Mat_<float> vein_um;     ///< and through venous blood
  cv::Mat_<float> reflex;      ///< light reflected by the columns of blood, 0 to 1
  cv::Mat_<float> calibre_px;  ///< local calibre, 0 = no vessel
};

/// Draws vessels as cylinders of blood; where two of one kind meet, the thicker counts.
VesselPictures drawVessels(const std::vector<Vessel>& vessels, cv::Size size, double um_per_px);

}  // namespace eyeslam::simulation
