// SPDX-License-Identifier: GPL-3.0-or-later
// eyeslam-track as a live process: a camera's driver writes shm:NAME, poses come back over LCM. EYESLAM_TRACK is the
// program.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "eyeslam/files/frame_ring.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/messaging/subscription.h"
#include "support/child_process.h"
#include "support/live_clock.h"
#include "support/moving_retina.h"
#include "support/temporary_folder.h"

namespace eyeslam {
namespace {

const std::string kProgram = EYESLAM_TRACK;
const cv::Size kView{400, 304};
constexpr double kUmPerPx = 10.4;  // so that the view is a microscope's

/// eyeslam-track on shm:NAME; killed at the end unless it has ended.
support::ChildProcess vision(const std::string& ring, const std::string& url, const std::string& folder,
                             const std::vector<std::string>& more, rlim_t file_limit = RLIM_INFINITY)
{
  std::vector<std::string> words = {kProgram, "shm:" + ring, "--out",        folder + "/out",
                                    "--lcm",  url,           "--no-overlay", "--quiet"};
  words.insert(words.end(), more.begin(), more.end());
  return {words, folder + "/output.txt", file_limit};
}

/// What was heard of one frame.
struct Heard {
  messaging::RetinaPose pose;
  std::int64_t latency = 0;  // us, from the picture's writing to the pose's sending
};

class LiveVision : public testing::Test {
 protected:
  void listen(int milliseconds)
  {
    const std::int64_t end = support::clockOf(CLOCK_MONOTONIC) + 1000 * milliseconds;
    for (std::int64_t left = 1; left > 0;) {
      left = (end - support::clockOf(CLOCK_MONOTONIC)) / 1000;
      link_.wait(static_cast<int>(std::max<std::int64_t>(left, 0)));
      link_.drain(support::clocks());
    }
  }

  /// Writes a picture and hears what comes within a frame's time.
  void show(const cv::Mat& picture)
  {
    const std::int64_t number = written_++;
    ASSERT_TRUE(ring_.write(picture, {number, support::clockOf(CLOCK_REALTIME), 5000}));
    listen(33);
  }
  void show(int pictures)
  {
    for (int i = 0; i < pictures; ++i) show(retina_.view(kView, {shown_, 0}, static_cast<unsigned>(shown_))), ++shown_;
  }
  /// Until the program has started: it takes the newest picture, whichever that is.
  void showUntilHeard()
  {
    for (int i = 0; i < 300 && heard_.empty(); ++i) show(1);
    ASSERT_FALSE(heard_.empty()) << "nothing was heard within 10 s";
  }
  std::int64_t count(retina::Reason reason) const
  {
    return std::count_if(heard_.begin(), heard_.end(),
                         [&](const Heard& heard) { return heard.pose.motion.reason == reason; });
  }

  support::TemporaryFolder folder_;
  std::string url_ = support::freeUrl();
  std::string ring_name_ = "eyeslam_live_" + std::to_string(getpid());
  files::FrameRingWriter ring_{ring_name_, {kView, CV_8UC3, 30.0}};
  support::MovingRetina retina_{kUmPerPx};
  messaging::Link link_{url_, 2, {}};
  std::vector<Heard> heard_;
  messaging::Subscription<retina_pose_t> poses_{
      link_, [this](const messaging::RetinaPose& pose, const messaging::MessageHeader& header) {
        heard_.push_back({pose, header.utime_sent - header.utime});
      }};
  std::int64_t written_ = 0;
  int shown_ = 0;
};

TEST_F(LiveVision, TellsThePoseOfThePictureWithThePicturesOwnTimeSoonAfterIt)
{
  support::ChildProcess program = vision(ring_name_, url_, folder_.path(""), {});
  showUntilHeard();
  show(60);
  std::vector<std::int64_t> latencies;
  for (const Heard& heard : heard_) {
    EXPECT_EQ(heard.pose.frame.exposure, 0.005);
    if (!heard.pose.motion.tracked) continue;
    latencies.push_back(heard.latency);
    EXPECT_NEAR(heard.pose.motion.map_T_frame.x,
                static_cast<double>(heard.pose.frame.frame - heard_[0].pose.frame.frame), 0.5);
  }
  ASSERT_GT(latencies.size(), 40U) << "of 60; a busy computer may miss some";
  std::sort(latencies.begin(), latencies.end());
  const std::int64_t median = latencies[latencies.size() / 2];
  RecordProperty("median_latency_us", std::to_string(median));
  std::cout << "from the picture's writing to its pose: median " << 1e-3 * static_cast<double>(median) << " ms, 95 % "
            << 1e-3 * static_cast<double>(latencies[latencies.size() * 95 / 100]) << " ms\n";
  EXPECT_LT(median, 100'000) << "the map is worked on, and nothing drawn or written, before a pose is told";
}

TEST_F(LiveVision, RefusesAPictureThatRepeatsAndGoesOn)
{
  support::ChildProcess program = vision(ring_name_, url_, folder_.path(""), {});
  showUntilHeard();
  show(10);
  EXPECT_EQ(count(retina::Reason::frozen), 0);
  const cv::Mat picture = retina_.view(kView, {shown_, 0}, 1);
  for (int i = 0; i < 10; ++i) show(picture);
  EXPECT_GE(count(retina::Reason::frozen), 5);
  show(10);
  EXPECT_TRUE(heard_.back().pose.motion.tracked);
}

TEST_F(LiveVision, EndsWithALastPoseThatSaysWhyWhenTheRecordingCannotBeWritten)
{
  constexpr rlim_t kLimit = 3'000'000;  // bytes: some 15 pictures
  support::ChildProcess program =
      vision(ring_name_, url_, folder_.path(""), {"--record", folder_.path("record.mkv")}, kLimit);
  showUntilHeard();
  for (int i = 0; i < 300 && count(retina::Reason::record_failed) == 0; ++i) show(1);
  ASSERT_EQ(count(retina::Reason::record_failed), 1);
  listen(300);
  EXPECT_EQ(heard_.back().pose.motion.reason, retina::Reason::record_failed) << "nothing after it";
  EXPECT_FALSE(heard_.back().pose.motion.tracked);
  EXPECT_EQ(program.wait(), 1);
  const std::string complaint = program.text();
  EXPECT_EQ(std::count(complaint.begin(), complaint.end(), '\n'), 1) << complaint;
  EXPECT_NE(complaint.find("record.mkv"), std::string::npos) << complaint;
}

TEST_F(LiveVision, KeepsItsResultsWhenThePicturesEnd)
{
  support::ChildProcess program = vision(ring_name_, url_, folder_.path(""), {"--timeout", "0.5"});
  showUntilHeard();
  show(5);
  EXPECT_EQ(program.wait(), 0);
  EXPECT_TRUE(std::ifstream(folder_.path("out/trajectory.csv")).good());
}

}  // namespace
}  // namespace eyeslam
