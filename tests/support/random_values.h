// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "eyeslam/messaging/laser_messages.h"
#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/messaging/operator_messages.h"
#include "eyeslam/messaging/record_messages.h"
#include "eyeslam/messaging/retina_messages.h"
#include "eyeslam/messaging/servo_messages.h"

namespace eyeslam::support {

/// Possible values of what travels, every field of them drawn.
class RandomValues {
 public:
  explicit RandomValues(std::uint64_t seed) : random_(seed) {}

  double number(double lowest, double highest)
  {
    return std::uniform_real_distribution<double>(lowest, highest)(random_);
  }
  std::int64_t whole(std::int64_t lowest, std::int64_t highest)
  {
    return std::uniform_int_distribution<std::int64_t>(lowest, highest)(random_);
  }
  bool coin() { return whole(0, 1) == 1; }

  template <class Vector>
  Vector numbers(double lowest, double highest)
  {
    return Vector::NullaryExpr([&] { return number(lowest, highest); });
  }
  template <class Matrix>
  Matrix covariance()
  {
    const Matrix root = numbers<Matrix>(-3.0, 3.0);
    const Matrix product = root * root.transpose();
    return (product + product.transpose()) / 2.0;
  }
  retina::Reason reason() { return static_cast<retina::Reason>(whole(0, 100)); }

  void fill(messaging::MicronState& state)
  {
    for (messaging::ToolPose* pose : {&state.null, &state.tip, &state.handle}) *pose = toolPose();
    state.goal = numbers<Eigen::Vector3d>(-0.1, 0.1);
    state.port_measured = coin();
    state.port_displacement = numbers<Eigen::Vector3d>(-0.01, 0.01);
    state.abilities = {number(0.0, 0.1),  number(0.001, 0.01), number(0.001, 0.01),
                       number(100, 2000), number(0.001, 1),    number(0.1, 100)};
    state.limits = {coin(), coin(), coin(), coin(), coin()};
    state.pose_measured = coin();
    state.powered = coin();
    state.cancels_tremor = coin();
    state.follows_command = coin();
    state.keeps_pivot = coin();
    state.reason = reason();
    state.command_session = whole(-1000, 1000);
    state.command_seq = whole(-1, 1'000'000);
    for (std::int64_t& refused : state.commands_refused) refused = whole(0, 1000);
  }

