// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "eyeslam/files/map_files.h"
#include "eyeslam/fixtures/vessel_graph.h"

namespace eyeslam::files {

/// A vessel graph and the map that it was made from.
struct RecordedGraph {
  std::string map_hash;      ///< SHA-256 of the map's cells and geometry (retina::hashOf)
  PictureGeometry geometry;  ///< of the map
  fixtures::VesselNetwork network;
};

/// A graph as `graph.json` (contracts, section 6); numbers in the shortest form that reads back to the same value.
std::string graphJson(const RecordedGraph& graph);

/// A graph from the text of a `graph.json`, every field checked. Tangents and curvature are computed from the points.
/// @param path  only for messages
/// @throws FileError naming the file and the field ("vessels[3].points[7].s_px"): truncated, of another version,
///         missing or unknown, no number (NaN included), an id that stands twice, an end at a junction that does not
///         exist or lies elsewhere, arc length that does not rise
RecordedGraph graphFrom(const std::string& text, const std::string& path);

/// Reads or writes the file; the writing is atomic. @throws FileError
RecordedGraph readGraph(const std::string& path);
void writeGraph(const RecordedGraph& graph, const std::string& path);

}  // namespace eyeslam::files
