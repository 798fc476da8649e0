// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/map_vessel_detector.h"

#include <algorithm>
#include <cmath>

namespace eyeslam::tracking {

MapVesselDetector::MapVesselDetector()
    : contrast_(VesselNet::kRegion, VesselNet::kRegion), count_(VesselNet::kRegion, VesselNet::kRegion)
{}

void MapVesselDetector::begin(const Mosaic& mosaic, const cv::Point& at)
{
  at_ = at;
  busy_ = true;
  mosaic.read(region(at), contrast_, count_);
  net_.begin(contrast_, count_);
}

void MapVesselDetector::finish(double px_per_cell, cv::Mat_<std::int8_t> log_odds, cv::Mat_<std::uint8_t> calibre)
{
  const auto unit = static_cast<float>(px_per_cell);
  for (int y = 0; y < kBlock; ++y) {
    for (int x = 0; x < kBlock; ++x) {
      const bool known = count_(y + kApron, x + kApron) > 0 || contrast_(y + kApron, x + kApron) != 0;
      const float odds = std::round(kLogOddsUnit * net_.logOdds(x + kApron, y + kApron));
      const float width = std::round(unit * net_.calibre(x + kApron, y + kApron));
      log_odds(y, x) = known ? static_cast<std::int8_t>(std::clamp(odds, -127.0F, 127.0F)) : kNeverSeen;
      calibre(y, x) = static_cast<std::uint8_t>(std::clamp(width, 1.0F, 255.0F));
    }
  }
  busy_ = false;
}

}  // namespace eyeslam::tracking
