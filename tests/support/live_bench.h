// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <deque>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/servo/plan_messages.h"
#include "eyeslam/simulation/hardware.h"
#include "real_time/scheduling.h"
#include "support/burn_scene.h"
#include "support/child_process.h"
#include "support/encoded_message.h"
#include "support/live_clock.h"
#include "support/live_record.h"
#include "support/planning_maps.h"
#include "support/temporary_folder.h"
#include "support/true_registration.h"

namespace eyeslam::support {

/// eyeslam-servo as a process over UDP, and in this one all that speak with it: simulated hardware at 1 kHz, a vision
/// that knows the truth but for a tracker's noise and is 15 ms late 30 times a second, a human at his console, and one
/// who listens. Between the wire and the hardware commands may be held up. EYESLAM_SERVO is the program.
class LiveBench {
 public:
  static constexpr messaging::Key kKey{0x5a, 0x5a, 0x5a};
  static constexpr std::int64_t kMap = 7;

  LiveBench()
  {
    simulation::HardwareOptions options;
    const double m_per_px = 1e-6 * simulation::umPerPx(options.camera, kSeed);
    const cv::Point2d middle = simulation::imageCentre(options.camera);
    place_ = {m_per_px * middle.x + 0.3e-3, m_per_px * middle.y - 0.2e-3, -1e-3};
    hardware_.emplace(
        options, [this](double) { return task(); }, device_link_, kSeed);
    writeTrueRegistration(*hardware_, place_, folder_.path("camera.json"));
    writeKey(kKey, folder_.path("micron.key"));
    carryToDevices();
    carryFromDevices();
    map_ = emptyMap(200, 152, 4.0, hardware_->umPerPx());
    drawVessel(map_, {5.0, 5.0}, {195.0, 8.0}, 2.0);
    map_.version = 1;
    plan_ = servo::planMessage(planAbout(place_ / m_per_px), kMap);
    wish.map_id = kMap;
    next_us_ = clocks().monotonic;
  }
  LiveBench(const LiveBench&) = delete;
  LiveBench& operator=(const LiveBench&) = delete;

  std::unique_ptr<ChildProcess> startServo(const std::string& name = "servo") const
  {
    return std::make_unique<ChildProcess>(
        std::vector<std::string>{EYESLAM_SERVO, "--lcm", url_, "--key", folder_.path("micron.key"), "--registration",
                                 folder_.path("camera.json")},
        folder_.path(name + ".txt"));
  }

