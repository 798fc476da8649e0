// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <opencv2/core.hpp>

#include "eyeslam/files/map_files.h"
#include "eyeslam/files/vector_picture.h"
#include "eyeslam/fixtures/vessel_graph.h"
#include "eyeslam/retina/vessel_map.h"

namespace eyeslam::files {

/// The map as a dark picture, a px a cell, for lines to stand out on.
cv::Mat dimMapPicture(const retina::VesselMap& map);

/// How a graph is drawn. Sizes in px of the picture.
struct GraphStyle {
  double line_px = 0.8;
  double junction_px = 1.6;
  double end_px = 1.2;
  double words_px = 7.0;         ///< height of the ids; 0 leaves them out
  double least_named_px = 60.0;  ///< vessels shorter than this, in map px, go without their id
};

/// Draws centrelines (a colour a vessel, the same for the same id), junctions (white), free ends (red) and ids into a
/// picture that lies in the map frame as `geometry` says. Other drawings may come before and after.
///
///   VectorPicture picture(dimMapPicture(map));
///   drawGraph(picture, graph.network(), {map.origin_x, map.origin_y, map.px_per_cell});
void drawGraph(VectorPicture& picture, const fixtures::VesselNetwork& network, const PictureGeometry& geometry,
               const GraphStyle& style = {});

}  // namespace eyeslam::files
