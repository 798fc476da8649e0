// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "support/live_record.h"

namespace eyeslam::support {

/// A fault of a live bench: what is shown before it, and what must be shown after it.
/// @tparam Bench  LiveBench or LiveChain
template <class Bench>
class LiveFaultOn : public testing::Test {
 protected:
  using ServoState = messaging::ServoState;
  using Status = HeardMessage<servo_status_t>;
  static constexpr double kSpeedLimit = 30e-3;  // m/s; of servo and manipulator, MICRON_STATE.speed_limit
  static constexpr double kRush = 18e-3;        // m/s: the servo's own limit, 20, which a step of its goal would reach
  static constexpr double kNoise = 3e-6;        // m, of a measured tip, an axis

  static bool isStopped(ServoState state) { return state == ServoState::hold || state == ServoState::fault; }

  /// Whether or not anybody could watch it.
  void TearDown() override
  {
    const double fastest = bench.takeFastestTip();
    if (fastest > 0.0) std::cout << "[ measured ] tip truly " << 1e3 * fastest << " mm/s in any ms\n";
    EXPECT_LE(fastest, kSpeedLimit);
  }

  /// The servo runs, and guides the tip.
  void begin(messaging::WantedMode mode)
  {
    servo = bench.startServo();
    ASSERT_TRUE(bench.runUntil([this] { return !bench.record.statuses.empty(); }, 10'000)) << servo->text();
    mode == messaging::WantedMode::laser ? bench.askLaser() : bench.askAssist();
    wanted = mode == messaging::WantedMode::laser ? ServoState::laser : ServoState::assist;
    bench.runUntil([this] { return bench.state() == wanted; }, 5000);
    ASSERT_NO_FATAL_FAILURE(settle()) << servo->text();
  }
  /// As long as a fault would need, without one: it stays as it is. A computer that stops for too long is a fault of
  /// its own; then once more.
  void settle(int milliseconds = 600)
  {
    for (int attempt = 0; attempt < 10; ++attempt) {
      bench.takeLongestPause();
      const std::int64_t start = bench.now.utime;
      bench.run(milliseconds);
      const auto said = bench.record.statuses.since(start);
      const bool stays = !said.empty() && std::all_of(said.begin(), said.end(), [this](const Status& status) {
        return status.value.state == wanted;
      });
      if (stays) return;
      const double lateness = longestLateness(said);
      ASSERT_TRUE(bench.takeLongestPause() > 20 || lateness > 20e-3)
          << "no fault, no pause, and yet: " << describe(bench.record.statuses.last());
      bench.rearm();
      bench.runUntil([this] { return bench.state() == wanted; }, 3000);
    }
    FAIL() << "this computer stops too often";
  }

  /// The fault comes now.
  void mark() { fault_utime = clocks().utime; }
  /// The servo stops, for this reason, and shows all that a stop must show. @return its first word of it
  std::optional<Status> expectStop(ServoState state, retina::Reason reason, int most_ms = 1000)
  {
    std::optional<Status> stop;
    bench.runUntil(
        [&] {
          for (const Status& status : bench.record.statuses.since(fault_utime)) {
            if (!isStopped(status.value.state)) continue;
            stop = status;
            break;
          }
          return stop.has_value();
        },
        most_ms);
    EXPECT_TRUE(stop) << "it goes on: " << describe(bench.record.statuses.last());
    if (!stop) return stop;
    EXPECT_EQ(stop->value.state, state) << describe(*stop);
    EXPECT_EQ(stop->value.reason, reason) << describe(*stop);
    std::cout << "[ measured ] " << 1e-3 * static_cast<double>(stop->header.utime_sent - fault_utime)
              << " ms after the fault: " << describe(*stop) << '\n';
    bench.run(400);  // the hand-over takes 150
    for (const Status& status : bench.record.statuses.since(stop->header.utime_sent)) {
      EXPECT_EQ(status.value.state, state) << describe(status);
    }
    expectLaserOff(stop->header.utime_sent);
    expectCalmTip();
    return stop;
  }

  /// A limit of an age, s, is passed in the very cycle that says so, by what the servo itself tells of its cycles.
  /// @param more  s by which what is limited may be older than this age
  void expectInTheCycleThatPasses(double limit, double age, const Status& stop, double more = 0.0) const
  {
    EXPECT_GT(age, limit - more);
    EXPECT_LE(age, limit + cycleOf(stop));
  }
  /// The longest that a cycle may have taken before this status, s.
  double cycleOf(const Status& stop) const
  {
    const Status* before = nullptr;
    for (const Status& status : bench.record.statuses.all()) {
      if (status.header.session == stop.header.session && status.header.seq < stop.header.seq) before = &status;
    }
    const std::int64_t left_out = before ? stop.value.overruns - before->value.overruns : 0;
    return 1.2e-3 + stop.value.lateness + 1e-3 * static_cast<double>(left_out);
  }

  /// From a time on nothing is asked of the laser, and 5 ms later it is dark.
  void expectLaserOff(std::int64_t utime) const
  {
    for (const auto& light : bench.record.lights.since(utime)) {
      EXPECT_EQ(light.value.action, messaging::LaserAction::off);
    }
    constexpr std::int64_t kExpiry_us = 5'000, kReport_us = 2'000;
    const auto told = bench.record.lasers.since(utime + kExpiry_us + kReport_us);
    EXPECT_FALSE(told.empty());
    for (const auto& laser : told) {
      EXPECT_FALSE(laser.value.aiming || laser.value.emitting)
          << 1e-3 * static_cast<double>(laser.header.utime_sent - utime) << " ms after it was put out";
    }
  }

  /// From just before the fault on the tip is never faster than it may be, and its goal never steps.
  void expectCalmTip() const
  {
    constexpr std::int64_t kBefore_us = 50'000;
    const auto states = bench.record.states.since(fault_utime - kBefore_us);
    ASSERT_GT(states.size(), 20U);
    constexpr std::int64_t kFresh_us = 100'000;
    EXPECT_TRUE(!has_states || bench.now.utime - states.back().came < kFresh_us) << "nobody has watched the tip";
    double fastest = 0.0, farthest = 0.0, fastest_goal = 0.0;
    constexpr std::size_t kMean = 5;
    for (std::size_t i = 2 * kMean; i < states.size(); ++i) {
      const double passed = 1e-6 * static_cast<double>(states[i].header.utime - states[i - 1].header.utime);
      const auto& before = states[i - 1].value;
      const auto& after = states[i].value;
      farthest = std::max(farthest, (after.tip.position - before.tip.position).norm() / std::max(passed, 1e-3));
      Eigen::Vector3d way = Eigen::Vector3d::Zero(), goal_way = Eigen::Vector3d::Zero();
      bool follows = true;
      for (std::size_t k = 0; k < kMean; ++k) {
        const messaging::MicronState &newer = states[i - k].value, &older = states[i - k - kMean].value;
        way += (newer.tip.position - older.tip.position) / kMean;
        goal_way += (newer.goal - older.goal) / kMean;
        follows = follows && newer.follows_command && older.follows_command;
      }
      const double time = 1e-6 * static_cast<double>(states[i].header.utime - states[i - kMean].header.utime);
      fastest = std::max(fastest, way.norm() / std::max(time, 5e-3));
      if (follows) fastest_goal = std::max(fastest_goal, goal_way.norm() / std::max(time, 5e-3));
    }
    std::cout << "[ measured ] tip " << 1e3 * fastest << " mm/s over 5 ms, " << 1e3 * farthest
              << " from state to state; goal " << 1e3 * fastest_goal << " mm/s over 5 ms\n";
    // 6 sigma of three axes, of the difference of two, a millisecond apart.
    const double noise = 6.0 * 1.73 * 1.41 * kNoise / 1e-3;
    EXPECT_LE(fastest, kSpeedLimit);
    EXPECT_LE(farthest, kSpeedLimit + noise);
    EXPECT_LE(fastest, kRush) << "a goal has stepped, and the tip is after it";
  }

  /// Nothing but the human's re-arming takes it out of there.
  void expectOnlyRearmingLeads(ServoState back)
  {
    const ServoState stopped = bench.state();
    bench.run(300);
    EXPECT_EQ(bench.state(), stopped) << "the fault has gone, but nobody re-armed";
    bench.rearm();
    EXPECT_TRUE(bench.runUntil([&] { return bench.state() == back; }, 3000)) << describe(bench.record.statuses.last());
  }

  static double longestLateness(const std::vector<Status>& said)
  {
    double longest = 0.0;
    for (const Status& status : said) longest = std::max(longest, status.value.lateness);
    return longest;
  }
  static std::string describe(const Status& status)
  {
    static constexpr std::array<const char*, 6> kStates{"standby", "ready", "assist", "laser", "hold", "fault"};
    const auto ms = [](double s) { return std::to_string(1e3 * s).substr(0, 6); };
    const messaging::ServoStatus& v = status.value;
    return std::string(kStates[static_cast<std::size_t>(v.state)]) + ' ' + std::string(retina::word(v.reason)) +
           " (ages, ms: pose " + ms(v.pose_age) + ", state " + ms(v.state_age) + ", operator " + ms(v.operator_age) +
           "; late " + ms(v.lateness) + ')';
  }

  Bench bench;
  std::unique_ptr<ChildProcess> servo;
  ServoState wanted = ServoState::laser;
  std::int64_t fault_utime = 0;
  bool has_states = true;  ///< false: MICRON_STATE itself is the fault
};

}  // namespace eyeslam::support
