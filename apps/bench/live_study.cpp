// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/live_study.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <sstream>
#include <stdexcept>

#include "bench/live_bench.h"
#include "command_line/child_program.h"
#include "command_line/progress.h"
#include "command_line/scratch_folder.h"
#include "eyeslam/servo/registration_desk.h"
#include "link/program_link.h"
#include "real_time/scheduling.h"
#include "servo/registration_file.h"

namespace eyeslam::apps {
namespace {

constexpr int kFrames = 60;           // rendered before: 2 s of motion, and back
constexpr double kPatience_s = 60.0;  // until the servo moves the tip by what it sees
constexpr std::int64_t kExpiry_us = 50'000;

double quantile(std::vector<double> values, double q)
{
  if (values.empty()) return 0.0;
  const auto rank = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

struct Cycles {
  std::vector<double> lateness_us, computation_us;
};

// Those of the time that counts.
Cycles cyclesIn(const std::string& csv, std::int64_t from, std::int64_t to)
{
  Cycles cycles;
  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream row(line);
    std::int64_t utime = 0;
    double lateness = 0.0, computation = 0.0;
    char comma = 0;
    row >> utime >> comma >> lateness >> comma >> computation;
    if (!row || utime < from || utime > to) continue;
    cycles.lateness_us.push_back(lateness);
    cycles.computation_us.push_back(computation);
  }
  return cycles;
}

// As a good calibration finds it: how good one is, is measured elsewhere.
messaging::PublishedRegistration goodRegistration(const simulation::HardwareOptions& options)
{
  messaging::Link link("memq://", 1, {});
  const simulation::Hardware hardware(options, simulation::holdPlace(Eigen::Vector3d::Zero()), link, 1);
  const Eigen::Isometry3d& manipulator_T_world = hardware.manipulatorTWorld();
  const double px_per_m = 1e6 / hardware.umPerPx();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> within(-1e-3, 1e-3);  // m
  std::normal_distribution<double> noise(0.0, 1.0);            // px
  const cv::Point2d centre = simulation::imageCentre(options.camera);
  std::vector<servo::TipSample> samples;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d world(centre.x / px_per_m + within(random), centre.y / px_per_m + within(random),
                                0.2 * within(random) - 0.5e-3);
    samples.push_back(
        {manipulator_T_world * world, px_per_m * world.head<2>() + Eigen::Vector2d(noise(random), noise(random)), 1.0});
  }
  servo::CalibrationResult result;
  result.reason = result.camera.fit(samples);
  const Eigen::Vector3d normal = -manipulator_T_world.linear().col(2);  // the world's z goes into the retina, z = 0
  result.plane = servo::RetinaPlane{normal, normal.dot(manipulator_T_world.translation()), 5e-6};
  servo::RegistrationDesk desk;
  desk.adopt(result, 1);
  return desk.published();
}

/// Commands that came too late for the one before, although a bare loop was in time all that while.
std::int64_t needlessExpiries(const std::vector<CommandArrival>& commands, const std::vector<BareLoop::Start>& bare)
{
  std::int64_t count = 0;
  std::size_t b = 1;
  for (std::size_t i = 1; i < commands.size(); ++i) {
    if (commands[i].sent - commands[i - 1].sent <= kExpiry_us) continue;
    bool excused = false;
    while (b + 1 < bare.size() && bare[b].utime < commands[i - 1].sent) ++b;
    for (std::size_t k = b; k < bare.size() && bare[k - 1].utime < commands[i].sent; ++k) {
      excused = excused || bare[k].utime - bare[k - 1].utime > kExpiry_us / 2;
    }
    if (!excused) ++count;
  }
  return count;
}

/// ms from the end of each frame's exposure to the first command that used it.
std::vector<double> framesToCommands(const std::vector<CommandArrival>& commands, double exposure)
{
  std::vector<double> delays;
  for (std::size_t i = 1; i < commands.size(); ++i) {
    if (commands[i].utime_image == 0 || commands[i].utime_image == commands[i - 1].utime_image) continue;
    delays.push_back(1e-3 * static_cast<double>(commands[i].sent - commands[i].utime_image) - 0.5e3 * exposure);
  }
  return delays;
}

void waitUntilReady(const BenchManipulator& manipulator, ChildProgram& servo, ChildProgram& track)
{
  for (int i = 0; i < static_cast<int>(kPatience_s / 0.1); ++i) {
    if (manipulator.isReady()) return;
    if (!servo.runs()) throw std::runtime_error("eyeslam-servo has ended");
    if (!track.runs()) throw std::runtime_error("eyeslam-track has ended");
    usleep(100'000);
  }
  throw std::runtime_error("eyeslam-servo was not ready within 60 s, or no frame reached it");
}

void pass(const LiveInputs& inputs)
{
  Progress progress("live", std::llround(inputs.seconds), inputs.quiet ? Verbosity::quiet : Verbosity::normal);
  for (int second = 0; second < std::lround(inputs.seconds); ++second) {
    usleep(1'000'000);
    progress.show(second + 1);
  }
}

struct Outcome {
  Cycles cycles;
  std::vector<double> bare_us, frame_ms;
  std::size_t commands = 0;
  std::int64_t expired = 0, lost = 0;
  bool real_time = false;
};

Outcome measured(const LiveInputs& inputs)
{
  const ScratchFolder scratch("eyeslam_bench");
  const simulation::HardwareOptions options;
  const std::string folder = inputs.programs.empty() ? programFolder() : inputs.programs;
  const std::string url = privateUrl();
  const std::string shm = fmt::format("eyeslam_bench_{}", getpid());
  const auto expected = static_cast<std::size_t>(1100.0 * inputs.seconds) + 10'000;
  writeRegistration(goodRegistration(options), scratch.path("camera.json"));
  const FramePlayer player(shm, options, kFrames);
  Outcome outcome;
  std::unique_ptr<BenchManipulator> manipulator_in_place;
  {
    const std::string unlocked = lockMemory();
    const RealTimeSection section(kLoopPriority - 1);  // not for the programs below, which would inherit it
    manipulator_in_place = std::make_unique<BenchManipulator>(url, options, expected);
    outcome.real_time = unlocked.empty() && section.refusal().empty();
  }
  BenchManipulator& manipulator = *manipulator_in_place;
  BareLoop bare(expected);
  ChildProgram servo(folder + "/eyeslam-servo",
                     {"--lcm", url, "--quiet", "--timing", scratch.path("cycles.csv"), "--registration",
                      scratch.path("camera.json"), "--set", "registration.refines=false"});
  ChildProgram track(folder + "/eyeslam-track",
                     {"shm:" + shm, "--out", scratch.path("track"), "--lcm", url, "--no-overlay", "--quiet"});
  waitUntilReady(manipulator, servo, track);
  const std::int64_t from = receiveTime().utime;
  manipulator.record();
  bare.record();
  pass(inputs);
  manipulator.end();
  bare.end();
  servo.interrupt();
  outcome.cycles = cyclesIn(scratch.path("cycles.csv"), from, from + std::llround(1e6 * inputs.seconds));
  for (const BareLoop::Start& start : bare.starts()) outcome.bare_us.push_back(static_cast<double>(start.lateness_us));
  outcome.frame_ms = framesToCommands(manipulator.commands(), player.exposure());
  outcome.commands = manipulator.commands().size();
  outcome.expired = needlessExpiries(manipulator.commands(), bare.starts());
  outcome.lost = manipulator.lost();
  return outcome;
}

}  // namespace

void printLiveTable(const LiveInputs& inputs)
{
  const Outcome outcome = measured(inputs);
  const double servo_p99 = quantile(outcome.cycles.lateness_us, 0.99), bare_p99 = quantile(outcome.bare_us, 0.99);
  fmt::print("{} cycles, {} commands heard, {} lost, {}\n\n", outcome.cycles.lateness_us.size(), outcome.commands,
             outcome.lost, outcome.real_time ? "in real time" : "not in real time");
  fmt::print("| what | servo | bare timer loop | bound |\n| --- | --- | --- | --- |\n");
  fmt::print("| lateness of a cycle, p50, us | {:.0f} | {:.0f} | |\n", quantile(outcome.cycles.lateness_us, 0.5),
             quantile(outcome.bare_us, 0.5));
  fmt::print("| lateness of a cycle, p99, us | {:.0f} | {:.0f} | |\n", servo_p99, bare_p99);
  fmt::print("| ratio of the p99 | {:.2f} | | 1.5 |\n", servo_p99 / std::max(bare_p99, 1.0));
  fmt::print("| commands that expired needlessly | {} | | 0 |\n", outcome.expired);
  fmt::print("| CPU of a cycle, median, us | {:.0f} | | 50 |\n", quantile(outcome.cycles.computation_us, 0.5));
  fmt::print("| CPU of a cycle, p99, us | {:.0f} | | 200 |\n", quantile(outcome.cycles.computation_us, 0.99));
  fmt::print("| frame to first command, median, ms | {:.1f} | | 8 |\n", quantile(outcome.frame_ms, 0.5));
  fmt::print("| frame to first command, p99, ms | {:.1f} | | |\n", quantile(outcome.frame_ms, 0.99));
}

}  // namespace eyeslam::apps