  /// A millisecond and more, where this process was late: the world makes up for what it missed.
  void step()
  {
    sleepUntil(next_us_);
    now = clocks();
    const std::int64_t passed = std::max<std::int64_t>(1, (now.monotonic - next_us_) / 1000 + 1);
    longest_pause_ = std::max(longest_pause_, passed);
    next_us_ += 1000 * passed;
    link.drain(now);
    deliver();
    device_link_.drain(now);
    for (std::int64_t i = std::min<std::int64_t>(passed, 200) - 1; i >= 0; --i) stepWorld(i);
    device_link_.drain(now);  // what the devices have said goes on the wire
    see();
    speak();
    if (each_step) each_step();
    record.drain(now);
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
  /// Longest since it was asked last, ms: a busy computer.
  std::int64_t takeLongestPause() { return std::exchange(longest_pause_, 0); }

  /// The tip's highest speed in any millisecond since it was asked last, as it really was; m/s.
  double takeFastestTip() { return std::exchange(fastest_tip_, 0.0); }

  void ask(const std::function<void(messaging::OperatorWish&)>& change)
  {
    change(wish);
    wishes_ = true;
  }
  void rearm()
  {
    ask([](messaging::OperatorWish& w) { ++w.rearmed; });
  }
  /// Everything that Laser asks for: an approved plan, armed.
  void askLaser()
  {
    ask([this](messaging::OperatorWish& w) {
      w.mode = messaging::WantedMode::laser;
      w.arm = w.plan_approved = true;
      w.plan_hash = servo::planHash(plan_);
    });
  }
  /// A fixture on the retina 0.1 mm beside where the hand is.
  void askAssist()
  {
    ask([this](messaging::OperatorWish& w) {
      w.mode = messaging::WantedMode::assist;
      w.fixture.kind = messaging::FixtureKind::point;
      w.fixture.point_px = (place_.head<2>() + Eigen::Vector2d(1e-4, 0.0)) * 1e6 / hardware_->umPerPx();
    });
  }

  messaging::ServoState state() const
  {
    return record.statuses.empty() ? messaging::ServoState::standby : record.statuses.last().value.state;
  }
  std::int64_t wishesSaid() const { return wish_publisher_.count(); }
  simulation::Hardware& hardware() { return *hardware_; }
  const std::string& url() const { return url_; }
  void put(const std::string& channel, const Bytes& bytes) { link.send(channel, bytes.data(), bytes.size()); }
  /// A message of any sender, whole, sent now.
  template <class Message, class Value>
  Bytes message(const Value& value, std::int64_t session, std::int64_t seq, const messaging::Key& key = kKey) const
  {
    Message message{};
    messaging::write(value, message);
    message.utime = message.utime_sent = clocks().utime;
    message.session = session;
    message.seq = seq;
    return encodedMessage(message, key);
  }

 private:
  static constexpr std::uint64_t kSeed = 3;
  static constexpr std::int64_t kLatency_us = 15'000;
  static constexpr std::int64_t kSession = 0x5e55101;

  TemporaryFolder folder_;
  std::string url_ = freeUrl();
  std::string not_in_real_time_ = apps::scheduleInRealTime(apps::kLoopPriority - 1);  // before LCM's threads

 public:
  messaging::Link link{url_, kSession, kKey};
  LiveRecord record{url_, kSession + 1'000'000, kKey};
  messaging::ReceiveTime now = clocks();
  messaging::OperatorWish wish;
  bool operator_speaks = true, vision_speaks = true, foot_switch = false;
  std::int64_t commands_held_us = 0;  ///< how long commands are on their way to the devices
  std::function<void(messaging::RetinaPose&)> spoil_pose;
  std::function<void()> each_step;
  std::map<std::string, Bytes> first_command;  ///< of each channel, as it came by

 private:
  struct OnItsWay {
    std::int64_t due;
    std::string channel;
    Bytes bytes;
  };

  simulation::SurgeonTask task() const
  {
    simulation::SurgeonTask task;
    task.target.position = place_;
    task.steers_null = true;
    task.switches.foot_switch = foot_switch;
    return task;
  }
  // A grid about a place, px; the middle first.
  fixtures::BurnPlan planAbout(const Eigen::Vector3d& place_px) const
  {
    fixtures::BurnPlan plan = linePlan(9, hardware_->umPerPx());
    for (std::size_t i = 0; i < plan.targets.size(); ++i) {
      const Eigen::Vector2d cell(static_cast<double>((i + 1) % 3) - 1.0, static_cast<double>((i / 3 + 1) % 3) - 1.0);
      plan.targets[i].position_px = place_px.head<2>() + 300.0 / hardware_->umPerPx() * cell;
      plan.targets[i].duration_ms = 100.0;
    }
    return plan;
  }

  void carryToDevices()
  {
    for (const char* channel : {"MICRON_COMMAND", "LASER_COMMAND"}) {
      link.lcm().subscribeFunction(channel, &LiveBench::hold, this)->setQueueCapacity(10'000);
    }
  }
  static void hold(const lcm::ReceiveBuffer* buffer, const std::string& channel, LiveBench* bench)
  {
    const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
    Bytes copy(bytes, bytes + buffer->data_size);
    bench->first_command.emplace(channel, copy);
    bench->on_their_way_.push_back({bench->now.monotonic + bench->commands_held_us, channel, std::move(copy)});
  }
  void deliver()
  {
    for (; !on_their_way_.empty() && on_their_way_.front().due <= now.monotonic; on_their_way_.pop_front()) {
      const OnItsWay& command = on_their_way_.front();
      device_link_.send(command.channel, command.bytes.data(), command.bytes.size());
    }
  }
  void carryFromDevices()
  {
    for (const char* channel : {"MICRON_STATE", "LASER_STATE"}) {
      device_link_.lcm().subscribeFunction(channel, &LiveBench::pass, this)->setQueueCapacity(10'000);
    }
  }
  static void pass(const lcm::ReceiveBuffer* buffer, const std::string& channel, LiveBench* bench)
  {
    bench->link.send(channel, static_cast<const std::uint8_t*>(buffer->data), buffer->data_size);
  }

  void stepWorld(std::int64_t milliseconds_ago)
  {
    hardware_->step({now.monotonic - 1000 * milliseconds_ago, now.utime - 1000 * milliseconds_ago});
    const Eigen::Vector3d& tip = hardware_->truth().tip;
    if (!last_tip_.isZero(0.0)) fastest_tip_ = std::max(fastest_tip_, (tip - last_tip_).norm() / 1e-3);
    last_tip_ = tip;
    if (auto due = hardware_->frameDue()) frames_.push_back(std::move(*due));
  }

  void see()
  {
    for (; !frames_.empty() && frames_.front().utime + kLatency_us <= now.utime; frames_.pop_front()) {
      if (vision_speaks) see(frames_.front());
    }
  }
  void see(const simulation::FrameDue& due)
  {
    const auto noise = [this](double sigma) { return std::normal_distribution<double>(0.0, sigma)(random_); };
    messaging::RetinaPose pose;
    pose.frame = {due.utime, due.frame, due.exposure};
    pose.map = {kMap, 1, hardware_->umPerPx()};
    pose.motion.tracked = true;
    pose.motion.map_T_frame = due.view.at(due.t_s);
    pose.motion.map_T_frame.x += noise(0.3);
    pose.motion.map_T_frame.y += noise(0.3);
    pose.motion.covariance.diagonal() << 0.09, 0.09, 1e-7;
    if (spoil_pose) spoil_pose(pose);
    poses_.publish(pose, due.utime, now.utime);
    messaging::InstrumentSight sight;
    sight.frame = pose.frame;
    sight.tip = {true, {due.tool.tool.tip.x + noise(0.5), due.tool.tool.tip.y + noise(0.5)}, 0.25 * unit()};
    sight.shaft_angle = due.tool.tool.shaft_angle;
    sight.shaft_width_px = 20.0;
    if (due.tool.aiming > 0.5) sight.spot = {true, {due.tool.spot.x, due.tool.spot.y}, 0.25 * unit()};
    sights_.publish(sight, due.utime, now.utime);
  }
  static Eigen::Matrix2d unit() { return Eigen::Matrix2d::Identity(); }

  void speak()
  {
    if (operator_speaks && (wishes_ || now.monotonic - said_at_ >= 50'000)) {
      wish_publisher_.publish(wish, now.utime, now.utime);
      said_at_ = now.monotonic;
      wishes_ = false;
    }
    if (now.monotonic - told_at_ < 500'000) return;
    told_at_ = now.monotonic;
    plan_.utime = now.utime;
    plan_publisher_.publish(plan_, now.utime);
    messaging::MapTileCycle cycle;
    for (int i = 0; i < messaging::MapTileCycle::tiles(map_); ++i) {
      if (cycle.next(map_, kMap, now.utime, tile_)) tile_publisher_.publish(tile_, now.utime);
    }
  }

  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();     // of the hand, retina frame, m
  Eigen::Vector3d last_tip_ = Eigen::Vector3d::Zero();  // a millisecond ago
  double fastest_tip_ = 0.0;
  messaging::Link device_link_{"memq://", kSession, kKey};
  std::optional<simulation::Hardware> hardware_;
  std::deque<OnItsWay> on_their_way_;
  std::deque<simulation::FrameDue> frames_;
  std::mt19937 random_{1};
  messaging::Publisher<retina_pose_t> poses_{link};
  messaging::Publisher<tool_tip_t> sights_{link};
  messaging::Publisher<operator_t> wish_publisher_{link};
  messaging::Publisher<burn_plan_t> plan_publisher_{link};
  messaging::Publisher<vessel_map_t> tile_publisher_{link};
  retina::VesselMap map_;
  burn_plan_t plan_;
  vessel_map_t tile_{};
  bool wishes_ = false;
  std::int64_t said_at_ = 0, told_at_ = 0, next_us_ = 0, longest_pause_ = 0;
};

}  // namespace eyeslam::support
