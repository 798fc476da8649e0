// SPDX-License-Identifier: GPL-3.0-or-later
// A robot of ViSP without a controller: it says that it hears none.
#include <visp3/robot/vpRobotException.h>

#include "eyeslam/robot/robot_micron.h"
#include "eyeslam/robot/visual_servo.h"

int main()
{
  eyeslam::messaging::Link link("memq://", 1, {});
  eyeslam::robot::RobotMicron micron(link, [] { return eyeslam::messaging::ReceiveTime{1, 1}; });
  const eyeslam::robot::VisualServo servo;
  try {
    micron.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
    micron.setVelocity(vpRobot::REFERENCE_FRAME, vpColVector(3, 1e-3));
  } catch (const vpRobotException&) {
    return servo.getReason() == eyeslam::retina::Reason::not_registered ? 0 : 1;
  }
  return 1;
}
