// SPDX-License-Identifier: GPL-3.0-or-later
#include "servo/servo_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <filesystem>

#include "eyeslam/configuration/listing.h"
#include "eyeslam/files/file_error.h"
#include "eyeslam/files/partial_file.h"
#include "eyeslam/files/whole_file.h"
#include "link/status_text.h"
#include "real_time/scheduling.h"
#include "servo/registration_file.h"

namespace eyeslam::apps {
namespace {

constexpr unsigned kTurn_us = 20'000;
constexpr int kFarewell_turns = 100;  // 2 s: the ramp takes 150 ms

}  // namespace

ServoRun::ServoRun(const ServoArguments& arguments)
    : arguments_(arguments),
      options_(configurationOf(arguments)),
      loop_link_(openLink(arguments.link, newSession())),
      patient_link_(openLink(arguments.link, loop_link_.session())),
      record_(arguments.timing.empty() ? 0 : CycleRecord::kHalfAnHour),
      desk_(options_, patient_link_, exchanges_,
            {[this](const auto& line) { say(line); }, [this](const auto& registration) { keep(registration); }}),
      mark_(patient_link_, "eyeslam-servo", {configuration::yamlOf(options_), configuration::hashOf(options_)})
{}

void ServoRun::run()
{
  const std::string notice = unsignedNotice(arguments_.link);
  if (!notice.empty()) say(notice);
  // What could not be written at the end is refused now.
  if (!arguments_.timing.empty()) const files::PartialFile writable(arguments_.timing);
  if (!arguments_.registration.empty() && std::filesystem::exists(arguments_.registration)) resume();
  startLoop();
  std::exception_ptr failure;
  try {
    while (!interruption_.requested() && !thread_->ended()) turn();
  } catch (...) {
    failure = std::current_exception();
  }
  handOver();
  if (!arguments_.timing.empty()) writeTiming();
  if (failure) std::rethrow_exception(failure);
}

void ServoRun::resume()
{
  const messaging::PublishedRegistration known = readRegistration(arguments_.registration);
  if (!desk_.resume(known)) throw files::FileError(arguments_.registration + ": this registration is not good enough");
  say(fmt::format("camera registered by {}: {} tips, {:.2f} px", arguments_.registration, known.samples,
                  known.residual_px));
}

// A file that cannot be written is no reason to stop a servo.
void ServoRun::keep(const messaging::PublishedRegistration& registration) const
{
  if (arguments_.registration.empty()) return;
  try {
    writeRegistration(registration, arguments_.registration);
  } catch (const files::FileError& error) {
    say(fmt::format("the registration is not kept: {}", error.what()));
  }
}

// LCM's receiver takes over the class of who makes the first subscription: one below the loop, which must not wait for
// it, and above all else.
void ServoRun::startLoop()
{
  const std::string unlocked = lockMemory();
  const RealTimeSection section(kLoopPriority - 1);
  const bool real_time = unlocked.empty() && section.refusal().empty();
  if (!unlocked.empty()) say("not in real time: " + unlocked);
  if (!section.refusal().empty()) say("not in real time: " + section.refusal());
  loop_.emplace(options_.servo, loop_link_, exchanges_, real_time, record_, receiveTime);
  thread_.emplace(RealTimeLoopSetting{1000, kLoopPriority},
                  [this](const CycleStart& start) { return loop_->cycle(start); });
  say(real_time ? "running at 1 kHz, in real time" : "running at 1 kHz");
}

void ServoRun::turn()
{
  usleep(kTurn_us);
  patient_link_.drain(receiveTime);
  desk_.work(receiveTime());
  if (exchanges_.statuses.take(status_)) sayStatus();
}

void ServoRun::sayStatus()
{
  const std::string state = stateText(status_);
  if (state == last_state_) return;
  last_state_ = state;
  say(state);
}

void ServoRun::handOver()
{
  const bool interrupted = interruption_.requested();
  exchanges_.closes = true;
  for (int i = 0; i < kFarewell_turns && !thread_->ended(); ++i) usleep(kTurn_us);
  exchanges_.statuses.take(status_);
  thread_->askToEnd();
  thread_->join();
  say(fmt::format("{}: laser off, the tip is the controller's; {} cycles, {} left out",
                  interrupted ? "interrupted" : "ended", status_.cycles, status_.overruns));
}

void ServoRun::writeTiming() const
{
  files::PartialFile file(arguments_.timing);
  files::writeWholeFile(file.partialPath(), record_.csv());
  file.publish();
}

void ServoRun::say(const std::string& line) const
{
  if (arguments_.quiet) return;
  fmt::print("servo: {}\n", line);
  std::fflush(stdout);
}

}  // namespace eyeslam::apps
