// SPDX-License-Identifier: GPL-3.0-or-later
// Both threads of eyeslam-servo in one process over UDP, for the thread sanitizer as much as for what they do: the loop
// hears a manipulator and a human, the patient thread prepares maps, and the controller gets the tip at the end.
#include <gtest/gtest.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <optional>
#include <string>
#include <thread>

#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/messaging/subscription.h"
#include "real_time/real_time_loop.h"
#include "servo/servo_desk.h"
#include "servo/servo_loop.h"

namespace eyeslam::apps {
namespace {

using messaging::Link;
using messaging::ReceiveTime;

std::int64_t clockOf(clockid_t id)
{
  timespec now{};
  clock_gettime(id, &now);
  return now.tv_sec * std::int64_t{1'000'000} + now.tv_nsec / 1000;
}
ReceiveTime now() { return {clockOf(CLOCK_MONOTONIC), clockOf(CLOCK_REALTIME)}; }

std::string url() { return "udpm://239.255.76.67:" + std::to_string(20'000 + ::getpid() % 40'000) + "?ttl=0"; }

bool canMulticast()
{
  try {
    const Link link(url(), 1, {});
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

/// A manipulator at rest and a human who wants Ready, in a thread of their own.
class Bench {
 public:
  Bench() : thread_({}, [this](const CycleStart& start) { return step(start); }) {}

  std::atomic<std::int64_t> commands{0};
  std::atomic<bool> last_was_tremor{false};

 private:
  bool step(const CycleStart& start)
  {
    link_.drain({start.monotonic, start.utime});
    if (commands_.accepted() > commands) {
      commands = commands_.accepted();
      last_was_tremor = commands_.latest()->mode == messaging::MicronMode::cancel_tremor;
    }
    messaging::MicronState state;
    state.pose_measured = state.powered = true;
    states_.publish(state, start.utime, start.utime);
    if (++steps_ % 50 != 0) return true;
    messaging::OperatorWish wish;
    wish.mode = messaging::WantedMode::ready;
    wishes_.publish(wish, start.utime, start.utime);
    return true;
  }

  Link link_{url(), 77, {}};
  messaging::Publisher<micron_state_t> states_{link_};
  messaging::Publisher<operator_t> wishes_{link_};
  messaging::Subscription<micron_command_t> commands_{link_};
  std::int64_t steps_ = 0;
  RealTimeLoop thread_;
};

/// A map with one vessel that is published over and over, newer each time.
class Vision {
 public:
  explicit Vision(Link& link) : poses_(link), tiles_(link)
  {
    map_.width = map_.height = 80;
    map_.probability.assign(6400, 0);
    map_.seen.assign(6400, 100);
    map_.calibre_px.assign(6400, 0);
    for (std::size_t x = 4; x < 76; ++x) {
      for (std::size_t y = 38; y < 42; ++y) map_.probability[80 * y + x] = 255;
    }
  }

  void show()
  {
    ++map_.version;
    const std::int64_t utime = now().utime;
    for (int i = 0; i < messaging::MapTileCycle::tiles(map_); ++i) {
      cycle_.next(map_, 9, utime, tile_);
      tile_.um_per_px = 5.0;
      tiles_.publish(tile_, utime);
    }
    messaging::RetinaPose pose;
    pose.frame = {utime, static_cast<std::int64_t>(map_.version), 0.0};
    pose.map = {9, static_cast<std::int64_t>(map_.version), 5.0};
    pose.motion.tracked = true;
    pose.motion.covariance = Eigen::Matrix3d::Identity();
    poses_.publish(pose, utime, utime);
  }

 private:
  messaging::Publisher<retina_pose_t> poses_;
  messaging::Publisher<vessel_map_t> tiles_;
  retina::VesselMap map_;
  messaging::MapTileCycle cycle_;
  vessel_map_t tile_{};
};

TEST(ServoThreads, RunBesideEachOtherUntilTheControllerHasTheTip)
{
  if (!canMulticast()) GTEST_SKIP() << "no multicast route here";
  servo::ServoConfiguration options;
  options.preparation.period_ms = 50.0;  // prepare often
  Link loop_link(url(), 5, {}), patient_link(url(), 5, {});
  ServoExchanges exchanges;
  CycleRecord record(10'000);
  ServoDesk desk(options, patient_link, exchanges, {[](const auto&) {}, [](const auto&) {}});
  ServoLoop loop(options.servo, loop_link, exchanges, false, record, now);
  RealTimeLoop thread({}, [&](const CycleStart& start) { return loop.cycle(start); });
  Bench bench;
  Vision vision(patient_link);
  messaging::ServoStatus status;
  bool was_ready = false;
  const auto work = [&] {
    vision.show();
    usleep(20'000);
    patient_link.drain(now());
    desk.work(now());
    exchanges.statuses.take(status);
    was_ready = was_ready || status.state == messaging::ServoState::ready;
  };
  for (int i = 0; i < 100; ++i) work();
  exchanges.closes = true;
  for (int i = 0; i < 200 && !thread.ended(); ++i) work();

  EXPECT_TRUE(thread.ended()) << "closing ends the loop once nothing is commanded";
  thread.join();
  usleep(20'000);
  EXPECT_TRUE(was_ready) << "the last state is " << static_cast<int>(status.state);
  EXPECT_GT(status.cycles, 100);
  EXPECT_GT(bench.commands, 100);
  EXPECT_TRUE(bench.last_was_tremor) << "the tip must be the controller's at the end";
}

}  // namespace
}  // namespace eyeslam::apps
