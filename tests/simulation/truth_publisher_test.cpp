// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/truth_publisher.h"

#include <gtest/gtest.h>

#include <cmath>

#include "eyeslam/messaging/subscription.h"
#include "eyeslam/messaging/truth_messages.h"

namespace eyeslam::simulation {
namespace {

constexpr std::int64_t kUtime = 1'700'000'000'123'000;

/// The retina turned by 90 degrees about (1, 2) mm and moved by (0.1, 0.2, 0.3) mm: a place (x, y) of the world is
/// (1 + (y - 2.2), 2 - (x - 1.1)) mm of the retina.
HardwareTruth quarterTurn()
{
  HardwareTruth truth;
  truth.eye.world_T_retina.centre = {1e-3, 2e-3, 0.0};
  truth.eye.world_T_retina.shift = {0.1e-3, 0.2e-3, 0.3e-3};
  truth.eye.world_T_retina.theta = M_PI / 2;
  truth.tip = {1.1e-3, 2.7e-3, -0.2e-3};
  truth.hand.null = {1.6e-3, 2.2e-3, 0.1e-3};
  truth.spot = {1.1e-3, 2.3e-3, 0.3e-3};
  truth.shaft = {0.6, 0.0, -0.8};
  truth.pivot_error = 7e-6;
  truth.jerked = {3e-6, -4e-6};
  truth.saturated = truth.emitting = true;
  return truth;
}

class PublishedTruth : public ::testing::Test {
 protected:
  const truth_t& published(const HardwareTruth& truth)
  {
    publisher.publish(truth, kUtime);
    link.drain({kUtime, kUtime});
    return *heard.latest();
  }

  messaging::Link link{"memq://", 3, std::nullopt};
  messaging::Subscription<truth_t> heard{link};
  TruthPublisher publisher{link, 4.0};
};

TEST_F(PublishedTruth, TellsPlacesInTheRetinasFrame)
{
  const truth_t& truth = published(quarterTurn());
  constexpr double kRounding = 1e-15;
  EXPECT_NEAR(truth.tip[0], 1.5e-3, kRounding);
  EXPECT_NEAR(truth.tip[1], 2.0e-3, kRounding);
  EXPECT_NEAR(truth.tip[2], -0.5e-3, kRounding);
  EXPECT_NEAR(truth.null[0], 1.0e-3, kRounding);
  EXPECT_NEAR(truth.null[1], 1.5e-3, kRounding);
  EXPECT_NEAR(truth.null[2], -0.2e-3, kRounding);
  EXPECT_NEAR(truth.spot[0], 1.1e-3, kRounding);
  EXPECT_NEAR(truth.spot[1], 2.0e-3, kRounding);
  // A direction turns, and does not move.
  EXPECT_NEAR(truth.shaft[0], 0.0, kRounding);
  EXPECT_NEAR(truth.shaft[1], -0.6, kRounding);
  EXPECT_NEAR(truth.shaft[2], -0.8, kRounding);
}

TEST_F(PublishedTruth, TellsWhatItWasGivenAndWhen)
{
  const truth_t& truth = published(quarterTurn());
  EXPECT_EQ(truth.utime, kUtime);
  EXPECT_EQ(truth.utime_sent, kUtime);
  EXPECT_EQ(truth.session, 3);
  EXPECT_EQ(truth.um_per_px, 4.0);
  EXPECT_EQ(truth.retina_centre[1], 2e-3);
  EXPECT_EQ(truth.retina_shift[2], 0.3e-3);
  EXPECT_EQ(truth.retina_theta, M_PI / 2);
  EXPECT_EQ(truth.pivot_error, 7e-6);
  EXPECT_EQ(truth.jerked[1], -4e-6);
  EXPECT_TRUE(truth.saturated);
  EXPECT_TRUE(truth.emitting);
  EXPECT_FALSE(truth.jerk);
}

TEST_F(PublishedTruth, HasNoFrameBeforeTheFirstAndKeepsTheNewestAfterIt)
{
  EXPECT_EQ(published(HardwareTruth{}).frame, -1);
  EXPECT_EQ(published(HardwareTruth{}).frame_utime, 0);
  // The retina moved by (40, -80) um at 4 um a px, turned by 0.1: the view goes the other way.
  RecordedView view({0.0, 0.0}, 4.0, 0.1);
  RetinaPose pose;
  pose.shift = {40e-6, -80e-6, 0.0};
  view.add(RetinaPose{});
  view.add(pose);
  FrameDue due{7, 1e-3, kUtime - 5000, 8e-3, view, {}, {}, false};
  publisher.expose(due);
  for (int i = 0; i < 2; ++i) {
    const truth_t& truth = published(HardwareTruth{});
    EXPECT_EQ(truth.frame, 7);
    EXPECT_EQ(truth.frame_utime, kUtime - 5000);
    EXPECT_NEAR(truth.frame_x_px, -10.0, 1e-9);
    EXPECT_NEAR(truth.frame_y_px, 20.0, 1e-9);
    EXPECT_EQ(truth.frame_theta, 0.0);
  }
}

}  // namespace
}  // namespace eyeslam::simulation
