// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/test_sequence.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "eyeslam/files/file_error.h"
#include "eyeslam/files/whole_file.h"

namespace eyeslam::files {
namespace {

using Json = nlohmann::json;

std::vector<std::string> fieldsOf(const std::string& line)
{
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) {
    while (!field.empty() && (field.back() == '\r' || field.back() == ' ')) field.pop_back();
    fields.push_back(field);
  }
  return fields;
}

// A table of numbers by the name of its column.
class NumberTable {
 public:
  explicit NumberTable(const std::string& path) : path_(path)
  {
    std::istringstream stream(readWholeText(path));
    std::string line;
    std::getline(stream, line);
    const auto names = fieldsOf(line);
    while (std::getline(stream, line)) {
      if (line.empty()) continue;
      const auto fields = fieldsOf(line);
      ++rows_;
      if (fields.size() != names.size())
        throw FileError(fmt::format("{}: row {} has {} fields, its head {}", path, rows_, fields.size(), names.size()));
      for (std::size_t i = 0; i < names.size(); ++i) columns_[names[i]].push_back(number(fields[i]));
    }
  }

  std::size_t rows() const { return rows_; }
  const std::vector<double>& column(const std::string& name) const
  {
    const auto found = columns_.find(name);
    if (found == columns_.end()) throw FileError(fmt::format("{}: no column {}", path_, name));
    return found->second;
  }

 private:
  double number(const std::string& field) const
  {
    std::istringstream stream(field);
    stream.imbue(std::locale::classic());
    double value = 0.0;
    if (!(stream >> value) || !(stream >> std::ws).eof()) {
      throw FileError(fmt::format("{}: row {}: '{}' is not a number", path_, rows_, field));
    }
    return value;
  }

