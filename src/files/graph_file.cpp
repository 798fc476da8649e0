// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/graph_file.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include "eyeslam/files/json_fields.h"
#include "eyeslam/files/partial_file.h"
#include "eyeslam/files/whole_file.h"
#include "eyeslam/fixtures/centerline_fit.h"

namespace eyeslam::files {
namespace {

using fixtures::CenterlinePoint;
using fixtures::Junction;
using fixtures::Vessel;

constexpr int kGraphVersion = 1;
constexpr int kMostIds = 2000000000;
constexpr double kWidest_px = 1e4;
constexpr double kOnJunction_px = 1e-3;  // a file that was written in fewer digits is still one
constexpr double kArcLength = 0.01;      // share; and so is one whose arc length was taken along the curve

nlohmann::ordered_json jsonOf(const Vessel& vessel)
{
  nlohmann::ordered_json json;
  json["id"] = vessel.id;
  for (const int end : vessel.ends) {
    json["ends"].push_back(end == Vessel::kNoJunction ? nlohmann::ordered_json() : nlohmann::ordered_json(end));
  }
  json["points"] = nlohmann::ordered_json::array();
  for (const CenterlinePoint& point : vessel.points) {
    json["points"].push_back({{"x_px", point.position_px.x()},
                              {"y_px", point.position_px.y()},
                              {"radius_px", point.radius_px},
                              {"s_px", point.s_px}});
  }
  return json;
}

Eigen::Vector2d positionFrom(const JsonFields& json)
{
  return {json.number("x_px", -kFarthest_px, kFarthest_px), json.number("y_px", -kFarthest_px, kFarthest_px)};
}

std::map<int, Junction> junctionsFrom(const JsonFields& json)
{
  std::map<int, Junction> junctions;
  for (const JsonFields& fields : json.list("junctions")) {
    fields.allowOnly({"id", "x_px", "y_px"});
    const Junction junction{fields.whole("id", 0, kMostIds), positionFrom(fields)};
    if (!junctions.emplace(junction.id, junction).second) fields.fail("id", "stands twice");
  }
  return junctions;
}

// The points with shapes; the arc length in the file must be theirs.
std::vector<CenterlinePoint> pointsFrom(const JsonFields& json)
{
  std::vector<CenterlinePoint> points;
  double last_s = -1.0;
  for (const JsonFields& fields : json.list("points")) {
    fields.allowOnly({"x_px", "y_px", "radius_px", "s_px"});
    CenterlinePoint point;
    point.position_px = positionFrom(fields);
    point.radius_px = fields.number("radius_px", 1e-6, kWidest_px);
    const double s = fields.number("s_px", 0.0, kFarthest_px);
    if (points.empty() && s != 0.0) fields.fail("s_px", "the first point's arc length is not 0");
    if (s <= last_s) fields.fail("s_px", "the arc length does not rise from point to point");
    const double step = points.empty() ? 0.0 : (point.position_px - points.back().position_px).norm();
    if (!points.empty() && std::abs(s - last_s - step) > kArcLength * step) {
      fields.fail("s_px", fmt::format("rises by {} where the points lie {} apart", s - last_s, step));
    }
    last_s = s;
    points.push_back(point);
  }
  if (points.size() < 2) json.fail("points", "are fewer than two");
  fixtures::addShape(points);
  return points;
}

std::array<int, 2> endsFrom(const JsonFields& json, const std::map<int, Junction>& junctions,
                            const std::vector<CenterlinePoint>& points)
{
  std::array<int, 2> ends{Vessel::kNoJunction, Vessel::kNoJunction};
  const nlohmann::json& list = json.at("ends");
  if (!list.is_array() || list.size() != 2) json.fail("ends", "are not two");
  for (std::size_t i = 0; i < 2; ++i) {
    if (list[i].is_null()) continue;
    const auto found = list[i].is_number_integer() ? junctions.find(list[i].get<int>()) : junctions.end();
    if (found == junctions.end()) json.fail("ends", fmt::format("there is no junction {}", list[i].dump()));
    const Eigen::Vector2d end = (i == 0 ? points.front() : points.back()).position_px;
    if ((end - found->second.position_px).norm() > kOnJunction_px) {
      json.fail("ends", fmt::format("the vessel does not end on junction {}", found->first));
    }
    ends[i] = found->first;
  }
  return ends;
}

std::vector<Vessel> vesselsFrom(const JsonFields& json, const std::map<int, Junction>& junctions)
{
  std::vector<Vessel> vessels;
  std::set<int> ids;
  for (const JsonFields& fields : json.list("vessels")) {
    fields.allowOnly({"id", "ends", "points"});
    Vessel vessel;
    vessel.id = fields.whole("id", 0, kMostIds);
    if (!ids.insert(vessel.id).second) fields.fail("id", "stands twice");
    vessel.points = pointsFrom(fields);
    vessel.ends = endsFrom(fields, junctions, vessel.points);
    vessels.push_back(std::move(vessel));
  }
  return vessels;
}

void readMapFields(const JsonFields& json, RecordedGraph& graph)
{
  constexpr std::size_t kDigits = 64;
  json.allowOnly({"hash", "origin_x", "origin_y", "px_per_cell"});
  graph.map_hash = json.text("hash");
  if (graph.map_hash.size() != kDigits || graph.map_hash.find_first_not_of("0123456789abcdef") != std::string::npos) {
    json.fail("hash", "is no SHA-256, 64 hexadecimal digits");
  }
  graph.geometry = {json.number("origin_x", -kFarthest_px, kFarthest_px),
                    json.number("origin_y", -kFarthest_px, kFarthest_px), json.number("px_per_cell", 1e-3, 100.0)};
}

}  // namespace

std::string graphJson(const RecordedGraph& graph)
{
  nlohmann::ordered_json json;
  json["version"] = kGraphVersion;
  json["map"] = {{"hash", graph.map_hash},
                 {"origin_x", graph.geometry.origin_x},
                 {"origin_y", graph.geometry.origin_y},
                 {"px_per_cell", graph.geometry.px_per_cell}};
  json["vessels"] = nlohmann::ordered_json::array();
  for (const Vessel& vessel : graph.network.vessels) json["vessels"].push_back(jsonOf(vessel));
  json["junctions"] = nlohmann::ordered_json::array();
  for (const Junction& junction : graph.network.junctions) {
    json["junctions"].push_back(
        {{"id", junction.id}, {"x_px", junction.position_px.x()}, {"y_px", junction.position_px.y()}});
  }
  return json.dump() + "\n";
}

RecordedGraph graphFrom(const std::string& text, const std::string& path)
{
  const JsonFields json = JsonFields::parse(text, path);
  if (json.whole("version", 0, kMostIds) != kGraphVersion) {
    json.fail("version", fmt::format("only version {} can be read", kGraphVersion));
  }
  json.allowOnly({"version", "map", "vessels", "junctions"});
  RecordedGraph graph;
  readMapFields(json.object("map"), graph);
  const std::map<int, Junction> junctions = junctionsFrom(json);
  graph.network.vessels = vesselsFrom(json, junctions);
  for (const auto& [id, junction] : junctions) graph.network.junctions.push_back(junction);
  return graph;
}

RecordedGraph readGraph(const std::string& path) { return graphFrom(readWholeText(path), path); }

void writeGraph(const RecordedGraph& graph, const std::string& path)
{
  PartialFile file(path);
  writeWholeFile(file.partialPath(), graphJson(graph));
  file.publish();
}

}  // namespace eyeslam::files
