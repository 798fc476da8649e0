// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/simulation/retina_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "support/allocation_counter.h"

namespace eyeslam::simulation {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr double kMicro = 1e-6;
constexpr double kDegree = 3.14159265358979323846 / 180.0;

// Nothing moves but what a test turns on.
RetinaMotionOptions still()
{
  RetinaMotionOptions options = retinaMotionOptions("paper");
  options.speed_low_mm_s = options.speed_high_mm_s = 0.0;
  options.rotation_deg = options.jerk_rotation_deg = 0.0;
  return options;
}

std::vector<RetinaPose> recorded(RetinaMotion& retina, double seconds, const HandState& hand = {})
{
  std::vector<RetinaPose> poses;
  for (int i = 0; i < static_cast<int>(seconds / kPeriod_s); ++i) poses.push_back(retina.step(hand).world_T_retina);
  return poses;
}

double speedRms(const std::vector<RetinaPose>& poses)
{
  double square = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) square += (poses[i].shift - poses[i - 1].shift).squaredNorm();
  return std::sqrt(square / static_cast<double>(poses.size() - 1)) / kPeriod_s;
}

TEST(RetinaPose, ThereAndBackIsTheSamePlaceAndTheCentreOnlyMoves)
{
  const RetinaPose pose{{1e-3, 2e-3, 0.0}, {30e-6, -20e-6, 5e-6}, 0.3};
  const Eigen::Vector3d place(4e-3, -1e-3, -2e-4);
  EXPECT_TRUE(pose.toRetina(pose.toWorld(place)).isApprox(place));
  EXPECT_TRUE((pose.isometry() * place).isApprox(pose.toWorld(place)));
  EXPECT_TRUE(pose.toWorld(pose.centre).isApprox(pose.centre + pose.shift));
  // A quarter turn takes x to y, as in image axes.
  const RetinaPose quarter{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 90.0 * kDegree};
  EXPECT_TRUE(quarter.toWorld(Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY()));
}

TEST(RetinaMotion, IsTheIdentityAtTheStartWhateverItsKind)
{
  for (const char* name : retinaMotionNames()) {
    RetinaMotion retina(retinaMotionOptions(name), 3, {2e-3, 1e-3, 0.0});
    HandState hand;
    hand.tremor = {80e-6, -40e-6, 0.0};
    const RetinaPose& pose = retina.step(hand).world_T_retina;
    EXPECT_EQ(pose.shift.norm(), 0.0) << name;
    EXPECT_EQ(pose.theta, 0.0) << name;
  }
}

TEST(RetinaMotion, SmoothPartsHaveTheSpeedOfTheirSeed)
{
  for (const double share : {0.0, 0.7, 1.0}) {
    double square = 0.0;
    const int eyes = 12;
    for (int seed = 0; seed < eyes; ++seed) {
      RetinaMotionOptions options = still();
      options.speed_low_mm_s = 0.3;
      options.speed_high_mm_s = 0.8;
      options.hand_share = share;
      options.port_gain = 0.45;
      RetinaMotion retina(options, static_cast<std::uint64_t>(seed));
      EXPECT_GE(retina.smoothSpeed(), 0.3e-3);
      EXPECT_LE(retina.smoothSpeed(), 0.8e-3);
      square += std::pow(speedRms(recorded(retina, 30.0)) / retina.smoothSpeed(), 2) / eyes;
    }
    EXPECT_NEAR(std::sqrt(square), 1.0, 0.08) << share;  // some 500 independent values, two axes
  }
}

TEST(RetinaMotion, InSituMovesAtTheMeasuredSpeed)
{
  // Loop study, 1: 0.64 mm/s over all; U(0.3, 0.8) alone has an RMS of 0.57, the hand's tremor and travel add to it.
  double square = 0.0;
  const int eyes = 20;
  for (int seed = 0; seed < eyes; ++seed) {
    RetinaMotion retina(retinaMotionOptions("in_situ"), static_cast<std::uint64_t>(seed));
    square += std::pow(speedRms(recorded(retina, 10.0)), 2) / eyes;
  }
  EXPECT_NEAR(std::sqrt(square), 0.62e-3, 0.08e-3);
}

TEST(RetinaMotion, FollowsThePortTheOtherWayBehindTwoPoles)
{
  RetinaMotionOptions options = still();
  options.port_gain = 0.45;
  options.port_travel = 0.1;
  options.port_wander = 0.0;
  for (int seed = 0; seed < 20; ++seed) {
    RetinaMotion retina(options, static_cast<std::uint64_t>(seed));
    HandState hand;
    retina.step(hand);
    hand.travel = {1e-3, 0.0, 0.0};
    Eigen::Vector2d at_80_ms = Eigen::Vector2d::Zero();
    for (int i = 1; i <= 1000; ++i) {
      const RetinaState& state = retina.step(hand);
      EXPECT_NEAR(state.port.x(), 100.0 * kMicro, 1e-12);
      if (i == 80) at_80_ms = state.world_T_retina.shift.head<2>();
    }
    const Eigen::Vector2d end = retina.state().world_T_retina.shift.head<2>();
    const double gain = end.norm() / (100.0 * kMicro);
    EXPECT_GE(gain, 0.45 * 0.7 - 1e-6);
    EXPECT_LE(gain, 0.45 * 1.3 + 1e-6);
    EXPECT_NEAR(gain, retina.coupling().gain(), 1e-6);
    EXPECT_LE(std::abs(std::atan2(-end.y(), -end.x())), 20.0 * kDegree + 1e-9);
    EXPECT_NEAR(at_80_ms.norm() / end.norm(), 1.0 - 3.0 * std::exp(-2.0), 0.01);  // two poles of 40 ms after 80 ms
  }
}