  std::string path_;
  std::size_t rows_ = 0;
  std::map<std::string, std::vector<double>> columns_;
};

void readPoses(const std::string& path, TestSequence& sequence)
{
  const NumberTable table(path);
  for (std::size_t i = 0; i < table.rows(); ++i) {
    if (table.column("frame")[i] != static_cast<double>(i))
      throw FileError(fmt::format("{}: frames are not 0, 1, 2, ...", path));
    TruthPose pose;
    pose.t_s = table.column("t_s")[i];
    pose.x_px = table.column("x_px")[i];
    pose.y_px = table.column("y_px")[i];
    pose.theta_deg = table.column("theta_deg")[i];
    pose.scale = table.column("scale")[i];
    pose.visible = table.column("visible")[i] > 0.0;
    sequence.truth.poses.push_back(pose);
    sequence.tool_cover.push_back(table.column("tool_cover")[i]);
  }
}

void readTools(const std::string& path, Truth& truth)
{
  const NumberTable table(path);
  if (table.rows() != truth.poses.size())
    throw FileError(fmt::format("{}: {} rows, truth.csv has {}", path, table.rows(), truth.poses.size()));
  for (std::size_t i = 0; i < table.rows(); ++i) {
    truth.tools.push_back({table.column("present")[i] > 0.0, table.column("tip_x_px")[i], table.column("tip_y_px")[i],
                           table.column("shaft_angle_deg")[i], table.column("shaft_width_px")[i]});
  }
}

void readMeta(const std::string& path, TestSequence& sequence)
{
  try {
    const Json meta = Json::parse(readWholeText(path));
    Truth& truth = sequence.truth;
    truth.size = {meta.at("size").at(0).get<int>(), meta.at("size").at(1).get<int>()};
    truth.fps = meta.at("fps").get<double>();
    if (meta.contains("um_per_px") && !meta["um_per_px"].is_null()) truth.um_per_px = meta["um_per_px"].get<double>();
    truth.vessels_origin = {meta.at("vessels_origin").at(0).get<double>(),
                            meta.at("vessels_origin").at(1).get<double>()};
    if (meta.contains("rim") && !meta["rim"].is_null()) {
      const Json& rim = meta["rim"];
      truth.rim = Rim{rim.at("cx").get<double>(), rim.at("cy").get<double>(), rim.at("r").get<double>()};
    }
    sequence.condition = meta.value("condition", "");
    sequence.seed = meta.value("seed", std::uint64_t{0});
    sequence.zoom = meta.value("zoom", 1.0);
    sequence.burns = meta.value("burns", std::vector<int>{});
  } catch (const Json::exception& error) {
    throw FileError(fmt::format("{}: {}", path, error.what()));
  }
}

std::string metaText(const TestSequence& sequence)
{
  const Truth& truth = sequence.truth;
  nlohmann::ordered_json meta;
  meta["size"] = {truth.size.width, truth.size.height};
  meta["fps"] = truth.fps;
  meta["frames"] = truth.poses.size();
  meta["um_per_px"] = truth.um_per_px > 0.0 ? Json(truth.um_per_px) : Json(nullptr);
  meta["vessels_origin"] = {truth.vessels_origin.x, truth.vessels_origin.y};
  meta["rim"] = nullptr;
  if (truth.rim) meta["rim"] = {{"cx", truth.rim->cx}, {"cy", truth.rim->cy}, {"r", truth.rim->r}};
  meta["condition"] = sequence.condition;
  meta["seed"] = sequence.seed;
  meta["zoom"] = sequence.zoom;
  meta["burns"] = sequence.burns;
  return meta.dump(1) + "\n";
}

std::string poseTable(const TestSequence& sequence)
{
  std::string text = "frame,t_s,x_px,y_px,theta_deg,scale,visible,tool_cover\n";
  for (std::size_t i = 0; i < sequence.truth.poses.size(); ++i) {
    const TruthPose& pose = sequence.truth.poses[i];
    text += fmt::format("{},{:.6f},{:.5f},{:.5f},{:.6f},{:.6f},{},{:.4f}\n", i, pose.t_s, pose.x_px, pose.y_px,
                        pose.theta_deg, pose.scale, pose.visible ? 1 : 0, sequence.tool_cover.at(i));
  }
  return text;
}

std::string toolTable(const Truth& truth)
{
  std::string text = "frame,present,tip_x_px,tip_y_px,shaft_angle_deg,shaft_width_px\n";
  for (std::size_t i = 0; i < truth.tools.size(); ++i) {
    const TruthTool& tool = truth.tools[i];
    text += fmt::format("{},{},{:.2f},{:.2f},{:.3f},{:.2f}\n", i, tool.present ? 1 : 0, tool.tip_x_px, tool.tip_y_px,
                        tool.shaft_angle_deg, tool.shaft_width_px);
  }
  return text;
}

}  // namespace

TestSequence readTestSequence(const std::string& folder)
{
  const std::filesystem::path path(folder);
  TestSequence sequence;
  readMeta((path / "meta.json").string(), sequence);
  readPoses((path / "truth.csv").string(), sequence);
  if (const auto tools = path / "tool.csv"; std::filesystem::exists(tools)) readTools(tools.string(), sequence.truth);
  if (const auto picture = path / "vessels.png"; std::filesystem::exists(picture)) {
    const cv::Mat vessels = cv::imread(picture.string(), cv::IMREAD_UNCHANGED);
    if (vessels.type() != CV_8UC1 || vessels.empty())
      throw FileError(fmt::format("{}: not a grey picture of 8 bit", picture.string()));
    sequence.truth.vessels = vessels;
  }
  return sequence;
}

void writeTestSequence(const TestSequence& sequence, const OutputFolder& folder)
{
  folder.write("truth.csv", poseTable(sequence));
  folder.write("tool.csv", toolTable(sequence.truth));
  folder.writePng("vessels.png", sequence.truth.vessels);
  folder.write("meta.json", metaText(sequence));
}

std::string videoOfTestSequence(const std::string& folder)
{
  const std::filesystem::path path(folder);
  const auto lossless = path / "video.mkv";
  const auto usual = path / "video.mp4";
  return (!std::filesystem::exists(usual) && std::filesystem::exists(lossless) ? lossless : usual).string();
}

}  // namespace eyeslam::files
