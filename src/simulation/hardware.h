// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "eyeslam/messaging/laser_messages.h"
#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/messaging/subscription.h"
#include "eyeslam/simulation/frame_shutter.h"
#include "eyeslam/simulation/hand.h"
#include "eyeslam/simulation/hardware_fault.h"
#include "eyeslam/simulation/hardware_options.h"
#include "eyeslam/simulation/laser_device.h"
#include "eyeslam/simulation/micron_controller.h"
#include "eyeslam/simulation/retina_motion.h"
#include "eyeslam/simulation/traced_path.h"

namespace eyeslam::simulation {

/// What the surgeon is about at an instant.
struct SurgeonTask {
  PathTarget target;  ///< where he wants the tip, and how fast that moves along its path; retina frame, m, m/s
  HandTremor::Support support = HandTremor::Support::none;  ///< whether a fixture holds the tip, so that he leans on it
  bool steers_null = false;  ///< he keeps the null at the target, not the tip: a pattern is burnt around it
  LaserSwitches switches;
};
using SurgeonTaskAt = std::function<SurgeonTask(double t_s)>;

/// Hold one place of the retina, m.
SurgeonTaskAt holdPlace(const Eigen::Vector3d& place);

/// A pulse that was really emitted.
struct PulseTruth {
  std::int64_t pulse = 0;  ///< as commanded
  int target = -1;
  double start_s = 0.0, duration = 0.0, power = 0.0;      ///< s, s, W
  Eigen::Vector3d spot_retina = Eigen::Vector3d::Zero();  ///< mean over the pulse, m
  Eigen::Vector3d first_retina = Eigen::Vector3d::Zero(), last_retina = Eigen::Vector3d::Zero();
};

/// Everything as it is; for scores. World's frame and m unless said.
struct HardwareTruth {
  double t_s = 0.0;  ///< since the first step
  RetinaState eye;   ///< world_T_retina; the port's displacement
  HandState hand;    ///< its null is the manipulator's
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  Eigen::Vector3d shaft = Eigen::Vector3d::Zero();  ///< unit vector from the tip up the shaft
  Eigen::Vector3d port = Eigen::Vector3d::Zero();
  Eigen::Vector3d spot = Eigen::Vector3d::Zero();  ///< where the beam meets the retina's surface
  double pivot_error = 0.0;  ///< of the shaft from the commanded remote centre of motion; 0 while none is kept
  double port_error = 0.0;   ///< of the shaft from the middle of the port: what the sclera feels
  bool saturated = false;    ///< the commanded deflection is out of reach
  bool jerk = false;         ///< a jerk or saccade is in progress
  Eigen::Vector2d jerked = Eigen::Vector2d::Zero();   ///< what jerks have moved so far
  Eigen::Vector2d picture = Eigen::Vector2d::Zero();  ///< how far the picture has wandered
  bool aiming = false, emitting = false;

  Eigen::Vector3d tipRetina() const { return eye.world_T_retina.toRetina(tip); }
  Eigen::Vector3d nullRetina() const { return eye.world_T_retina.toRetina(hand.null); }
  Eigen::Vector3d spotRetina() const { return eye.world_T_retina.toRetina(spot); }
};

/// How the manipulator's frame lies in the world, by its placement alone.
Eigen::Isometry3d manipulatorTWorld(const PlacementOptions& options);

/// Eye, hand, manipulator, laser and the camera's shutter at 1 kHz, behind the messages of real ones: hears
/// MICRON_COMMAND and LASER_COMMAND, speaks MICRON_STATE and, at 100 Hz and on change, LASER_STATE. Reads no clock:
/// lock step and real time differ by who calls. Two runs with one seed and the same commands are the same to the byte.
///
///   Hardware hardware(options, holdPlace(place), link, seed);
///   EyeCamera camera(options.camera, fundus, seed);
///   each millisecond:
///     link.drain(now);
///     hardware.step(now);
///     if (const auto due = hardware.frameDue()) show(camera.render(*due));
///
/// World's frame: at the start one with the retina frame; x, y = image px x m per px (without the picture's wandering),
/// x right and y down, z into the retina.
class Hardware {
 public:
  /// @param task  the surgeon's; called once a step with rising times
  /// @throws std::runtime_error as messaging::Subscription
  Hardware(const HardwareOptions& options, SurgeonTaskAt task, messaging::Link& link, std::uint64_t seed);

  /// One millisecond later; the first call is t = 0.
  /// @param now  by the caller's clocks; `now.utime` is when the states are sent
  void step(const messaging::ReceiveTime& now);
  /// The frame whose exposure ended in the last step.
  std::optional<FrameDue> frameDue();

  void inject(HardwareFault fault);
  void mend(HardwareFault fault);
  void setTask(SurgeonTaskAt task) { task_ = std::move(task); }

  const HardwareTruth& truth() const { return truth_; }
  /// In the order in which they began; the last one may go on.
  const std::vector<PulseTruth>& pulses() const { return pulses_; }
  const Eigen::Isometry3d& manipulatorTWorld() const { return manipulator_T_world_; }
  double umPerPx() const { return um_per_px_; }
  const messaging::MicronState& micronState() const { return controller_.state(); }
  const messaging::LaserState& laserState() const { return laser_.state(); }
  const MicronController& controller() const { return controller_; }

 private:
  bool has(HardwareFault fault) const { return faults_[static_cast<std::size_t>(fault)]; }
  HeldManipulator held() const;
  void moveHand(const SurgeonTask& task);
  void lookAround();
  void fire(LaserSwitches switches, const messaging::ReceiveTime& now);
  void publish(const messaging::ReceiveTime& now);
  void publishMicron(std::int64_t utime);
  void publishLaser(std::int64_t utime);
  void expose(const messaging::ReceiveTime& now);
  void restart();

  messaging::Link& link_;
  double um_per_px_;
  Eigen::Isometry3d manipulator_T_world_;
  SurgeonTaskAt task_;
  Hand hand_;
  RetinaMotion retina_;
  MicronController controller_;
  LaserDevice laser_;
  FrameShutter shutter_;
  Eigen::Vector3d port_at_rest_;
  std::optional<messaging::Subscription<micron_command_t>> micron_commands_;
  messaging::Subscription<laser_command_t> laser_commands_;
  std::optional<messaging::Publisher<micron_state_t>> micron_states_;
  messaging::Publisher<laser_state_t> laser_states_;
  messaging::LaserState last_laser_;  // as published
  std::array<bool, kHardwareFaults> faults_{};
  std::int64_t restarts_ = 0;
  std::int64_t steps_ = 0;
  double pulse_steps_ = 0.0;
  HardwareTruth truth_;
  std::vector<PulseTruth> pulses_;
  std::vector<cv::Point2d> burns_map_;
  std::optional<FrameDue> due_;
};

}  // namespace eyeslam::simulation
