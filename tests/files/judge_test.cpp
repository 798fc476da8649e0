// SPDX-License-Identifier: GPL-3.0-or-later
// The score against the judge's own program, where that, its Python modules and a sequence are present.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "eyeslam/files/map_score.h"
#include "eyeslam/files/score.h"
#include "eyeslam/files/test_sequence.h"

using namespace eyeslam::files;

namespace {

constexpr double kPrinted = 1e-5;    // of a trajectory written with six decimals
constexpr double kThinning = 0.002;  // of coverage: two thinnings of one vessel differ by px at its ends and corners
constexpr int kFrame = 90;

class Judge : public testing::Test {
 protected:
  void SetUp() override
  {
    const char* shared = std::getenv("EYESLAM_SHARED");
    script_ = std::string(shared ? shared : "") + "/score.py";
    sequence_ = std::string(shared ? shared : "") + "/sequences/blackout";
    if (!std::filesystem::exists(script_) || !std::filesystem::exists(sequence_)) {
      GTEST_SKIP() << "SKIPPED: no " << script_ << " or " << sequence_ << " (set EYESLAM_SHARED)";
    }
    if (std::system("/usr/bin/python3 -c 'import cv2, numpy, scipy, skimage' 2> /dev/null") != 0) {
      GTEST_SKIP() << "SKIPPED: Python lacks cv2, numpy, scipy or skimage";
    }
    std::string name = (std::filesystem::temp_directory_path() / "eyeslam_judge_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    truth_ = readTestSequence(sequence_).truth;
    estimate();
    drawMap();
  }
  void TearDown() override
  {
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }

  /// The truth with a wave on it that exceeds 5 px now and then, lost while hidden and ten frames longer.
  void estimate()
  {
    std::ofstream file(folder_ + "/trajectory.csv");
    file << "frame,tracked,x_px,y_px,theta_deg,cpu_ms\n";
    int since_hidden = 100;
    for (std::size_t i = 0; i < truth_.poses.size(); ++i) {
      const TruthPose& pose = truth_.poses[i];
      since_hidden = pose.visible ? since_hidden + 1 : 0;
      const double wave = std::sin(0.37 * static_cast<double>(i)) * (since_hidden < 10 ? 40.0 : 11.0);
      estimate_.push_back({since_hidden >= 10, pose.x_px + wave, pose.y_px + 1.5, pose.theta_deg - 0.01 * wave,
                           0.5 + 0.001 * static_cast<double>(i)});
      const EstimatedPose& row = estimate_.back();
      file << std::fixed << i << "," << row.tracked << "," << row.x_px << "," << row.y_px << "," << row.theta_deg << ","
           << row.cpu_ms << "\n";
    }
  }

  /// The true vessels, those in the right half lost, those in the lower half shifted by 7 px.
  void drawMap()
  {
    cv::Mat cells;
    cv::resize(truth_.vessels > 0, cells, {}, 0.5, 0.5, cv::INTER_NEAREST);
    cells.colRange(cells.cols * 2 / 3, cells.cols).setTo(0);
    cv::Mat lower = cells.rowRange(cells.rows / 2, cells.rows).clone();
    lower.colRange(0, lower.cols - 7).copyTo(cells(cv::Rect(7, cells.rows / 2, lower.cols - 7, lower.rows)));
    map_.width = cells.cols;
    map_.height = cells.rows;
    map_.px_per_cell = 2.0;
    map_.origin_x = truth_.vessels_origin.x + 0.5;
    map_.origin_y = truth_.vessels_origin.y + 0.5;
    map_.probability.assign(cells.begin<std::uint8_t>(), cells.end<std::uint8_t>());
    char name[32];
    std::snprintf(name, sizeof name, "/map_%06d", kFrame);
    cv::imwrite(folder_ + name + ".png", cells);
    const nlohmann::json geometry = {
        {"origin_x", map_.origin_x}, {"origin_y", map_.origin_y}, {"px_per_cell", 2.0}, {"um_per_px", nullptr}};
    std::ofstream(folder_ + name + ".json") << geometry.dump();
  }

  nlohmann::json verdict() const
  {
    const std::string call = "/usr/bin/python3 " + script_ + " " + sequence_ + " " + folder_ +
                             "/trajectory.csv --map " + folder_ + " --json";
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(call.c_str(), "r"), pclose);
    std::string text;
    char part[512];
    while (std::fgets(part, sizeof part, pipe.get())) text += part;
    return nlohmann::json::parse(text);
  }

  std::string script_, sequence_, folder_;
  Truth truth_;
  std::vector<EstimatedPose> estimate_;
  eyeslam::retina::VesselMap map_;
};

TEST_F(Judge, AgreesOnTrajectoryAndMap)
{
  const nlohmann::json judge = verdict();
  const PoseScore pose = scorePoses(truth_.poses, estimate_);
  EXPECT_EQ(pose.frames, judge["frames"]);
  EXPECT_EQ(pose.visible, judge["visible"]);
  EXPECT_NEAR(pose.rms_px, judge["rms_px"], kPrinted);
  EXPECT_NEAR(pose.rms_deg, judge["rms_deg"], kPrinted);
  EXPECT_NEAR(pose.aligned_rms_px, judge["aligned_rms_px"], kPrinted);
  EXPECT_NEAR(pose.aligned_rms_deg, judge["aligned_rms_deg"], kPrinted);
  EXPECT_NEAR(pose.median_px, judge["median_px"], kPrinted);
  EXPECT_NEAR(pose.p95_px, judge["p95_px"], kPrinted);
  EXPECT_NEAR(pose.max_px, judge["max_px"], kPrinted);
  EXPECT_NEAR(pose.under_5_px, judge["under_5_px"], kPrinted);
  EXPECT_NEAR(pose.tracked, judge["tracked"], kPrinted);
  EXPECT_NEAR(pose.tracked_while_hidden, judge["tracked_while_hidden"], kPrinted);
  EXPECT_EQ(nlohmann::json(pose.frames_to_return), judge["frames_to_return"]);
  EXPECT_NEAR(pose.cpu_ms_median, judge["cpu_ms_median"], kPrinted);
  EXPECT_NEAR(pose.cpu_ms_p99, judge["cpu_ms_p99"], kPrinted);

  const MapScore map = MapScorer(truth_).score(kFrame, map_);
  const nlohmann::json& row = judge["maps"][0];
  EXPECT_EQ(map.frame, row["frame"]);
  EXPECT_EQ(map.cells, row["cells"]);
  EXPECT_NEAR(map.coverage, row["coverage"], kThinning);
  EXPECT_NEAR(map.coverage_from_6_px, row["coverage_from_6_px"], kThinning);
  EXPECT_NEAR(map.coverage_from_10_px, row["coverage_from_10_px"], kThinning);
  EXPECT_NEAR(map.false_positive, row["false_positive"], kPrinted);
  EXPECT_GT(map.false_positive, 0.1);  // or the comparison would show nothing
  EXPECT_LT(map.coverage, 0.9);
}

}  // namespace
