// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "eyeslam/messaging/laser_messages.h"
#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/messaging/servo_messages.h"
#include "eyeslam/messaging/subscription.h"
#include "eyeslam/servo/servo.h"
#include "support/burn_scene.h"
#include "support/encoded_message.h"

namespace eyeslam::support {

/// A servo and all that speak with it, a millisecond a step: an obedient manipulator, a retina that is seen 15 ms late
/// 30 times a second, a human at his console. The manipulator's frame is the image's: x right, y down, z into the
/// retina, whose plane is z = 0; a px is 5 um.
class ServoBench {
 public:
  static constexpr std::int64_t kStart_us = 1'700'000'000'000'000;
  static constexpr double kM_per_px = 5e-6;
  static constexpr std::int64_t kMap = 7;
  static constexpr messaging::Key kKey{1, 2, 3};

  explicit ServoBench(const servo::ServoOptions& options = {}, const std::string& url = "memq://")
      : link(url, 99, kKey),
        states_(link),
        operators_(link),
        poses_(link),
        tips_(link),
        lasers_(link),
        statuses_(link, [this](const messaging::ServoStatus& status,
                               const messaging::MessageHeader&) { said.push_back(status); }),
        laser_commands_(link),
        servo(std::make_unique<servo::Servo>(options, link))
  {
    said.reserve(100'000);
    wish.map_id = kMap;
    laser.state.foot_switch = laser.state.armed = laser.state.interlock_closed = true;
  }

  static Eigen::Vector2d centre_px() { return {399.5, 303.5}; }
  static Eigen::Vector2d pixelOf(const Eigen::Vector3d& place) { return centre_px() + place.head<2>() / kM_per_px; }
  /// A place of the map's centre, moved by so many m.
  static Eigen::Vector2d mapPoint(double x, double y) { return centre_px() + Eigen::Vector2d(x, y) / kM_per_px; }

  /// The camera and the plane as they are.
  static servo::CalibrationResult calibration()
  {
    messaging::PublishedRegistration known;
    known.valid = true;
    known.samples = 200;
    known.image_T_manipulator << 1.0 / kM_per_px, 0, 0, centre_px().x(), 0, 1.0 / kM_per_px, 0, centre_px().y();
    known.row_covariance = Eigen::Matrix4d::Identity();
    known.row_covariance.diagonal() << 1e2, 1e2, 1e2, 1e-2;
    known.residual_px = 1.0;
    known.condition = 1.5;
    known.um_per_px = 1e6 * kM_per_px;
    servo::CalibrationResult result;
    result.camera = servo::resumed(known);
    result.plane = servo::RetinaPlane{-Eigen::Vector3d::UnitZ(), 0.0, 1e-6};
    result.reason = retina::Reason::none;
    result.plane_reason = retina::Reason::none;
    return result;
  }

  void step()
  {
    ++steps;
    now = {kStart_us + 1000 * steps, kStart_us + 1000 * steps};
    null = hand ? hand(time()) : Eigen::Vector3d(0.0, 0.0, -1e-3);
    if (controller_speaks) speak();
    if (laser_speaks && steps % 10 == 0) lasers_.publish(laser.state, now.utime, now.utime);
    if (operator_speaks && (steps % 50 == 1 || wishes_)) say();
    if (vision_speaks && steps % 33 == 0) see();
    link.drain(now);
    const messaging::LaserCommand* light = laser_commands_.inForce(now.monotonic);
    laser.step(light ? *light : messaging::LaserCommand(), 1e-3);
    if (before_cycle) before_cycle();
    servo->cycle(now, {});
    if (after_cycle) after_cycle();
    obey();
  }
  void run(int milliseconds)
  {
    for (int i = 0; i < milliseconds; ++i) step();
  }
  /// Steps until the state is this one. @return how many it took; -1: it never was
  int runUntil(servo::State wanted, int most)
  {
    for (int i = 0; i <= most; ++i) {
      if (state() == wanted) return i;
      step();
    }
    return -1;
  }
  /// The human says something new.
  void ask(const std::function<void(messaging::OperatorWish&)>& change)
  {
    change(wish);
    wishes_ = true;
  }
  void askMode(messaging::WantedMode mode)
  {
    ask([mode](messaging::OperatorWish& w) { w.mode = mode; });
  }
  void rearm()
  {
    ask([](messaging::OperatorWish& w) { ++w.rearmed; });
  }
  /// In Assist on a point, after everything has come to rest.
  void assist(const Eigen::Vector2d& point_px = mapPoint(100e-6, 50e-6))
  {
    servo->adopt(calibration(), kStart_us);
    ask([&](messaging::OperatorWish& w) {
      w.mode = messaging::WantedMode::assist;
      w.fixture.kind = messaging::FixtureKind::point;
      w.fixture.point_px = point_px;
    });
    run(1000);
  }

  double time() const { return 1e-3 * static_cast<double>(steps); }
  servo::State state() const { return static_cast<servo::State>(servo->status().state); }
  retina::Reason reason() const { return servo->status().reason; }
  Eigen::Vector2d retinaAt(double t) const { return retina ? retina(t) : Eigen::Vector2d::Zero(); }

  /// A message of another sender, whole: session, number and times are its own.
  template <class Message, class Value>
  Bytes foreign(const Value& value, std::int64_t session, std::int64_t seq, const messaging::Key& key = kKey) const
  {
    Message message{};
    messaging::write(value, message);
    message.utime = message.utime_sent = now.utime;
    message.session = session;
    message.seq = seq;
    return encodedMessage(message, key);
  }
  void put(const std::string& channel, const Bytes& bytes) { link.send(channel, bytes.data(), bytes.size()); }

  messaging::Link link;
  bool controller_speaks = true, operator_speaks = true, vision_speaks = true, laser_speaks = true;
  SimpleLaser laser;
  std::function<Eigen::Vector3d(double)> hand;    ///< its null; m
  std::function<Eigen::Vector2d(double)> retina;  ///< how far it has moved; m
  std::function<void()> before_cycle, after_cycle;
  std::function<void(micron_state_t&)> spoil_state;
  std::function<void(retina_pose_t&)> spoil_pose;
  messaging::OperatorWish wish;
  std::int64_t steps = 0;
  messaging::ReceiveTime now;
  Eigen::Vector3d null = Eigen::Vector3d::Zero(), tip = Eigen::Vector3d::Zero();
  std::vector<messaging::ServoStatus> said;

 private:
  void speak()
  {
    messaging::MicronState state;
    state.null.position = null;
    state.tip.position = tip_known_ ? tip : null;
    state.pose_measured = state.powered = true;
    state.goal = state.tip.position;
    micron_state_t message{};
    messaging::write(state, message);
    message.utime = now.utime;
    if (spoil_state) spoil_state(message);
    states_.publish(message, now.utime);
  }
  void say()
  {
    operators_.publish(wish, now.utime, now.utime);
    wishes_ = false;
  }
  void see()
  {
    const double t = time() - 15e-3;
    messaging::RetinaPose pose;
    pose.frame = {now.utime - 15'000, steps / 33, 8e-3};
    pose.map = {kMap, 1, 1e6 * kM_per_px};
    pose.motion.tracked = true;
    pose.motion.map_T_frame.x = -retinaAt(t).x() / kM_per_px;
    pose.motion.map_T_frame.y = -retinaAt(t).y() / kM_per_px;
    retina_pose_t message{};
    messaging::write(pose, message);
    message.utime = pose.frame.utime;
    if (spoil_pose) spoil_pose(message);
    poses_.publish(message, now.utime);
    messaging::InstrumentSight sight;
    sight.frame = pose.frame;
    sight.tip.present = true;
    sight.tip.position_px = pixelOf(seen_tip_);
    sight.tip.covariance = Eigen::Matrix2d::Identity();
    // The beam goes straight down.
    sight.spot = laser.state.aiming ? sight.tip : messaging::ImagePoint();
    tips_.publish(sight, pose.frame.utime, now.utime);
  }
  // The tip is there within the cycle.
  void obey()
  {
    const auto& motion = servo->motion();
    Eigen::Vector3d wanted = null;
    if (motion && motion->mode == messaging::MicronMode::follow)
      wanted = motion->reference == messaging::GoalReference::tip ? motion->goal : Eigen::Vector3d(null + motion->goal);
    tip = wanted;
    tip_known_ = true;
    if ((steps + 15) % 33 == 0) seen_tip_ = tip;
  }

  messaging::Publisher<micron_state_t> states_;
  messaging::Publisher<operator_t> operators_;
  messaging::Publisher<retina_pose_t> poses_;
  messaging::Publisher<tool_tip_t> tips_;
  messaging::Publisher<laser_state_t> lasers_;
  messaging::Subscription<servo_status_t> statuses_;
  messaging::Subscription<laser_command_t> laser_commands_;
  Eigen::Vector3d seen_tip_ = Eigen::Vector3d::Zero();
  bool tip_known_ = false;
  bool wishes_ = false;

 public:
  std::unique_ptr<servo::Servo> servo;
};

}  // namespace eyeslam::support
