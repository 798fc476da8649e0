// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/tracker_model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace eyeslam::simulation {
namespace {

TrackerModelOptions exact()
{
  TrackerModelOptions options;
  options.noise_um = options.bias_um = options.turn_noise_deg = options.blur_share = 0.0;
  options.outliers = options.tip_noise_um = 0.0;
  return options;
}

constexpr RegistrationErrorOptions kNoDrift{0.02, 1.0, 0.0, 10.0};

RetinaPose movedBy(double x) { return {Eigen::Vector3d::Zero(), {x, 0.0, 0.0}, 0.0}; }

/// Runs a retina of constant speed for 20 s; every frame goes to `see`.
template <class See>
void run(TrackerModel& tracker, double speed, See&& see)
{
  for (int i = 0; i < 20000; ++i) {
    const double t = 1e-3 * i;
    tracker.expose(t, movedBy(speed * t), {speed * t, 0.0, 0.0});
    if (const auto frame = tracker.ready(t)) see(t, *frame);
  }
}

TEST(TrackerModel, PosesComeAtTheCamerasRateWithItsLatencyAndSpeakOfMidExposure)
{
  TrackerModel tracker({}, exact(), kNoDrift, 3, Eigen::Vector2d::Zero());
  int frames = 0;
  run(tracker, 1e-3, [&](double t, const TrackedFrame& frame) {
    ++frames;
    EXPECT_TRUE(frame.tracked);
    EXPECT_GE(t - frame.mid_exposure_s, 14e-3);
    EXPECT_LE(t - frame.mid_exposure_s, 20e-3 + 1e-3);                         // the loop looks once a millisecond
    EXPECT_NEAR(frame.view_T_retina.x, 1e-3 * frame.mid_exposure_s, 0.51e-6);  // half a sample of 1 mm/s
    EXPECT_NEAR(frame.tip.x(), frame.view_T_retina.x, 1e-12);
  });
  EXPECT_NEAR(frames, 600, 2);
}

TEST(TrackerModel, ErrsAsMuchAsItsOptionsSay)
{
  TrackerModelOptions noisy = exact();
  noisy.noise_um = 2.0;
  TrackerModel tracker({1000.0, 1.0, 1.0, 1.0}, noisy, kNoDrift, 3, Eigen::Vector2d::Zero());
  double square = 0.0, count = 0.0;
  run(tracker, 0.0, [&](double, const TrackedFrame& frame) {
    square += frame.view_T_retina.y * frame.view_T_retina.y;
    count += 1.0;
  });
  EXPECT_NEAR(std::sqrt(square / count), 2e-6, 0.05e-6);
}

TEST(TrackerModel, RefusesFastFramesAndFlagsMostOutliers)
{
  TrackerModelOptions options = exact();
  TrackerModel fast({120.0, 4.0, 3.5, 5.0}, options, kNoDrift, 3, Eigen::Vector2d::Zero());
  int frames = 0, tracked = 0;
  run(fast, 15e-3, [&](double, const TrackedFrame& frame) {
    ++frames;
    tracked += frame.tracked ? 1 : 0;
  });
  EXPECT_NEAR(static_cast<double>(tracked) / frames, 0.2, 0.04);
  options.outliers = 0.2;
  TrackerModel wrong({120.0, 4.0, 3.5, 5.0}, options, kNoDrift, 3, Eigen::Vector2d::Zero());
  int outliers = 0, unflagged = 0;
  run(wrong, 0.0, [&](double, const TrackedFrame& frame) {
    const double off = std::hypot(frame.view_T_retina.x, frame.view_T_retina.y);
    EXPECT_EQ(frame.outlier, off > 99e-6);
    outliers += frame.outlier ? 1 : 0;
    unflagged += frame.outlier && frame.tracked ? 1 : 0;
  });
  EXPECT_NEAR(static_cast<double>(unflagged) / outliers, 0.1, 0.05);
}

TEST(TrackerModel, AWrongRegistrationIsATurnAndAScaleAboutTheImageCentre)
{
  const Eigen::Vector2d centre(1e-3, 2e-3);
  const Eigen::Matrix<double, 2, 3> map = wrongRegistration({}, 4, centre);
  EXPECT_LT((map * centre.homogeneous() - centre).norm(), 1e-15);
  const Eigen::Vector2d place = centre + Eigen::Vector2d(1e-3, 0.0);
  // 1 mm out: 20 um of scale and 17.5 um of turn, loop study, section 1.
  EXPECT_NEAR((map * place.homogeneous() - place).norm(), std::hypot(20e-6, 17.5e-6), 0.5e-6);
}

}  // namespace
}  // namespace eyeslam::simulation
