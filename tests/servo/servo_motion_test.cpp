// SPDX-License-Identifier: GPL-3.0-or-later
// What the servo commands never steps, whatever happens, and a cycle costs no allocation.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "eyeslam/servo/servo.h"
#include "support/allocation_counter.h"
#include "support/sanitized.h"
#include "support/servo_bench.h"

using namespace eyeslam;
using messaging::FixtureKind;
using messaging::MicronMode;
using messaging::OperatorWish;
using messaging::WantedMode;
using servo::State;
using support::ServoBench;

namespace {

constexpr double kPeriod_s = 1e-3;

/// Asks for anything, breaks anything, mends it again.
class Chance {
 public:
  explicit Chance(unsigned seed) : random_(seed) {}

  void happen(ServoBench& bench)
  {
    switch (below(10)) {
      case 0:
        return bench.askMode(static_cast<WantedMode>(below(4)));
      case 1:
        return bench.rearm();
      case 2:
        return bench.ask([this](OperatorWish& w) { w.stop = below(4) == 0; });
      case 3:
        return fixture(bench);
      case 4:
        bench.controller_speaks = below(6) != 0;
        return;
      case 5:
        bench.vision_speaks = below(3) != 0;
        return;
      case 6:
        bench.operator_speaks = below(6) != 0;
        return;
      case 7:
        return place(bench);
      case 8:
        shift_px_ = 200.0 * (uniform() - 0.5);
        return;
      default:
        return mend(bench);
    }
  }
  double shift_px() const { return shift_px_; }

 private:
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
  double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }

  void fixture(ServoBench& bench)
  {
    constexpr FixtureKind kKinds[] = {FixtureKind::none,  FixtureKind::filter,   FixtureKind::scaling,
                                      FixtureKind::point, FixtureKind::standoff, FixtureKind::calibration};
    const FixtureKind kind = kKinds[below(6)];
    const Eigen::Vector2d point = ServoBench::mapPoint(2e-3 * (uniform() - 0.5), 2e-3 * (uniform() - 0.5));
    bench.ask([&](OperatorWish& w) {
      w.fixture = {};
      w.fixture.kind = kind;
      w.fixture.lambda = below(2) ? 0.0 : uniform();
      if (kind == FixtureKind::point) w.fixture.point_px = point;
      if (kind == FixtureKind::standoff) w.fixture.standoff = 2e-3 * uniform();
    });
  }
  void place(ServoBench& bench)
  {
    servo::CalibrationResult known = ServoBench::calibration();
    if (below(2)) known.plane->distance = 1e-4 * uniform();
    bench.servo->adopt(known, bench.now.utime);
  }
  void mend(ServoBench& bench)
  {
    bench.controller_speaks = bench.vision_speaks = bench.operator_speaks = true;
    bench.ask([](OperatorWish& w) {
      w.stop = false;
      w.mode = WantedMode::assist;
      ++w.rearmed;
    });
  }

  std::mt19937 random_;
  double shift_px_ = 0.0;
};

