// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/micron_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/allocation_counter.h"

namespace eyeslam::simulation {
namespace {

constexpr double kPeriod_s = 1e-3;
const Eigen::Vector2d kPort(0.0, 0.0);

MicronOptions exact()
{
  MicronOptions options;
  options.gain_error = options.bend_um = options.noise_um = 0.0;
  return options;
}

TEST(MicronModel, FollowsASlowCommandByItsLead)
{
  MicronModel micron(exact(), 1);
  EXPECT_NEAR(micron.lead(), 4.785e-3, 1e-6);  // 2 ms + 1.4 / (2 pi 80 Hz), loop study, section 2
  double worst = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double now = i * kPeriod_s;
    const auto wave = [](double t) { return Eigen::Vector3d(5e-4 * std::sin(6.0 * t), 0.0, 0.0); };
    if (i > 500) worst = std::max(worst, (micron.tip() - wave(now)).norm());
    // Held from now on, it is meant for the middle of that time.
    micron.commandDeflection(wave(now + micron.lead()));
    micron.step(Eigen::Vector3d::Zero(), kPort);
  }
  EXPECT_LT(worst, 3e-6);  // of 500 um
}

TEST(MicronModel, SpeedAccelerationAndReachAreBounded)
{
  MicronModel micron(exact(), 1);
  Eigen::Vector3d last = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3000; ++i) {
    const double side = i / 400 % 2 == 0 ? 1.0 : -1.0;
    micron.commandDeflection(side * Eigen::Vector3d(5e-3, 3e-3, 1e-3));
    micron.step(Eigen::Vector3d::Zero(), kPort);
    const Eigen::Vector3d now = (micron.tip() - last) / kPeriod_s;
    EXPECT_LE(micron.tip().norm(), 2e-3 * (1.0 + 1e-9));
    EXPECT_LE(now.norm(), 30e-3 * (1.0 + 1e-9));
    // At the end of the reach it is stopped; elsewhere the actuators bound its acceleration.
    if (micron.tip().norm() < 1.99e-3) {
      EXPECT_LE((now - velocity).norm(), 10.0 * kPeriod_s * (1.0 + 1e-9)) << i;
    }
    velocity = now;
    last = micron.tip();
  }
  EXPECT_TRUE(micron.isSaturated());
}

TEST(MicronModel, AStateIsAMillisecondOldAndNoisyAsItSays)
{
  MicronModel micron({}, 7);
  double square = 0.0;
  for (int i = 1; i <= 4000; ++i) {
    const Eigen::Vector3d null(1e-6 * i, 0.0, 0.0);
    micron.step(null, kPort);
    if (i < 2) continue;
    EXPECT_EQ(micron.state().periods, i - 1);
    square += std::pow(micron.state().null.x() - 1e-6 * (i - 1), 2);
  }
  EXPECT_NEAR(std::sqrt(square / 4000.0), 3e-6, 0.2e-6);
}

TEST(MicronModel, WhereItSubtractsTheNullItUsesTheFreshOne)
{
  // A tip goal at rest: the deflection follows minus the null with the actuators' lag alone.
  MicronModel micron(exact(), 1);
  micron.commandTip(Eigen::Vector3d::Zero());
  const double speed = 1e-3;
  for (int i = 0; i < 200; ++i) micron.step(Eigen::Vector3d(speed * kPeriod_s * i, 0.0, 0.0), kPort);
  EXPECT_NEAR(micron.tip().x(), speed * micron.lead(), 0.1e-6);
}

TEST(MicronModel, NothingMeasuresTheBending)
{
  MicronOptions options = exact();
  options.bend_um = 6.0;
  options.state_age_ms = 0.0;
  MicronModel micron(options, 5);
  double square = 0.0;
  for (int i = 0; i < 20000; ++i) {
    micron.step(Eigen::Vector3d::Zero(), kPort);
    EXPECT_EQ(micron.state().tip, Eigen::Vector3d::Zero());
    square += micron.tip().squaredNorm() / 3.0;
  }
  EXPECT_NEAR(std::sqrt(square / 20000.0), 6e-6, 1.5e-6);  // 20 s of noise below 1 Hz
}

TEST(MicronModel, NeverAllocates)
{
  MicronModel micron({}, 1);
  const std::int64_t before = support::allocations();
  for (int i = 0; i < 100; ++i) {
    micron.commandTip({1e-4, 0.0, 0.0});
    micron.step(Eigen::Vector3d::Zero(), kPort);
  }
  EXPECT_EQ(support::allocations(), before);
}

}  // namespace
}  // namespace eyeslam::simulation
