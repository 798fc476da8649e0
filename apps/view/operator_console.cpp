// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/operator_console.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "link/status_text.h"

namespace eyeslam::apps {
namespace {

using messaging::ServoState;

constexpr std::int64_t kWishPeriod_us = 50'000;  // contracts, section 4
constexpr std::int64_t kPlanPeriod_us = 1'000'000;
constexpr std::int64_t kSilence_us = 1'000'000;
constexpr double kPatience_s = 30.0;
constexpr double kLongest_s = 86400.0;

constexpr std::array<CommandHelp, 8> kOtherCommands{{
    {"propose FILE", "send the plan of a plan.json"},
    {"approve HASH", "approve the proposed plan by the first 8 digits of its hash, or more"},
    {"disapprove", "no plan is approved"},
    {"status", "what the servo does, and how well"},
    {"await STATE|registration|map|tip [S]", "go on when it has come, at most S seconds later (30)"},
    {"wait S", "go on after S seconds"},
    {"help", "this"},
    {"quit", "standby, then end; as does the end of the input"},
}};

std::int64_t microseconds(double seconds) { return static_cast<std::int64_t>(1e6 * seconds); }

}  // namespace

OperatorConsole::OperatorConsole(messaging::Link& link, const Eigen::Vector2d& centre_px, Say say)
    : say_(std::move(say)),
      centre_px_(centre_px),
      wishes_(link),
      plans_(link),
      statuses_(link, [this](const auto& status, const auto&) { onStatus(status); }),
      registrations_(link, [this](const auto& registration, const auto&) { onRegistration(registration); }),
      poses_(link),
      tips_(link)
{}

void OperatorConsole::obey(const std::string& line, const messaging::ReceiveTime& now)
{
  const CommandWords words(line);
  if (words.empty()) return;
  changed_at_ = now.utime;
  if (const std::optional<std::string> said = obeyWish(words, sight(), wish_)) {
    say_(*said);
    changed_ = true;
    return;
  }
  obeyOther(words, now);
}

void OperatorConsole::obeyOther(const CommandWords& words, const messaging::ReceiveTime& now)
{
  const std::string& name = words.name();
  if (name == "propose") return propose(words);
  if (name == "approve") return approve(words);
  if (name == "await" || name == "wait") return await(words, now);
  words.expectAtMost(0);
  if (name == "disapprove") {
    wish_.plan_approved = wish_.arm = false;
    wish_.plan_hash = {};
    changed_ = true;
    say_("no plan is approved");
  } else if (name == "status") {
    sayStatus();
  } else if (name == "help") {
    sayHelp();
  } else if (name == "quit") {
    quits_ = true;
  } else {
    throw CommandError(fmt::format("'{}' is no command; 'help' lists them", name));
  }
}

// Another plan has another hash: what was approved before is not what is proposed now.
void OperatorConsole::propose(const CommandWords& words)
{
  if (words.arguments() == 0) throw CommandError("propose: FILE is missing");
  const std::int64_t map_id = sight().map_id;
  if (map_id == 0) throw CommandError("propose: there is no map yet; vision has said no RETINA_POSE");
  say_(proposal_.read(words.rest(), map_id));
  wish_.plan_approved = wish_.arm = false;
  wish_.plan_hash = {};
  changed_ = true;
  proposed_at_ = 0;
}

void OperatorConsole::approve(const CommandWords& words)
{
  words.expectAtMost(1);
  wish_.plan_hash = proposal_.named(words.text(0, "HASH"));
  wish_.plan_approved = true;
  changed_ = true;
  say_("approved: " + hexOf(wish_.plan_hash));
}

void OperatorConsole::await(const CommandWords& words, const messaging::ReceiveTime& now)
{
  Awaited awaited;
  double patience = 0.0;
  if (words.name() == "wait") {
    words.expectAtMost(1);
    patience = words.number(0, "S", 0.0, kLongest_s);
    awaited.has_come = [] { return false; };
    awaited.must_come = false;
  } else {
    words.expectAtMost(2);
    awaited.what = words.text(0, "what is awaited");
    awaited.has_come = condition(awaited.what);
    patience = words.numberOr(1, "S", 0.0, kLongest_s, kPatience_s);
  }
  awaited.deadline = now.monotonic + microseconds(patience);
  awaited_ = awaited;
}

std::function<bool()> OperatorConsole::condition(const std::string& what) const
{
  if (what == "registration") {
    return [this] { return registrations_.latest() != nullptr && registrations_.latest()->valid; };
  }
  if (what == "map") return [this] { return sight().map_id != 0; };
  if (what == "tip") return [this] { return sight().tip_px.has_value(); };
  for (int i = 0; i <= static_cast<int>(ServoState::fault); ++i) {
    const auto state = static_cast<ServoState>(i);
    if (what != messaging::word(state)) continue;
    return [this, state] { return statuses_.latest() != nullptr && statuses_.latest()->state == state; };
  }
  throw CommandError(
      fmt::format("await {}: standby, ready, assist, laser, hold, fault, registration, map or tip is wanted", what));
}

void OperatorConsole::sayStatus() const
{
  const messaging::ServoStatus* status = statuses_.latest();
  say_(status ? statusText(*status) : "no servo is heard");
  if (const messaging::PublishedRegistration* registration = registrations_.latest()) {
    say_("camera     " + registrationText(*registration));
  }
  if (sight().tip_px)
    say_(fmt::format("tip        {:.1f} {:.1f} px of the map", sight().tip_px->x(), sight().tip_px->y()));
}

void OperatorConsole::sayHelp() const
{
  for (const CommandHelp& help : wishCommands()) say_(fmt::format("{:<38}{}", help.usage, help.does));
  for (const CommandHelp& help : kOtherCommands) say_(fmt::format("{:<38}{}", help.usage, help.does));
}

void OperatorConsole::work(const messaging::ReceiveTime& now)
{
  sayWhenSilent(now.monotonic);
  if (changed_ || now.monotonic - sent_at_ >= kWishPeriod_us) send(now);
  if (proposal_.message() != nullptr && now.monotonic - proposed_at_ >= kPlanPeriod_us) {
    plans_.publish(*proposal_.message(), now.utime);
    proposed_at_ = now.monotonic;
  }
  endWaiting(now.monotonic);
}

void OperatorConsole::send(const messaging::ReceiveTime& now)
{
  if (changed_at_ == 0) changed_at_ = now.utime;
  wishes_.publish(wish_, changed_at_, now.utime);
  sent_at_ = now.monotonic;
  changed_ = false;
}

void OperatorConsole::endWaiting(std::int64_t monotonic)
{
  if (!awaited_) return;
  const bool came = awaited_->has_come();
  if (!came && monotonic < awaited_->deadline) return;
  const Awaited awaited = *std::exchange(awaited_, std::nullopt);
  if (came || !awaited.must_come) return;
  throw CommandError(fmt::format("await {}: it has not come; the servo is in {}", awaited.what,
                                 last_state_.empty() ? "no known state" : last_state_));
}

void OperatorConsole::standBy(const messaging::ReceiveTime& now)
{
  wish_.mode = messaging::WantedMode::standby;
  wish_.arm = false;
  changed_ = true;
  changed_at_ = now.utime;
  awaited_.reset();
}

void OperatorConsole::onStatus(const messaging::ServoStatus& status)
{
  silent_ = false;
  if (std::string text = stateText(status); text != last_state_) {
    say_("servo: " + text);
    last_state_ = std::move(text);
  }
}

// Its figures change all the time; what counts is whether it serves.
void OperatorConsole::onRegistration(const messaging::PublishedRegistration& registration)
{
  const std::string verdict(registration.valid ? "valid" : retina::word(registration.reason));
  if (verdict == last_registration_) return;
  last_registration_ = verdict;
  say_("camera: " + registrationText(registration));
}

void OperatorConsole::sayWhenSilent(std::int64_t monotonic)
{
  if (silent_ || statuses_.latest() == nullptr || statuses_.silence(monotonic) < kSilence_us) return;
  silent_ = true;
  last_state_.clear();
  say_("servo: silent");
}

Sight OperatorConsole::sight() const
{
  Sight sight;
  const messaging::RetinaPose* pose = poses_.latest();
  const messaging::InstrumentSight* tip = tips_.latest();
  if (pose == nullptr) return sight;
  sight.map_id = pose->map.id;
  if (tip != nullptr && tip->tip.present && pose->motion.tracked && tip->frame.frame == pose->frame.frame) {
    sight.tip_px = centre_px_ + pose->motion.map_T_frame * (tip->tip.position_px - centre_px_);
  }
  return sight;
}

}  // namespace eyeslam::apps