  void fill(messaging::MicronCommand& command)
  {
    command.utime_image = whole(0, 2'000'000'000'000'000);
    command.mode = static_cast<messaging::MicronMode>(whole(0, 2));
    command.reference = static_cast<messaging::GoalReference>(whole(0, 1));
    command.goal.setZero();
    if (command.mode == messaging::MicronMode::follow) command.goal = numbers<Eigen::Vector3d>(-0.005, 0.005);
    command.keep_pivot = coin();
    command.pivot.setZero();
    if (command.keep_pivot) command.pivot = numbers<Eigen::Vector3d>(-0.1, 0.1);
    command.speed_bound = number(0.001, 0.2);
    command.expiry = number(0.01, 1.0);
  }

  void fill(messaging::LaserCommand& command)
  {
    command = {};
    command.utime_image = whole(0, 2'000'000'000'000'000);
    command.action = static_cast<messaging::LaserAction>(whole(0, 2));
    command.expiry = number(0.001, 1.0);
    if (command.action != messaging::LaserAction::fire) return;
    command.target = static_cast<int>(whole(0, 2000));
    command.pulse = whole(1, 10000);
    command.duration = number(0.001, 1.0);
    command.power = number(0.0, 10.0);
  }

  void fill(messaging::LaserState& state)
  {
    state = {coin(), coin(),           coin(),   coin(), coin(), whole(0, 1000), static_cast<int>(whole(-1, 1000)),
             coin(), number(0.0, 1.0), reason(), {}};
    for (std::int64_t& refused : state.commands_refused) refused = whole(0, 1000);
  }

  void fill(messaging::OperatorWish& wish)
  {
    wish = {};
    wish.mode = static_cast<messaging::WantedMode>(whole(0, 3));
    wish.stop = coin();
    wish.arm = coin();
    wish.rearmed = whole(0, 100);
    wish.map_id = whole(-1000, 1000);
    wish.fixture = fixture();
    wish.plan_approved = coin();
    if (wish.plan_approved) {
      for (std::uint8_t& byte : wish.plan_hash) byte = static_cast<std::uint8_t>(whole(0, 255));
    }
    wish.zones = static_cast<int>(whole(0, 8));
    for (int i = 0; i < wish.zones; ++i) {
      messaging::Zone& zone = wish.zone[static_cast<std::size_t>(i)];
      zone.corners = static_cast<int>(whole(3, 16));
      zone.corner_px.leftCols(zone.corners) =
          numbers<Eigen::Matrix<double, 2, 16>>(-3000, 3000).cast<float>().leftCols(zone.corners);
    }
  }

  void fill(messaging::PublishedRegistration& registration)
  {
    registration = {};
    registration.valid = coin();
    registration.reason = reason();
    registration.samples = whole(0, 1000);
    registration.image_T_manipulator = numbers<Eigen::Matrix<double, 2, 4>>(-3e5, 3e5);
    registration.row_covariance = covariance<Eigen::Matrix4d>();
    registration.residual_px = number(0.0, 5.0);
    registration.condition = number(1.0, 100.0);
    registration.um_per_px = number(1.0, 20.0);
    if (!coin()) return;
    registration.plane = {true, numbers<Eigen::Vector3d>(-1, 1).normalized(), number(-0.1, 0.1), number(0.0, 1e-4)};
  }

  void fill(messaging::ServoStatus& status)
  {
    status = {static_cast<messaging::ServoState>(whole(0, 5)),
              reason(),
              whole(-1000, 1000),
              coin(),
              number(-1, 10),
              number(-1, 10),
              number(-1, 10),
              number(-1, 10),
              number(-1, 10),
              number(0.0, 1.0),
              number(0.0, 1.0),
              whole(0, 1000),
              whole(0, 1000),
              whole(0, 1000),
              {}};
    for (std::int64_t& refused : status.messages_refused) refused = whole(0, 1000);
  }

  void fill(messaging::RetinaPose& pose)
  {
    pose.frame = frame();
    pose.map = {whole(-1000, 1000), whole(0, 1000), number(0.0, 20.0)};
    pose.motion.tracked = coin();
    pose.motion.reason = reason();
    pose.motion.map_T_frame = {number(-2000, 2000), number(-2000, 2000), number(-3.14, 3.14), number(0.5, 2.0)};
    pose.motion.velocity.setZero();
    if (pose.motion.tracked) pose.motion.velocity = numbers<Eigen::Vector3d>(-1000, 1000);
    pose.motion.covariance = covariance<Eigen::Matrix3d>();
  }

  void fill(messaging::InstrumentSight& sight)
  {
    sight = {};
    sight.frame = frame();
    if (coin()) {
      sight.tip = imagePoint();
      sight.shaft_angle = number(-3.14, 3.14);
      sight.shaft_width_px = number(1.0, 60.0);
    }
    if (coin()) sight.spot = imagePoint();
  }

  void fill(vessel_map_t& tile)
  {
    tile.map_id = whole(1, 3);
    tile.map_version = whole(0, 1000);
    tile.map_width = static_cast<std::int32_t>(whole(20, 300));
    tile.map_height = static_cast<std::int32_t>(whole(20, 300));
    tile.origin_x_px = number(-1000, 1000);
    tile.origin_y_px = number(-1000, 1000);
    tile.px_per_cell = number(0.5, 4.0);
    tile.um_per_px = number(0.0, 20.0);
    tile.width = static_cast<std::int32_t>(whole(1, 20));
    tile.height = static_cast<std::int32_t>(whole(1, 20));
    tile.column = static_cast<std::int32_t>(whole(0, tile.map_width - tile.width));
    tile.row = static_cast<std::int32_t>(whole(0, tile.map_height - tile.height));
    tile.cells = tile.width * tile.height;
    for (auto* cells : {&tile.probability, &tile.calibre_px, &tile.seen}) {
      cells->resize(static_cast<std::size_t>(tile.cells));
      for (std::uint8_t& cell : *cells) cell = static_cast<std::uint8_t>(whole(0, 255));
    }
  }

  void fill(burn_plan_t& plan)
  {
    plan.state = static_cast<std::int16_t>(whole(0, 1));
    plan.map_id = whole(0, 1000);
    plan.um_per_px = number(1.0, 20.0);
    plan.margin_um = number(0.0, 500.0);
    plan.localization_um = number(0.0, 500.0);
    plan.targets = static_cast<std::int32_t>(whole(0, 40));
    plan.target.resize(static_cast<std::size_t>(plan.targets));
    for (burn_target_t& target : plan.target) {
      target.id = static_cast<std::int32_t>(whole(0, 5000));
      target.state = static_cast<std::int16_t>(whole(0, 3));
      target.x_px = number(-2000, 2000);
      target.y_px = number(-2000, 2000);
      target.spot_um = number(50, 500);
      target.burn_um = target.spot_um + number(0, 100);
      target.duration = number(0.001, 1.0);
      target.power = number(0.0, 10.0);
      target.clearance_um = number(-100, 1000);
    }
  }

  void fill(mark_t& mark)
  {
    mark.kind = static_cast<std::int16_t>(whole(0, 2));
    for (std::string* text : {&mark.sender, &mark.version, &mark.configuration, &mark.configuration_hash, &mark.note}) {
      text->assign(static_cast<std::size_t>(whole(0, 100)), 'x');
    }
  }

 private:
  messaging::FrameStamp frame() { return {whole(1, 2'000'000'000'000'000), whole(0, 100'000), number(0.0, 0.1)}; }
  messaging::ImagePoint imagePoint()
  {
    return {true, numbers<Eigen::Vector2d>(-100, 2000), covariance<Eigen::Matrix2d>()};
  }
  messaging::ToolPose toolPose()
  {
    return {numbers<Eigen::Vector3d>(-0.1, 0.1), Eigen::Quaterniond(numbers<Eigen::Vector4d>(-1, 1).normalized())};
  }
  messaging::WantedFixture fixture()
  {
    messaging::WantedFixture fixture;
    fixture.kind = static_cast<messaging::FixtureKind>(whole(0, 6));
    fixture.lambda = number(0.0, 1.0);
    if (fixture.kind == messaging::FixtureKind::vessel) fixture.vessel = whole(0, 1000);
    if (fixture.kind == messaging::FixtureKind::point) fixture.point_px = numbers<Eigen::Vector2d>(-2000, 2000);
    if (fixture.kind == messaging::FixtureKind::standoff) fixture.standoff = number(0.0, 0.02);
    return fixture;
  }

  std::mt19937_64 random_;
};

}  // namespace eyeslam::support
