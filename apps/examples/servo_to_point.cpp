// SPDX-License-Identifier: GPL-3.0-or-later
// servo_to_point --by X Y Z: a program of ViSP's own means that drives Micron's tip, over LCM or in a simulation.
#include <fmt/format.h>
#include <visp3/visual_features/vpGenericFeature.h>
#include <visp3/vs/vpServo.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <thread>

#include "command_line/program.h"
#include "eyeslam/messaging/authentication.h"
#include "eyeslam/robot/robot_micron.h"
#include "eyeslam/simulation/hardware.h"
#include "link/program_link.h"

namespace {

using namespace eyeslam;

const std::string kExamples =
    "servo_to_point --simulate --by 300 -200 100\n"
    "servo_to_point --by 300 0 0 --lcm 'udpm://239.255.76.67:7667?ttl=0' --key micron.key";
constexpr int kFrames = 120, kJudged = 30;  // of 33 ms

struct Arguments {
  std::vector<double> by_um{300.0, 0.0, 0.0};
  std::string url, key;
  bool simulate = false;
};

/// A frame's time goes by: in the simulation step by step, else by waiting.
void waitForFrame(messaging::ReceiveTime& now, messaging::Link& link, simulation::Hardware* hardware)
{
  if (hardware == nullptr) return std::this_thread::sleep_for(std::chrono::milliseconds(33));
  for (int i = 0; i < 33; ++i) {
    now.monotonic += 1000;
    now.utime += 1000;
    link.drain(now);
    hardware->step(now);
  }
}

void servoToPoint(const Arguments& arguments)
{
  const std::int64_t session = apps::newSession();
  const auto key = arguments.key.empty() ? std::nullopt : std::make_optional(messaging::readKey(arguments.key));
  messaging::Link link(arguments.simulate ? "memq://" : arguments.url, session, key);
  messaging::ReceiveTime now{1'000'000, 1'700'000'000'000'000};
  std::unique_ptr<simulation::Hardware> hardware;
  if (arguments.simulate)
    hardware = std::make_unique<simulation::Hardware>(simulation::HardwareOptions{},
                                                      simulation::holdPlace({0.0, 0.0, -0.5e-3}), link, session);
  robot::RobotMicron micron(link, [&] { return hardware ? now : apps::receiveTime(); });
  waitForFrame(now, link, hardware.get());
  micron.init();
  micron.setMaxTranslationVelocity(5e-3);
  micron.setRobotState(vpRobot::STATE_VELOCITY_CONTROL);

  // From here on as with any robot of ViSP: the tip, mm, is a feature that the tool's own motion moves.
  vpGenericFeature tip(3), goal(3);
  vpMatrix towards_feature(3, 6), fJe;
  for (unsigned i = 0; i < 3; ++i) towards_feature[i][i] = -1e3;
  tip.setInteractionMatrix(towards_feature);
  vpColVector position = micron.getPosition(vpRobot::REFERENCE_FRAME);
  const vpColVector start = position;
  goal.set_s(1e3 * start[0] + 1e-3 * arguments.by_um[0], 1e3 * start[1] + 1e-3 * arguments.by_um[1],
             1e3 * start[2] + 1e-3 * arguments.by_um[2]);
  vpServo task;
  task.setServo(vpServo::EYETOHAND_L_cVf_fJe);
  task.setInteractionMatrixType(vpServo::CURRENT);
  task.setLambda(4.0);
  task.set_cVf(vpHomogeneousMatrix());
  task.addFeature(tip, goal);
  double squares = 0.0;
  for (int frame = 0; frame < kFrames; ++frame) {
    micron.getPosition(vpRobot::REFERENCE_FRAME, position);
    tip.set_s(1e3 * position[0], 1e3 * position[1], 1e3 * position[2]);
    micron.get_fJe(fJe);
    task.set_fJe(fJe);
    micron.setVelocity(vpRobot::JOINT_STATE, task.computeControlLaw());
    if (frame >= kFrames - kJudged) squares += task.getError().sumSquare();
    waitForFrame(now, link, hardware.get());
  }
  micron.setRobotState(vpRobot::STATE_STOP);
  const double rms_um = 1e3 * std::sqrt(squares / kJudged);
  fmt::print("the tip is {:.0f} um RMS from the point\n", rms_um);
  constexpr double kNear_um = 100.0;  // a trembling hand is 100 um and more away
  if (rms_um > kNear_um) throw std::runtime_error(micron.isSaturated() ? "out of reach" : "the tip did not get there");
}

std::function<void()> setUp(CLI::App& app, Arguments& arguments)
{
  apps::addStandardOptions(app, kExamples);
  app.add_option("--by", arguments.by_um, "from where the tip is, um, in the manipulator's frame")->expected(3);
  app.add_option("--lcm", arguments.url, "where the controller is heard; default LCM_DEFAULT_URL");
  app.add_option("--key", arguments.key, "signs the commands")->check(CLI::ExistingFile);
  app.add_flag("--simulate", arguments.simulate, "a simulated manipulator in a trembling hand, within this program");
  return [&arguments] { servoToPoint(arguments); };
}

}  // namespace

int main(int argc, char** argv)
{
  Arguments arguments;
  return apps::runProgram("servo_to_point", "Drives Micron's tip onto a point with ViSP.", argc, argv,
                          [&arguments](CLI::App& app) { return setUp(app, arguments); });
}
