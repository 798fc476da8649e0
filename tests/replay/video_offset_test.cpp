// SPDX-License-Identifier: GPL-3.0-or-later
// How far a video's clock is from its log's, found from what moves in both.
#include "eyeslam/replay/video_offset.h"

#include <gtest/gtest.h>

#include "eyeslam/micron_state_t.hpp"
#include "support/filmed_vision.h"

namespace eyeslam::replay {
namespace {

using support::FilmedVision;

constexpr double kFrame_s = 1.0 / FilmedVision::kRate;

const FilmedVision& filmed()
{
  static const FilmedVision vision;
  return vision;
}

std::optional<OffsetEstimate> offsetOf(const std::string& log_path, const std::vector<cv::Mat>& pictures,
                                       std::int64_t shift = 0)
{
  VideoOffset offset(FilmedVision::kRate, shift);
  SortedLog log(log_path);
  while (const auto event = log.next()) offset.take(*event);
  for (std::size_t i = 0; i < pictures.size(); ++i) offset.addPicture(static_cast<std::int64_t>(i), pictures[i]);
  return offset.estimate();
}

std::vector<cv::Mat> without(std::size_t first)
{
  return {filmed().pictures.begin() + static_cast<std::ptrdiff_t>(first), filmed().pictures.end()};
}

// Nothing of a port but its motion: an eye that turns moves it the other way, in other axes, by less.
std::string logOfPort(support::WrittenLog& written, double behind_s)
{
  for (int ms = 0; ms < 1500; ++ms) {
    micron_state_t state = support::headed<micron_state_t>(support::kLogStart + 1000 * ms, ms);
    const double frame = (1e-3 * ms - behind_s) * FilmedVision::kRate;
    const int before = static_cast<int>(std::floor(frame));
    const double share = frame - before;
    const cv::Point2d at =
        (1.0 - share) * cv::Point2d(FilmedVision::place(before)) + share * cv::Point2d(FilmedVision::place(before + 1));
    state.port_measured = 1;
    state.port_displacement[0] = -2e-6 * at.y;
    state.port_displacement[1] = 2e-6 * at.x;
    written.add(state, support::kLogStart + 1000 * ms);
  }
  return written.finish();
}

TEST(VideoOffset, IsNoneForTheVideoOfTheLog)
{
  const auto found = offsetOf(filmed().path, filmed().pictures);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->against, "RETINA_POSE");
  EXPECT_LT(std::abs(found->frames()), 0.25);
  EXPECT_TRUE(found->isCertain()) << found->correlation << " " << found->second << " " << found->sigma_s;
}

TEST(VideoOffset, IsWhatIsMissingAtTheBeginningWithinHalfAFrame)
{
  for (const std::size_t missing : {1, 7, 40}) {
    const auto found = offsetOf(filmed().path, without(missing));
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(found->offset_s, static_cast<double>(missing) * kFrame_s, 0.5 * kFrame_s) << missing;
    EXPECT_TRUE(found->isCertain()) << missing;
    const auto told = offsetOf(filmed().path, without(missing), static_cast<std::int64_t>(missing));
    ASSERT_TRUE(told.has_value());
    EXPECT_LT(std::abs(told->frames()), 0.5) << missing;
  }
}

TEST(VideoOffset, IsFoundWithinAFrameFromThePortAloneWhateverItsAxes)
{
  for (const double behind : {-12.7, -1.3, 0.0, 0.4, 5.3}) {
    support::WrittenLog written;
    const auto found = offsetOf(logOfPort(written, behind * kFrame_s), filmed().pictures);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->against, "port_displacement");
    EXPECT_NEAR(found->frames(), behind, 0.3);
    EXPECT_TRUE(found->isCertain()) << behind;
  }
}

TEST(VideoOffset, IsNotCertainOfAnotherVideo)
{
  std::vector<cv::Mat> backwards(filmed().pictures.rbegin(), filmed().pictures.rend());
  const auto found = offsetOf(filmed().path, backwards);
  EXPECT_TRUE(!found || !found->isCertain()) << found->correlation << " " << found->second << " " << found->sigma_s;
}

TEST(VideoOffset, IsUnknownWhereNothingMoves)
{
  const std::vector<cv::Mat> dark(100, cv::Mat::zeros(192, 256, CV_8UC3));
  EXPECT_FALSE(offsetOf(filmed().path, dark).has_value());
  support::WrittenLog empty;
  EXPECT_FALSE(offsetOf(empty.finish(), filmed().pictures).has_value());
}

}  // namespace
}  // namespace eyeslam::replay
