// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/track_display.h"

#include <visp3/core/vpDisplay.h>
#include <visp3/core/vpImagePoint.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "eyeslam/tracking/view_geometry.h"

namespace eyeslam::tracking {

namespace {

constexpr std::size_t kMostDisplayed = 3000;  // a window system draws no more in a frame's time
constexpr unsigned int kCross = 15;           // px

template <class Pixel>
void display(const vpImage<Pixel>& I, const retina::VesselMap& map, const TrackResult& result, const ToolTip& tip,
             const vpColor& color, unsigned int thickness)
{
  if (!I.display) return;
  const cv::Size size(static_cast<int>(I.getWidth()), static_cast<int>(I.getHeight()));
  if (result.tracked) {
    for (const cv::Point2d at : vesselsInView(map, result.map_T_frame, size, kMostDisplayed)) {
      vpDisplay::displayPoint(I, vpImagePoint(at.y, at.x), color, thickness);
    }
  }
  if (!tip.present) return;
  const vpImagePoint end(tip.y_px, tip.x_px);
  const double length = 10.0 * tip.shaft_width_px;
  const vpImagePoint back(tip.y_px - length * std::sin(tip.shaft_angle), tip.x_px - length * std::cos(tip.shaft_angle));
  vpDisplay::displayLine(I, back, end, vpColor::yellow, thickness);
  vpDisplay::displayCross(I, end, kCross, vpColor::yellow, thickness);
}

}  // namespace

void displayTrack(const vpImage<vpRGBa>& I, const retina::VesselMap& map, const TrackResult& result, const ToolTip& tip,
                  const vpColor& color, unsigned int thickness)
{
  display(I, map, result, tip, color, thickness);
}

void displayTrack(const vpImage<unsigned char>& I, const retina::VesselMap& map, const TrackResult& result,
                  const ToolTip& tip, const vpColor& color, unsigned int thickness)
{
  display(I, map, result, tip, color, thickness);
}

}  // namespace eyeslam::tracking
