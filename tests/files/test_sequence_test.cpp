// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/files/test_sequence.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "eyeslam/files/file_error.h"
#include "support/temporary_folder.h"

namespace eyeslam::files {
namespace {

TestSequence example()
{
  TestSequence sequence;
  sequence.truth.size = {160, 120};
  sequence.truth.um_per_px = 5.25;
  sequence.truth.rim = Rim{80.5, 59.25, 88.0};
  sequence.truth.poses = {{0.0, 0.0, 0.0, 0.0, 1.0, true}, {1.0 / 30, 3.25, -1.5, 0.125, 1.01, false}};
  sequence.truth.tools = {{false, 0, 0, 12.5, 30.0}, {true, 40.25, 50.5, 13.0, 30.0}};
  sequence.truth.vessels = cv::Mat_<std::uint8_t>(150, 200, std::uint8_t{3});
  sequence.truth.vessels_origin = {-20.5, -15.5};
  sequence.tool_cover = {0.0, 0.0125};
  sequence.condition = "laser";
  sequence.seed = 12345678901234ULL;
  sequence.zoom = 0.75;
  sequence.burns = {50, 75};
  return sequence;
}

std::string written(const support::TemporaryFolder& folder)
{
  OutputFolder out(folder.path("sequence"), {});
  writeTestSequence(example(), out);
  out.publish();
  return folder.path("sequence");
}

// The error's text after a file of a good sequence was replaced.
std::string errorWith(const std::string& name, const std::string& text)
{
  const support::TemporaryFolder folder;
  const std::string path = written(folder);
  std::ofstream(path + "/" + name) << text;
  try {
    readTestSequence(path);
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

TEST(TestSequence, ReadsBackWhatItWrote)
{
  const support::TemporaryFolder folder;
  const TestSequence sequence = readTestSequence(written(folder));
  EXPECT_EQ(sequence.truth.size, cv::Size(160, 120));
  EXPECT_EQ(sequence.truth.um_per_px, 5.25);
  ASSERT_TRUE(sequence.truth.rim.has_value());
  EXPECT_EQ(sequence.truth.rim->r, 88.0);
  ASSERT_EQ(sequence.truth.poses.size(), 2U);
  EXPECT_EQ(sequence.truth.poses[1].x_px, 3.25);
  EXPECT_EQ(sequence.truth.poses[1].theta_deg, 0.125);
  EXPECT_FALSE(sequence.truth.poses[1].visible);
  EXPECT_EQ(sequence.truth.tools[1].tip_y_px, 50.5);
  EXPECT_EQ(sequence.tool_cover[1], 0.0125);
  EXPECT_EQ(sequence.truth.vessels(149, 199), 3);
  EXPECT_EQ(sequence.truth.vessels_origin.x, -20.5);
  EXPECT_EQ(sequence.condition, "laser");
  EXPECT_EQ(sequence.seed, 12345678901234ULL);
  EXPECT_EQ(sequence.burns, (std::vector<int>{50, 75}));
}

TEST(TestSequence, NamesTheFileAndWhatIsWrongInIt)
{
  EXPECT_NE(errorWith("truth.csv", "frame,t_s\n0,0\n").find("truth.csv: no column"), std::string::npos);
  EXPECT_NE(errorWith("truth.csv", "frame,t_s\n0\n").find("fields"), std::string::npos);
  EXPECT_NE(errorWith("tool.csv", "frame,present,tip_x_px,tip_y_px,shaft_angle_deg,shaft_width_px\n0,x,0,0,0,0\n")
                .find("'x' is not a number"),
            std::string::npos);
  EXPECT_NE(errorWith("meta.json", "{").find("meta.json"), std::string::npos);
}

TEST(TestSequence, ReadsTheSharedOnes)
{
  const char* shared = std::getenv("EYESLAM_SHARED");
  const std::string folder = std::string(shared ? shared : "") + "/sequences/laser";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no sequences beside the project: " << folder;
  const TestSequence sequence = readTestSequence(folder);
  EXPECT_EQ(sequence.truth.poses.size(), 360U);
  EXPECT_EQ(sequence.burns.size(), 13U);
}

}  // namespace
}  // namespace eyeslam::files
