// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/plant_inverse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace eyeslam::servo {
namespace {

constexpr double kTwoPi = 2.0 * 3.14159265358979323846;
constexpr double kPeriod_s = 1e-3;

/// The plant that it is made for, in small steps.
struct Plant {
  double rate = kTwoPi * 80.0, damping = 0.7, place = 0.0, speed = 0.0;

  void hold(double command)
  {
    constexpr int kSteps = 100;
    for (int i = 0; i < kSteps; ++i) {
      speed += kPeriod_s / kSteps * (rate * rate * (command - place) - 2.0 * damping * rate * speed);
      place += kPeriod_s / kSteps * speed;
    }
  }
};

// RMS of the plant's error against a sine that it should show `lead` later.
double following(const PlantInverseOptions& options, double hz, double lead_s)
{
  PlantInverse inverse(options);
  Plant plant;
  double square = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double now = i * kPeriod_s;
    // What is held for a period is right in its middle.
    const double wanted = std::sin(kTwoPi * hz * (now + 0.5 * kPeriod_s + lead_s));
    plant.hold(inverse.shape({wanted, 0.0, 0.0}).x());
    if (i >= 1000) square += std::pow(plant.place - std::sin(kTwoPi * hz * (now + kPeriod_s)), 2);
  }
  return std::sqrt(square / 1000.0);
}

TEST(PlantInverse, ThePlantFollowsWithTheShorterLead)
{
  const PlantInverse inverse({});
  EXPECT_NEAR(inverse.plantLead(), 2.0 * 0.7 / (kTwoPi * 80.0), 1e-12);
  EXPECT_NEAR(inverse.lead(), 0.5 * inverse.plantLead(), 1e-12);
  for (const double hz : {1.0, 5.0, 10.0}) EXPECT_LT(following({}, hz, inverse.lead()), 0.01) << hz;
  // Without it that lead is too short: 1.4 ms of 10 Hz.
  PlantInverseOptions off;
  off.response_hz = 0.0;
  EXPECT_GT(following(off, 10.0, inverse.lead()), 0.05);
  EXPECT_LT(following(off, 10.0, inverse.plantLead()), 0.01);
}

TEST(PlantInverse, AtRestTheCommandIsTheDeflection)
{
  PlantInverse inverse({});
  Eigen::Vector3d command;
  for (int i = 0; i < 100; ++i) command = inverse.shape({1e-4, -2e-4, 5e-5});
  EXPECT_LT((command - Eigen::Vector3d(1e-4, -2e-4, 5e-5)).norm(), 1e-12);
  inverse.standAt({3e-4, 0.0, 0.0});
  EXPECT_LT((inverse.shape({3e-4, 0.0, 0.0}) - Eigen::Vector3d(3e-4, 0.0, 0.0)).norm(), 1e-12);
}

TEST(PlantInverse, AStepOvershootsNoMoreThanTheResponseItIsMadeToHave)
{
  PlantInverse inverse({});
  Plant plant;
  double highest = 0.0;
  for (int i = 0; i < 100; ++i) {
    plant.hold(inverse.shape({1.0, 0.0, 0.0}).x());
    highest = std::max(highest, plant.place);
  }
  // exp(-pi z / sqrt(1 - z^2)) = 4.6 % with z = 0.7, and what holding the command adds.
  EXPECT_LT(highest, 1.06);
}

}  // namespace
}  // namespace eyeslam::servo
