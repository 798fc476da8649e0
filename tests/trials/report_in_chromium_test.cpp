// SPDX-License-Identifier: GPL-3.0-or-later
// A report as a browser draws it. Chromium is no package of the project: where it is absent, this says so.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "eyeslam/files/whole_file.h"
#include "eyeslam/trials/trial_report.h"
#include "support/child_process.h"
#include "support/synthetic_trials.h"
#include "support/temporary_folder.h"

namespace eyeslam::trials {
namespace {

std::string chromium()
{
  std::istringstream folders(std::getenv("PATH") != nullptr ? std::getenv("PATH") : "");
  std::string folder;
  while (std::getline(folders, folder, ':'))
    for (const char* name : {"/chromium", "/chromium-browser", "/google-chrome"})
      if (access((folder + name).c_str(), X_OK) == 0) return folder + name;
  return {};
}

cv::Mat drawn(const std::string& program, const std::string& html)
{
  const support::TemporaryFolder folder;
  files::writeWholeFile(folder.path("report.html"), html);
  support::ChildProcess browser({program, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                                 "--window-size=1200,4000", "--user-data-dir=" + folder.path("profile"),
                                 "--screenshot=" + folder.path("report.png"), "file://" + folder.path("report.html")},
                                folder.path("log"));
  EXPECT_EQ(browser.wait(), 0);
  return cv::imread(folder.path("report.png"));
}

/// Pixels within 24 of a colour, in each channel.
int pixelsOf(const cv::Mat& picture, int red, int green, int blue)
{
  cv::Mat near;
  cv::inRange(picture, cv::Scalar(blue - 24, green - 24, red - 24), cv::Scalar(blue + 24, green + 24, red + 24), near);
  return cv::countNonZero(near);
}

TEST(ReportInChromium, ShowsTracesWarningsAndWords)
{
  const std::string program = chromium();
  if (program.empty()) GTEST_SKIP() << "SKIPPED: CHROMIUM IS NOT INSTALLED, so nobody looked at a report as drawn";
  support::SyntheticTrials make(4.0);
  std::vector<TrialRecord> records{make.traced("none", 0), make.traced("hard", 0)};
  records.back().events.push_back({1.0, "hold", "pose_stale", true});
  const cv::Mat picture = drawn(program, studyReport(records));
  ASSERT_EQ(picture.size(), cv::Size(1200, 4000));
  EXPECT_GT(pixelsOf(picture, 0xd5, 0x5e, 0x00), 2000) << "the unaided way";
  EXPECT_GT(pixelsOf(picture, 0x00, 0x72, 0xb2), 1000) << "the aided way";
  EXPECT_GT(pixelsOf(picture, 0x22, 0x22, 0x22), 2000) << "words";
  EXPECT_GT(pixelsOf(picture, 0xfd, 0xf1, 0xf0), 10000) << "the box of warnings";
  // The two upper panels show retina: neither paper nor one colour.
  cv::Mat lightness, share;
  cv::cvtColor(picture, lightness, cv::COLOR_BGR2GRAY);
  cv::inRange(lightness, 120, 240, share);
  EXPECT_GT(cv::countNonZero(share), 400'000);
}

}  // namespace
}  // namespace eyeslam::trials