// The goal of the loop, in the manipulator's frame, between two cycles in which it was followed.
TEST(ServoMotion, TheGoalNeverStepsThroughAnySequenceOfStatesLossesAndPlacements)
{
  const servo::MotionLimiterOptions limits;
  const double fastest = 1e-3 * limits.speed_mm_s * (1.0 + 1e-9);
  const double hardest = limits.acceleration_m_s2 * (1.0 + 1e-6);
  int guided = 0, followed = 0;
  for (unsigned seed = 0; seed < (support::kSanitized ? 8U : 40U); ++seed) {
    ServoBench bench;
    Chance chance(seed);
    bench.hand = [](double t) {
      return Eigen::Vector3d(300e-6 * std::sin(2.0 * t) + 80e-6 * std::sin(60.0 * t), 200e-6 * std::sin(1.3 * t),
                             -1e-3 + 50e-6 * std::sin(55.0 * t));
    };
    bench.retina = [](double t) { return Eigen::Vector2d(300e-6 * std::sin(3.0 * t), 0.0); };
    bench.spoil_pose = [&chance](retina_pose_t& pose) { pose.x_px += chance.shift_px(); };
    bench.assist();
    Eigen::Vector3d goal = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();
    int follows = 0;  // cycles in a row
    for (int i = 0; i < 4000; ++i) {
      if (i % 40 == 0) chance.happen(bench);
      const Eigen::Vector3d tip = bench.tip;
      bench.step();
      const bool has_goal = bench.servo->motion() && bench.servo->motion()->mode == MicronMode::follow;
      follows = has_goal ? follows + 1 : 0;
      if (!has_goal) continue;
      const Eigen::Vector3d next = bench.servo->loop().last().goal;
      const Eigen::Vector3d now = (next - goal) / kPeriod_s;
      if (follows > 1) {
        ASSERT_LE(now.norm(), fastest) << seed << ' ' << i;
      }
      if (follows > 2) {
        ASSERT_LE((now - velocity).norm(), hardest * kPeriod_s) << seed << ' ' << i;
      }
      // It begins where the tip is; a state that came late is a millisecond or more of it.
      if (follows == 1) {
        ASSERT_LE((next - tip).norm(), 60e-6) << seed << ' ' << i;
      }
      goal = next;
      velocity = now;
      ++followed;
      if (bench.state() == State::assist) ++guided;
    }
  }
  EXPECT_GT(guided, 10'000 / (support::kSanitized ? 5 : 1));
  EXPECT_GT(followed, 30'000 / (support::kSanitized ? 5 : 1));
}

TEST(ServoMotion, FromReadyToAFarPointTheTipGoesSoftly)
{
  ServoBench bench;
  bench.assist(ServoBench::mapPoint(0.0, 0.0));
  bench.ask([](OperatorWish& w) {
    w.mode = WantedMode::ready;
    w.fixture.point_px = ServoBench::mapPoint(1e-3, 0.0);
  });
  bench.run(500);
  bench.askMode(WantedMode::assist);
  Eigen::Vector3d tip = bench.tip;
  double fastest = 0.0;
  for (int i = 0; i < 1000; ++i) {
    bench.step();
    fastest = std::max(fastest, (bench.tip - tip).norm() / kPeriod_s);
    tip = bench.tip;
  }
  EXPECT_NEAR(tip.x(), 1e-3, 2e-6);
  EXPECT_LT(fastest, 12e-3);
}

TEST(ServoMotion, ALostRetinaGivesTheTipBackToTheHand)
{
  ServoBench bench;
  bench.assist(ServoBench::mapPoint(500e-6, 0.0));
  ASSERT_NEAR(bench.tip.x(), 500e-6, 2e-6);
  bench.vision_speaks = false;
  bench.run(250 + 400);
  EXPECT_EQ(bench.state(), State::hold);
  EXPECT_LT((bench.tip - bench.null).norm(), 10e-6);
}

// LCM allocates for what it sends; the cycle nothing besides.
TEST(ServoMotion, ACycleAllocatesNothingButWhatSendingDoes)
{
  ServoBench bench;
  bench.assist();
  const support::Bytes bytes = bench.foreign<micron_command_t>(messaging::MicronCommand{}, 99, 0);
  std::int64_t before = support::allocations();
  bench.put("NOBODY_HEARS", bytes);
  const std::int64_t unheard = support::allocations() - before;
  before = support::allocations();
  bench.put("MICRON_COMMAND", bytes);
  const std::int64_t each = std::max(unheard, support::allocations() - before);
  bench.link.drain(bench.now);
  // Motion in every cycle; status, registration and a change of state in some.
  std::int64_t allocated = 0, cycles = 0;
  bench.before_cycle = [&] { allocated -= support::allocations(); };
  bench.after_cycle = [&] { allocated += support::allocations(); };
  for (int i = 0; i < 1500; ++i) {
    if (i == 700) bench.ask([](OperatorWish& w) { w.fixture.point_px.x() += 20.0; });
    if (i == 1000) bench.ask([](OperatorWish& w) { w.stop = true; });
    bench.step();
    ++cycles;
  }
  const std::int64_t statuses = 1500 / 20 + 3, registrations = 2;
  EXPECT_LE(allocated, each * (cycles + statuses + registrations));
}

}  // namespace