TEST(RetinaMotion, ThePortHandsOnATenthOfTheTravelAndThreeTenthsOfTheTremor)
{
  RetinaMotionOptions options = still();
  options.port_gain = 0.45;
  options.port_tremor = RetinaMotionOptions().port_tremor;
  options.port_travel = RetinaMotionOptions().port_travel;
  RetinaMotion retina(options, 1);
  HandState hand;
  hand.tremor = {100e-6, 0.0, 0.0};
  hand.travel = {0.0, 2e-3, 0.0};
  EXPECT_TRUE(retina.step(hand).port.isApprox(Eigen::Vector2d(30e-6, 200e-6)));
}

TEST(RetinaMotion, TheCouplingWandersByTwelvePercentAndSmoothly)
{
  RetinaMotionOptions options = still();
  options.port_gain = 0.45;
  options.port_travel = 0.1;
  options.port_wander = 0.12;
  HandState hand;
  double square = 0.0;
  const int eyes = 300;
  for (int seed = 0; seed < eyes; ++seed) {
    RetinaMotion retina(options, static_cast<std::uint64_t>(seed));
    retina.step(hand);
    hand.travel = {1e-3, 0.0, 0.0};
    const auto poses = recorded(retina, 1.0, hand);
    const double gain = poses.back().shift.norm() / (100.0 * kMicro);
    square += std::pow(gain / retina.coupling().gain() - 1.0, 2) / eyes;
    EXPECT_LT((poses[900].shift - poses[899].shift).norm(), 0.05 * kMicro);
    hand.travel.setZero();
  }
  EXPECT_NEAR(std::sqrt(square), 0.12, 0.016);  // three sigma of 300 eyes
}

TEST(RetinaMotion, BreathesAndBeatsAtItsRatesAndPeaks)
{
  for (int seed = 0; seed < 20; ++seed) {
    Random random(static_cast<std::uint64_t>(seed), 1);
    const double hz = random.uniform(0.2, 1.3);
    const BodyCycle cycle(hz, 1 + seed % 3, random);
    double peak = 0.0;
    for (int i = 0; i < 5000; ++i) {
      peak = std::max(peak, std::abs(cycle.at(i * 1e-3)));
      EXPECT_NEAR(cycle.at(i * 1e-3), cycle.at(i * 1e-3 + 1.0 / hz), 1e-9);
    }
    EXPECT_NEAR(peak, 1.0, 1e-3);
  }
  RetinaMotionOptions options = still();
  options.breath_low_um = 40.0;
  options.breath_high_um = 120.0;
  options.breath_axial_um = 60.0;
  for (int seed = 0; seed < 20; ++seed) {
    RetinaMotion retina(options, static_cast<std::uint64_t>(seed));
    Eigen::Vector3d low = Eigen::Vector3d::Zero();
    Eigen::Vector3d high = Eigen::Vector3d::Zero();
    for (const RetinaPose& pose : recorded(retina, 5.0)) {
      low = low.cwiseMin(pose.shift);
      high = high.cwiseMax(pose.shift);
    }
    // From peak to peak: at most twice the peak, at least the peak of a lopsided wave and half of it.
    EXPECT_GE((high - low).head<2>().norm(), 1.5 * 40.0 * kMicro);
    EXPECT_LE((high - low).head<2>().norm(), 2.0 * 120.0 * kMicro);
    EXPECT_GE((high - low).z(), 1.5 * 60.0 * kMicro);
    EXPECT_LE((high - low).z(), 2.0 * 60.0 * kMicro);
  }
}

TEST(RetinaMotion, JerksComeAtTheirRateWithTheirLengthAndDuration)
{
  struct Demanded {
    const char* name;
    double per_s, shortest, longest, duration_s;
  };
  for (const Demanded& wanted : {Demanded{"jerky", 0.4, 0.2e-3, 0.6e-3, 0.1}, {"saccade", 0.3, 0.5e-3, 1.3e-3, 0.04}}) {
    EyeJerks jerks(retinaMotionOptions(wanted.name), 5);
    Eigen::Vector2d before = Eigen::Vector2d::Zero();
    double began = -1.0;
    int count = 0;
    const double seconds = 2000.0;
    for (int i = 0; i * kPeriod_s < seconds; ++i) {
      const Eigen::Vector2d last = jerks.ownWay();
      const bool was_under_way = jerks.inProgress();
      jerks.advance(i * kPeriod_s);
      if (jerks.inProgress() && !was_under_way) {
        before = last;
        began = i * kPeriod_s;
      }
      if (jerks.inProgress() || !was_under_way) continue;
      ++count;
      const double length = (jerks.ownWay() - before).norm();
      EXPECT_GE(length, wanted.shortest - 1e-9);
      EXPECT_LE(length, wanted.longest + 1e-9);
      EXPECT_NEAR(i * kPeriod_s - began, wanted.duration_s, 1.5e-3);
      EXPECT_LE(jerks.ownWay().norm(), 1.5e-3 + wanted.longest);
    }
    EXPECT_NEAR(count / seconds, wanted.per_s, 3.0 * std::sqrt(wanted.per_s / seconds)) << wanted.name;
  }
}

