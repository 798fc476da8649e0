// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <functional>

#include "eyeslam/messaging/link.h"
#include "eyeslam/messaging/micron_messages.h"
#include "eyeslam/messaging/subscription.h"
#include "eyeslam/simulation/micron_controller.h"

namespace eyeslam::support {

/// Micron in a hand behind its messages, in one process and in lock step: the manipulator's frame is the world's.
/// Without noise unless asked for.
class SimulatedMicron {
 public:
  using HandAt = std::function<Eigen::Vector3d(double t_s)>;  ///< displacement of the null from its start, m

  explicit SimulatedMicron(const simulation::MicronControllerOptions& options = exact(), std::uint64_t seed = 1)
      : controller(options, Eigen::Isometry3d::Identity(), seed), commands(link), states_(link)
  {
    step();
  }

  static simulation::MicronControllerOptions exact()
  {
    simulation::MicronControllerOptions options;
    options.plant.gain_error = options.plant.bend_um = options.plant.noise_um = 0.0;
    return options;
  }

  void step(int milliseconds = 1)
  {
    for (int i = 0; i < milliseconds; ++i) {
      now.monotonic += 1000;
      now.utime += 1000;
      link.drain(now);
      t_s += 1e-3;
      if (hand) held.null = kNull + hand(t_s);
      held.shaft = (kPort - held.null).normalized();
      const auto& state = controller.step(held, simulation::heardOn(commands, now.monotonic));
      if (speaks) states_.publish(state, now.utime - controller.stateAge_us(), now.utime);
    }
  }

  static constexpr double kHeight = 0.5e-3;  // of the null over z = 0
  const Eigen::Vector3d kNull{0.0, 0.0, kHeight};
  const Eigen::Vector3d kPort{10e-3, 3e-3, 18e-3};

  messaging::Link link{"memq://", 7, {}};
  messaging::ReceiveTime now{5'000'000, 1'700'000'000'000'000};
  std::function<messaging::ReceiveTime()> clock = [this] { return now; };
  simulation::MicronController controller;
  simulation::HeldManipulator held{Eigen::Vector3d(0.0, 0.0, kHeight), Eigen::Vector3d::UnitZ(),
                                   Eigen::Vector2d::Zero()};
  messaging::Subscription<micron_command_t> commands;
  HandAt hand;
  bool speaks = true;
  double t_s = 0.0;

 private:
  messaging::Publisher<micron_state_t> states_;
};

}  // namespace eyeslam::support
