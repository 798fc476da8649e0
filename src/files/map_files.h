// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "eyeslam/files/output_folder.h"
#include "eyeslam/files/pixel_size.h"
#include "eyeslam/retina/vessel_map.h"

namespace eyeslam::files {

/// Where a picture of the retina lies in the map frame.
struct PictureGeometry {
  double origin_x = 0.0;  ///< of the centre of the picture's pixel (0, 0), full-resolution px
  double origin_y = 0.0;
  double px_per_cell = 1.0;  ///< full-resolution px per pixel of the picture
};

/// `{"origin_x", "origin_y", "px_per_cell", "um_per_px"}`, the last null when unknown.
std::string geometryJson(const PictureGeometry& geometry, const PixelSize& pixel_size);

/// Writes map/map_FFFFFF.png and .json and map/seen_FFFFFF.png; an empty map is one cell never seen.
void writeMap(const OutputFolder& folder, const retina::VesselMap& map, std::int64_t frame,
              const PixelSize& pixel_size);

/// `vessels.csv`: the paper's map points M.
std::string vesselsCsv(const retina::VesselMap& map);

/// Writes mosaic.png and mosaic.json; an empty picture is one black pixel.
void writeMosaic(const OutputFolder& folder, const cv::Mat& picture, const PictureGeometry& geometry,
                 const PixelSize& pixel_size);

}  // namespace eyeslam::files
