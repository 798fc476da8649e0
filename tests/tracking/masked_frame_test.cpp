// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/tracking/masked_frame.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/drawn_retina.h"

namespace eyeslam::tracking {
namespace {

using retina::Reason;
using support::DrawnRetina;

cv::Mat photograph()
{
  DrawnRetina retina(120, 100);
  retina.vessel(support::arc({60, 50}, 0.4, 0.0, 200), 4.0, 0.3);
  retina.rim({60, 50}, 55.0);
  return retina.photograph(1.5, 1);
}

TEST(MaskedFrame, IsTheFrameTheMaskAndTheContrastThatItsPartsGive)
{
  const support::PreparedFrame parts(photograph());
  MaskedFrame masked{TrackerOptions{}};
  ASSERT_EQ(masked.assign(photograph()), Reason::none);
  const auto& contrast = masked.contrast().contrast;
  EXPECT_TRUE(std::equal(contrast.begin(), contrast.end(), parts.frame.contrast().begin()));
  EXPECT_TRUE(std::equal(masked.mask().cells().begin(), masked.mask().cells().end(), parts.mask.cells().begin()));
  EXPECT_EQ(masked.size(), contrast.size());
}

TEST(MaskedFrame, SaysWhyAPictureCannotBeUsed)
{
  MaskedFrame masked{TrackerOptions{}};
  EXPECT_EQ(masked.assign(cv::Mat()), Reason::wrong_size);
  EXPECT_EQ(masked.assign(photograph()), Reason::none);
  EXPECT_EQ(masked.assign(photograph()(cv::Rect(0, 0, 200, 180))), Reason::wrong_size);
  EXPECT_EQ(masked.assign(cv::Mat(200, 240, CV_8UC3, cv::Scalar(2, 3, 5))), Reason::blackout);
  EXPECT_EQ(masked.assign(photograph()), Reason::none) << "the one before leaves nothing behind";
}

TEST(MaskedFrame, CallsDarkWhatItsOptionsCallDark)
{
  TrackerOptions strict;
  strict.localizer.least_red = 250;
  EXPECT_EQ(MaskedFrame(strict).assign(photograph()), Reason::blackout);
  strict = {};
  strict.localizer.least_visible = 0.999;
  EXPECT_EQ(MaskedFrame(strict).assign(photograph()), Reason::blackout) << "the rim hides more";
}

TEST(RefuseFrame, KeepsThePoseAndTakesBackTheRest)
{
  TrackResult result;
  result.tracked = true;
  result.map_T_frame.x = 5.0;
  result.velocity.setOnes();
  result.score = 0.7;
  EXPECT_EQ(&refuseFrame(result, Reason::ambiguous, 40), &result);
  EXPECT_FALSE(result.tracked);
  EXPECT_EQ(result.reason, Reason::ambiguous);
  EXPECT_EQ(result.map_T_frame.x, 5.0);
  EXPECT_EQ(result.velocity.norm(), 0.0);
  EXPECT_EQ(result.points, 40);
  EXPECT_EQ(result.score, 0.0);
}

}  // namespace
}  // namespace eyeslam::tracking