TEST(RetinaMotion, AJerkOfTheToolReachesTheEyeThroughThePort)
{
  RetinaMotionOptions options = retinaMotionOptions("jerky");
  options.tool_jerk_share = 1.0;
  options.speed_low_mm_s = options.speed_high_mm_s = 0.0;
  options.port_wander = 0.0;
  RetinaMotion retina(options, 2);
  HandState hand;
  while (!retina.jerks().inProgress()) retina.step(hand);
  const Eigen::Vector2d before = retina.state().world_T_retina.shift.head<2>();
  const Eigen::Vector2d port_before = retina.state().port;
  while (retina.jerks().inProgress()) retina.step(hand);
  const Eigen::Vector2d wanted = retina.jerks().toolWay();
  EXPECT_EQ(retina.jerks().ownWay().norm(), 0.0);
  EXPECT_NEAR((retina.state().port - port_before).norm() * retina.coupling().gain(), wanted.norm(), 1e-7);
  for (int i = 0; i < 400; ++i) retina.step(hand);
  // Breathing and pulse go on: up to 140 um within the half second.
  EXPECT_LT((retina.state().world_T_retina.shift.head<2>() - before - wanted).norm(), 140.0 * kMicro);
}

TEST(RetinaMotion, TurnsSlowlyByItsRms)
{
  RetinaMotionOptions options = still();
  options.rotation_deg = 0.5;
  double square = 0.0;
  const int eyes = 100;
  for (int seed = 0; seed < eyes; ++seed) {
    RetinaMotion retina(options, static_cast<std::uint64_t>(seed));
    const auto poses = recorded(retina, 12.0);
    square += std::pow(poses.back().theta, 2) / eyes;  // the difference of two independent values
    for (std::size_t i = 1; i < poses.size(); ++i) ASSERT_LT(std::abs(poses[i].theta - poses[i - 1].theta), 4e-5);
  }
  EXPECT_NEAR(std::sqrt(square), std::sqrt(2.0) * 0.5 * kDegree, 0.25 * 0.5 * kDegree * std::sqrt(2.0));
}

TEST(RetinaMotion, HasNoStepsThatASaccadeDoesNotHave)
{
  // A saccade of 1.3 mm in 40 ms: a smoothstep is at most 1.5 times as fast as its mean; 1 mm/s for the rest.
  for (const char* name : retinaMotionNames()) {
    RetinaMotion retina(retinaMotionOptions(name), 6);
    const auto poses = recorded(retina, 20.0);
    for (std::size_t i = 1; i < poses.size(); ++i) {
      ASSERT_LT((poses[i].shift - poses[i - 1].shift).norm(), (1.5 * 1.3e-3 / 40e-3 + 3e-3) * kPeriod_s) << name;
    }
  }
}

TEST(RetinaMotion, EqualSeedsAndHandsGiveEqualEyes)
{
  RetinaMotion a(retinaMotionOptions("jerky"), 9);
  RetinaMotion b(retinaMotionOptions("jerky"), 9);
  RetinaMotion other_hand(retinaMotionOptions("jerky"), 9);
  HandState hand;
  HandState shaking;
  for (int i = 0; i < 3000; ++i) {
    hand.travel.x() = i * 1e-7;
    shaking.tremor.x() = 100e-6 * std::sin(0.06 * i);
    const RetinaState& state = a.step(hand);
    EXPECT_EQ(state.world_T_retina.shift, b.step(hand).world_T_retina.shift);
    other_hand.step(shaking);
  }
  EXPECT_NE(a.state().world_T_retina.shift, other_hand.state().world_T_retina.shift);  // the eye answers to the hand
}

TEST(RetinaMotion, NeverAllocatesInAStep)
{
  RetinaMotion retina(retinaMotionOptions("jerky"), 2);
  Hand hand({}, Eigen::Vector3d::Zero(), 2);
  hand.step({}, HandTremor::Support::fixture);
  retina.step(hand.state());
  const auto before = support::allocations();
  for (int i = 0; i < 10000; ++i) retina.step(hand.step({}, HandTremor::Support::fixture));
  EXPECT_EQ(support::allocations(), before);
}

TEST(RetinaMotion, NamesWhatIsKnownWhenAskedForAnotherMotion)
{
  try {
    retinaMotionOptions("wild");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("wild"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("saccade"), std::string::npos);
  }
}

}  // namespace
}  // namespace eyeslam::simulation
