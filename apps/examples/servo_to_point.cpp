// SPDX-License-Identifier: GPL-3.0-or-later
// servo_to_point --by X Y Z: a program of ViSP's own means that drives Micron's tip, over LCM or in a simulation.
#include <fmt/format.h>
#include <visp3/visual_features/vpGenericFeature.h>
#include <visp3/vs/vpServo.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "command_line/program.h"
#include "examples/micron_connection.h"
#include "eyeslam/robot/robot_micron.h"

using namespace eyeslam;

// The tip, mm, is a feature that the tool's own motion moves. @return RMS over the last second, um
static double servoBy(const std::array<double, 3>& by_um, robot::RobotMicron& micron,
                      examples::MicronConnection& connection)
{
  constexpr int kFrames = 120, kJudged = 30;
  vpGenericFeature tip(3), goal(3);
  vpMatrix towards_feature(3, 6), fJe;
  for (unsigned i = 0; i < 3; ++i) towards_feature[i][i] = -1e3;
  tip.setInteractionMatrix(towards_feature);
  vpColVector at = micron.getPosition(vpRobot::REFERENCE_FRAME);
  goal.set_s(1e3 * at[0] + 1e-3 * by_um[0], 1e3 * at[1] + 1e-3 * by_um[1], 1e3 * at[2] + 1e-3 * by_um[2]);
  vpServo task;
  task.setServo(vpServo::EYETOHAND_L_cVf_fJe);
  task.setInteractionMatrixType(vpServo::CURRENT);
  task.setLambda(4.0);
  task.set_cVf(vpHomogeneousMatrix());
  task.addFeature(tip, goal);
  double squares = 0.0;
  for (int frame = 0; frame < kFrames; ++frame, connection.waitForFrame()) {
    micron.getPosition(vpRobot::REFERENCE_FRAME, at);
    tip.set_s(1e3 * at[0], 1e3 * at[1], 1e3 * at[2]);
    micron.get_fJe(fJe);
    task.set_fJe(fJe);
    micron.setVelocity(vpRobot::JOINT_STATE, task.computeControlLaw());
    if (frame >= kFrames - kJudged) squares += task.getError().sumSquare();
  }
  return 1e3 * std::sqrt(squares / kJudged);
}

struct Arguments {
  std::array<double, 3> by_um{300.0, 0.0, 0.0};
  examples::MicronChoice micron;
};

static void run(const Arguments& arguments)
{
  examples::MicronConnection connection(arguments.micron);
  robot::RobotMicron micron(connection.link(), [&] { return connection.now(); });
  connection.waitForFrame();
  micron.init();
  micron.setMaxTranslationVelocity(5e-3);
  micron.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);
  const double rms_um = servoBy(arguments.by_um, micron, connection);
  micron.setRobotState(vpRobot::STATE_STOP);
  fmt::print("the tip is {:.0f} um RMS from the point\n", rms_um);
  constexpr double kNear_um = 100.0;  // a trembling hand is 100 um and more away
  if (rms_um > kNear_um) throw std::runtime_error(micron.isSaturated() ? "out of reach" : "the tip did not get there");
}

static std::function<void()> setUp(CLI::App& app, Arguments& arguments)
{
  apps::addStandardOptions(app,
                           "servo_to_point --simulate --by 300 -200 100\nservo_to_point --by 300 0 0 --key micron.key");
  app.add_option("--by", arguments.by_um, "from where the tip is, um, in the manipulator's frame")->type_name("X Y Z");
  examples::addOptions(app, arguments.micron);
  return [&arguments] { run(arguments); };
}

int main(int argc, char** argv)
{
  Arguments arguments;
  return apps::runProgram("servo_to_point", "Drives Micron's tip onto a point with ViSP.", argc, argv,
                          [&arguments](CLI::App& app) { return setUp(app, arguments); });
}
