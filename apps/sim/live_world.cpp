// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/live_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "command_line/program.h"
#include "link/program_link.h"

namespace eyeslam::apps {
namespace {

constexpr std::int64_t kSettling_steps = 4000;  // after a change of hands nothing counts; as in the loop study

}  // namespace

TimedFault timedFault(const std::string& text)
{
  const std::size_t at = text.find('@');
  const std::string seconds = at == std::string::npos ? "" : text.substr(at + 1);
  char* end = nullptr;
  const double t_s = std::strtod(seconds.c_str(), &end);
  if (seconds.empty() || *end != 0 || !(t_s >= 0.0 && t_s <= 1e6)) {
    throw UsageError(fmt::format("--fault {}: WHAT@SECONDS is wanted, like states_stop@20", text));
  }
  try {
    return {simulation::hardwareFault(text.substr(0, at)), t_s};
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("--fault {}: {}", text, error.what()));
  }
}

LiveWorld::LiveWorld(const Setting& setting, messaging::Link& link, FrameFeed& feed)
    : setting_(setting),
      link_(link),
      feed_(feed),
      statuses_(link),
      wishes_(link),
      hardware_(
          setting.hardware, [this](double t_s) { return surgeonTask(t_s); }, link, setting.seed)
{
  std::sort(setting_.faults.begin(), setting_.faults.end(),
            [](const TimedFault& a, const TimedFault& b) { return a.t_s < b.t_s; });
}

simulation::SurgeonTask LiveWorld::surgeonTask(double t_s) const
{
  simulation::SurgeonTask task = setting_.task.surgeon(t_s);
  task.support = guided_since_ >= 0 ? simulation::HandTremor::Support::fixture : simulation::HandTremor::Support::none;
  task.switches.foot_switch = setting_.foot_switch;
  return task;
}

bool LiveWorld::cycle(const CycleStart& start)
{
  link_.drain(receiveTime);
  catch_up_.run(start, [this](std::int64_t monotonic, std::int64_t utime) { step({monotonic, utime}); });
  return setting_.duration_s <= 0.0 || 1e-3 * static_cast<double>(steps_) < setting_.duration_s;
}

void LiveWorld::step(const messaging::ReceiveTime& now)
{
  injectFaults();
  hardware_.step(now);
  ++steps_;
  feed_.show(hardware_.frameDue());
  judge();
}

void LiveWorld::injectFaults()
{
  while (faults_done_ < setting_.faults.size() &&
         setting_.faults[faults_done_].t_s <= 1e-3 * static_cast<double>(steps_)) {
    hardware_.inject(setting_.faults[faults_done_++].fault);
  }
}

bool LiveWorld::isGuided() const
{
  const messaging::ServoStatus* status = statuses_.latest();
  const messaging::OperatorWish* wish = wishes_.latest();
  if (status == nullptr || wish == nullptr || !hardware_.micronState().follows_command) return false;
  const messaging::FixtureKind kind = wish->fixture.kind;
  const bool has_goal = kind == messaging::FixtureKind::point || kind == messaging::FixtureKind::vessel;
  return status->state == messaging::ServoState::laser || (status->state == messaging::ServoState::assist && has_goal);
}

void LiveWorld::judge()
{
  const bool guided = isGuided();
  const bool alone = !hardware_.micronState().follows_command;
  guided_since_ = !guided ? -1 : guided_since_ < 0 ? steps_ : guided_since_;
  alone_since_ = !alone ? -1 : alone_since_ < 0 ? steps_ : alone_since_;
  const double error = setting_.task.error(hardware_.truth().tipRetina());
  if (guided_since_ >= 0 && steps_ - guided_since_ >= kSettling_steps) scores_.guided.add(error);
  if (alone_since_ >= 0 && steps_ - alone_since_ >= kSettling_steps) scores_.alone.add(error);
}

}  // namespace eyeslam::apps
