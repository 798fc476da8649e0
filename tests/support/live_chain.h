// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/simulation/hardware.h"
#include "support/child_process.h"
#include "support/live_clock.h"
#include "support/live_record.h"
#include "support/temporary_folder.h"
#include "support/true_registration.h"

namespace eyeslam::support {

/// The whole chain as processes: eyeslam-sim, eyeslam-track on its frames, eyeslam-servo; here is the human, and one
/// who listens. EYESLAM_SIM, EYESLAM_TRACK and EYESLAM_SERVO are the programs.
class LiveChain {
 public:
  LiveChain() { writeKey(kKey, folder_.path("micron.key")); }

  /// @param arguments  more of them, for the simulator
  void startSimulator(const std::vector<std::string>& arguments)
  {
    std::vector<std::string> words = {EYESLAM_SIM, "--live", "--shm", ring_,    "--size",
                                      "400x304",   "--seed", "2",     "--task", "hold"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    sim_ = start(words, "sim.txt");
    ASSERT_TRUE(runUntil([this] { return !record.states.empty(); }, 30'000)) << sim_->text();
  }
  void startTracker(const std::vector<std::string>& arguments, rlim_t file_limit = RLIM_INFINITY)
  {
    std::vector<std::string> words = {EYESLAM_TRACK, "shm:" + ring_, "--out", folder_.path("out"), "--no-overlay"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    track_ = start(words, "track.txt", file_limit);
    const auto tracks = [this] { return !record.poses.empty() && record.poses.last().value.motion.tracked; };
    ASSERT_TRUE(runUntil(tracks, 20'000)) << track_->text();
  }
  std::unique_ptr<ChildProcess> startServo()
  {
    simulation::HardwareOptions options;
    options.camera.width = 400;
    options.camera.height = 304;
    messaging::Link nowhere("memq://", 1, kKey);
    const simulation::Hardware same(options, simulation::holdPlace(Eigen::Vector3d(0.0, 0.0, -1e-3)), nowhere, 2);
    image_T_manipulator_ = writeTrueRegistration(same, Eigen::Vector3d(2e-3, 1.5e-3, 0.0), folder_.path("camera.json"));
    return start({EYESLAM_SERVO, "--registration", folder_.path("camera.json"), "--set", "image_width_px=400", "--set",
                  "image_height_px=304"},
                 "servo.txt");
  }
  ChildProcess& tracker() { return *track_; }
  std::string path(const std::string& name) const { return folder_.path(name); }

  void step()
  {
    sleepUntil(next_us_);
    now = clocks();
    longest_pause_ = std::max(longest_pause_, (now.monotonic - next_us_) / 1000 + 1);
    next_us_ = now.monotonic + 1000;
    record.drain(now);
    if (!wishes_ && now.monotonic - said_at_ < 50'000) return;
    wish_publisher_.publish(wish, now.utime, now.utime);
    said_at_ = now.monotonic;
    wishes_ = false;
  }
  void run(int milliseconds)
  {
    const std::int64_t end = clocks().monotonic + 1000 * std::int64_t{milliseconds};
    while (next_us_ < end) step();
  }
  bool runUntil(const std::function<bool()>& condition, int most_ms)
  {
    const std::int64_t end = clocks().monotonic + 1000 * std::int64_t{most_ms};
    while (!condition() && next_us_ < end) step();
    return condition();
  }
  double takeFastestTip() { return 0.0; }  ///< nobody knows the truth here
  /// Longest since it was asked last, ms.
  std::int64_t takeLongestPause() { return std::exchange(longest_pause_, 0); }

  void ask(const std::function<void(messaging::OperatorWish&)>& change)
  {
    change(wish);
    wishes_ = true;
  }
  void rearm()
  {
    ask([](messaging::OperatorWish& w) { ++w.rearmed; });
  }
  /// The tip stays over the point of the retina where it is.
  void askAssist()
  {
    const Eigen::Vector2d centre_px(199.5, 151.5);
    const Eigen::Vector3d tip = record.states.last().value.tip.position;
    const messaging::RetinaPose& pose = record.poses.last().value;
    const Eigen::Vector2d seen_px = image_T_manipulator_ * tip.homogeneous();
    ask([&](messaging::OperatorWish& w) {
      w.mode = messaging::WantedMode::assist;
      w.map_id = pose.map.id;
      w.fixture.kind = messaging::FixtureKind::point;
      w.fixture.point_px = centre_px + pose.motion.map_T_frame * (seen_px - centre_px);
    });
  }
  void askLaser() {}
  messaging::ServoState state() const
  {
    return record.statuses.empty() ? messaging::ServoState::standby : record.statuses.last().value.state;
  }

 private:
  static constexpr messaging::Key kKey{0x5a, 0x5a, 0x5a};
  static constexpr std::int64_t kSession = 0x5e55102;

  std::unique_ptr<ChildProcess> start(std::vector<std::string> words, const std::string& output,
                                      rlim_t file_limit = RLIM_INFINITY) const
  {
    words.insert(words.end(), {"--lcm", url_, "--key", folder_.path("micron.key")});
    return std::make_unique<ChildProcess>(std::move(words), folder_.path(output), file_limit);
  }

  TemporaryFolder folder_;
  std::string url_ = freeUrl();
  std::string ring_ = "eyeslam_chain_" + std::to_string(getpid());
  messaging::Link link_{url_, kSession, kKey};
  messaging::Publisher<operator_t> wish_publisher_{link_};

 public:
  LiveRecord record{url_, kSession + 1, kKey};
  messaging::ReceiveTime now = clocks();
  messaging::OperatorWish wish;

 private:
  std::unique_ptr<ChildProcess> sim_, track_;
  Eigen::Matrix<double, 2, 4> image_T_manipulator_ = Eigen::Matrix<double, 2, 4>::Zero();
  bool wishes_ = false;
  std::int64_t said_at_ = 0, next_us_ = clocks().monotonic, longest_pause_ = 0;
};

}  // namespace eyeslam::support
