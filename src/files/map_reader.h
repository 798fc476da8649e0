// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "eyeslam/files/map_files.h"
#include "eyeslam/retina/vessel_map.h"

namespace eyeslam::files {

/// What `eyeslam-track` wrote into a folder about the retina (contracts, section 3).
struct RecordedMap {
  retina::VesselMap map;   ///< um_per_px is 0 where the file says null
  std::int64_t frame = 0;  ///< after which the map was kept
  std::string path;        ///< of the map's picture, for messages
  std::string track;       ///< SHA-256 of the video, from run.json; empty when that is missing
};

/// Reads map/map_FFFFFF.png with its .json and seen_FFFFFF.png: the newest frame's, or the given one's. The calibre
/// comes from vessels.csv for the newest map; else it follows from the distance to the nearest cell that is no vessel,
/// which is right in the middle of a vessel and too small beside it.
/// @throws FileError naming file and field: missing, truncated, of another shape or kind, of another map, no number
RecordedMap readMap(const std::string& folder, std::optional<std::int64_t> frame = std::nullopt);

/// A picture of the retina with its place in the map frame.
struct RecordedMosaic {
  cv::Mat picture;  ///< 8-bit, 3 channels
  PictureGeometry geometry;
};

/// Nothing when the folder has no mosaic.png. @throws FileError as above
std::optional<RecordedMosaic> readMosaic(const std::string& folder);

/// Any picture; its place is that of the .json of the same name beside it, else frame 0's. @throws FileError as above
RecordedMosaic readPlacedPicture(const std::string& path);

}  // namespace eyeslam::files
