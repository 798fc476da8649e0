// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/graph_file.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/graph_drawing.h"
#include "eyeslam/retina/map_hash.h"
#include "support/drawn_vessels.h"
#include "support/network_checks.h"
#include "support/temporary_folder.h"

namespace eyeslam::files {
namespace {

/// Five vessels and two junctions.
RecordedGraph treeGraph()
{
  support::DrawnVessels drawn(140, 100, -20.5, 7.25);
  drawn.tube({{-15.0, 60.0}, {110.0, 55.0}}, 4.0);
  drawn.tube({{20.0, 58.0}, {35.0, 15.0}}, 2.0).tube({{70.0, 57.0}, {95.0, 100.0}}, 2.0);
  fixtures::VesselGraph graph;
  graph.update(drawn.map());
  return {retina::hashOf(drawn.map()), {-20.5, 7.25, 1.0}, graph.network()};
}

/// What reading the file says after one change of it; empty when it is accepted.
template <class Change>
std::string complaint(Change change)
{
  auto json = nlohmann::json::parse(graphJson(treeGraph()));
  change(json);
  try {
    graphFrom(json.dump(), "some.json");
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

void expectComplaint(const std::string& said, const std::string& field)
{
  EXPECT_EQ(said.rfind("some.json: " + field, 0), 0U) << said;
  EXPECT_EQ(said.find('\n'), std::string::npos) << said;
}

std::size_t joinedVessel(const nlohmann::json& json)
{
  for (std::size_t i = 0; i < json["vessels"].size(); ++i) {
    if (!json["vessels"][i]["ends"][0].is_null()) return i;
  }
  return 0;
}

TEST(GraphFile, ReadsBackWhatWasWritten)
{
  const support::TemporaryFolder folder;
  const RecordedGraph graph = treeGraph();
  const std::string path = folder.path("graph.json");
  writeGraph(graph, path);
  const RecordedGraph back = readGraph(path);
  EXPECT_EQ(back.map_hash, graph.map_hash);
  EXPECT_EQ(back.geometry.origin_x, graph.geometry.origin_x);
  support::expectSound(back.network);
  ASSERT_EQ(back.network.vessels.size(), graph.network.vessels.size());
  ASSERT_EQ(back.network.junctions.size(), graph.network.junctions.size());
  for (std::size_t i = 0; i < graph.network.vessels.size(); ++i) {
    const fixtures::Vessel &a = graph.network.vessels[i], &b = back.network.vessels[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.ends, b.ends);
    ASSERT_EQ(a.points.size(), b.points.size());
    for (std::size_t k = 0; k < a.points.size(); ++k) {
      EXPECT_EQ(a.points[k].position_px, b.points[k].position_px);
      EXPECT_EQ(a.points[k].radius_px, b.points[k].radius_px);
      EXPECT_LT((a.points[k].tangent - b.points[k].tangent).norm(), 1e-9);
      EXPECT_NEAR(a.points[k].curvature_per_px, b.points[k].curvature_per_px, 1e-6);
    }
  }
}

TEST(GraphFile, OfAnEmptyGraphReadsBackEmpty)
{
  const RecordedGraph empty{std::string(64, '0'), {}, {}};
  EXPECT_TRUE(graphFrom(graphJson(empty), "some.json").network.vessels.empty());
}

TEST(GraphFile, CutShortAnywhereIsRefused)
{
  const std::string text = graphJson(treeGraph());
  for (std::size_t length = 0; length + 2 < text.size(); length += 401) {
    EXPECT_THROW(graphFrom(text.substr(0, length), "some.json"), FileError) << length;
  }
  EXPECT_THROW(readGraph("there/is/no/graph.json"), FileError);
}

TEST(GraphFile, NamesTheFieldThatIsWrong)
{
  EXPECT_EQ(complaint([](auto&) {}), "");
  expectComplaint(complaint([](auto& json) { json["version"] = 2; }), "version");
  expectComplaint(complaint([](auto& json) { json.erase("map"); }), "map");
  expectComplaint(complaint([](auto& json) { json["map"]["hash"] = "abc"; }), "map.hash");
  expectComplaint(complaint([](auto& json) { json["map"]["px_per_cell"] = 0.0; }), "map.px_per_cell");
  expectComplaint(complaint([](auto& json) { json["more"] = 1; }), "more");
  expectComplaint(complaint([](auto& json) { json["vessels"] = 1; }), "vessels");
  // NaN cannot be written in JSON; writers put null.
  expectComplaint(complaint([](auto& json) { json["vessels"][1]["points"][2]["x_px"] = nullptr; }),
                  "vessels[1].points[2].x_px");
  expectComplaint(complaint([](auto& json) { json["vessels"][0]["points"][0]["radius_px"] = -1.0; }),
                  "vessels[0].points[0].radius_px");
  expectComplaint(complaint([](auto& json) { json["vessels"][1]["id"] = json["vessels"][0]["id"]; }), "vessels[1].id");
  expectComplaint(complaint([](auto& json) { json["junctions"][1]["id"] = json["junctions"][0]["id"]; }),
                  "junctions[1].id");
}

TEST(GraphFile, RefusesArcLengthThatDoesNotRiseOrIsNotThePoints)
{
  expectComplaint(complaint([](auto& json) { json["vessels"][0]["points"][0]["s_px"] = 0.5; }),
                  "vessels[0].points[0].s_px");
  expectComplaint(complaint([](auto& json) {
                    auto& points = json["vessels"][0]["points"];
                    points[5]["s_px"] = points[4]["s_px"];
                  }),
                  "vessels[0].points[5].s_px");
  expectComplaint(complaint([](auto& json) {
                    auto& points = json["vessels"][0]["points"];
                    points[5]["s_px"] =
                        0.5 * (points[4]["s_px"].template get<double>() + points[5]["s_px"].template get<double>());
                  }),
                  "vessels[0].points[5].s_px");
}

TEST(GraphFile, RefusesEndsWithoutTheirJunction)
{
  const auto ends = [](const nlohmann::json& json) {
    return "vessels[" + std::to_string(joinedVessel(json)) + "].ends";
  };
  const std::string field = ends(nlohmann::json::parse(graphJson(treeGraph())));
  expectComplaint(complaint([](auto& json) { json["vessels"][joinedVessel(json)]["ends"][0] = 999999; }), field);
  expectComplaint(complaint([](auto& json) { json["vessels"][joinedVessel(json)]["ends"] = {nullptr}; }), field);
  expectComplaint(complaint([](auto& json) { json["junctions"][0]["x_px"] = 12345.0; }), "vessels[");
}

TEST(GraphDrawing, ShowsEveryVesselAndItsIdInTheSvg)
{
  const RecordedGraph graph = treeGraph();
  VectorPicture picture(cv::Mat(100, 140, CV_8UC3, cv::Scalar::all(0)));
  GraphStyle style;
  style.least_named_px = 0.0;
  drawGraph(picture, graph.network, graph.geometry, style);
  const std::string svg = picture.svg();
  for (const fixtures::Vessel& vessel : graph.network.vessels) {
    EXPECT_NE(svg.find(">" + std::to_string(vessel.id) + "<"), std::string::npos) << vessel.id;
  }
  const cv::Mat pixels = picture.pixels();
  const auto& at = graph.network.vessels[0].points[10].position_px;
  const cv::Point pixel(cvRound(at.x() + 20.5), cvRound(at.y() - 7.25));
  EXPECT_GT(cv::norm(pixels.at<cv::Vec3b>(pixel)), 50.0) << "no line where the vessel runs";
}

}  // namespace
}  // namespace eyeslam::files
