// SPDX-License-Identifier: GPL-3.0-or-later
#include "eyeslam/servo/supervisor.h"

#include <array>
#include <initializer_list>

namespace eyeslam::servo {

using retina::Reason;

namespace {

constexpr unsigned bit(State state) { return 1U << static_cast<unsigned>(state); }
constexpr unsigned kStandby = bit(State::standby), kReady = bit(State::ready), kAssist = bit(State::assist);
constexpr unsigned kLaser = bit(State::laser), kHold = bit(State::hold), kFault = bit(State::fault);
constexpr unsigned kMoving = kReady | kAssist | kLaser;
constexpr unsigned kGuiding = kAssist | kLaser;

Reason first(std::initializer_list<Reason> reasons)
{
  for (const Reason reason : reasons) {
    if (reason != Reason::none) return reason;
  }
  return Reason::none;
}

// What is wrong, whoever asks; and what is needed to move, to guide, to burn.
Reason wrong(const Health& h) { return first({h.cycle, h.clock, h.controller, h.rival}); }
Reason cannotMove(const Health& h) { return first({wrong(h), h.state_link, h.operator_link, h.messages}); }
Reason cannotGuide(const Health& h) { return first({cannotMove(h), h.registration, h.retina, h.fixture}); }
Reason cannotBurn(const Health& h) { return first({cannotMove(h), h.registration, h.retina, h.plan}); }

Reason when(bool condition, Reason why = Reason::asked) { return condition ? why : Reason::none; }
bool wants(const Wish& w, Mode mode) { return w.mode == mode && !w.stop; }

// The table. A guard names why the row applies; none is no.
constexpr std::array<Transition, 14> kTable{{
    // Stops, the gravest first.
    {kStandby | kMoving | kHold, State::fault, [](const Wish&, const Health& h) { return wrong(h); }},
    {kMoving, State::hold, [](const Wish& w, const Health&) { return when(w.stop, Reason::stopped); }},
    {kMoving, State::hold, [](const Wish&, const Health& h) { return cannotMove(h); }},
    {kAssist, State::hold, [](const Wish&, const Health& h) { return cannotGuide(h); }},
    {kLaser, State::hold, [](const Wish&, const Health& h) { return cannotBurn(h); }},
    // The human takes it back.
    {kMoving | kHold, State::standby, [](const Wish& w, const Health&) { return when(w.mode == Mode::standby); }},
    {kGuiding, State::ready, [](const Wish& w, const Health&) { return when(w.mode == Mode::ready); }},
    {kLaser, State::assist,
     [](const Wish& w, const Health& h) { return when(w.mode == Mode::assist && cannotGuide(h) == Reason::none); }},
    {kLaser, State::ready, [](const Wish& w, const Health&) { return when(w.mode == Mode::assist); }},
    // Re-arming, a human act while nothing is the matter.
    {kFault, State::standby,
     [](const Wish& w, const Health& h) { return when(w.rearmed && !w.stop && wrong(h) == Reason::none); }},
    {kHold, State::ready,
     [](const Wish& w, const Health& h) { return when(w.rearmed && !w.stop && cannotMove(h) == Reason::none); }},
    // The human wants more.
    {kStandby, State::ready,
     [](const Wish& w, const Health& h) {
       return when(w.mode != Mode::standby && !w.stop && cannotMove(h) == Reason::none);
     }},
    {kReady, State::assist,
     [](const Wish& w, const Health& h) { return when(wants(w, Mode::assist) && cannotGuide(h) == Reason::none); }},
    {kReady | kAssist, State::laser,
     [](const Wish& w, const Health& h) { return when(wants(w, Mode::laser) && cannotBurn(h) == Reason::none); }},
}};

// Why the state is not the wanted one.
Reason obstacle(const Wish& wish, const Health& health)
{
  if (wish.stop) return Reason::stopped;
  switch (wish.mode) {
    case Mode::standby:
      return Reason::none;
    case Mode::ready:
      return cannotMove(health);
    case Mode::assist:
      return cannotGuide(health);
    case Mode::laser:
      return cannotBurn(health);
  }
  return Reason::none;
}

bool isWanted(State state, Mode mode) { return static_cast<int>(state) == static_cast<int>(mode); }

}  // namespace

State Supervisor::update(const Wish& wish, const Health& health)
{
  for (const Transition& row : kTable) {
    if ((row.from & bit(state_)) == 0) continue;
    const Reason why = row.guard(wish, health);
    if (why == Reason::none) continue;
    state_ = row.to;
    reason_ = why == Reason::asked ? Reason::none : why;
    return state_;
  }
  // Hold and Fault keep the reason that led there: it may have gone before anybody looked.
  if (state_ != State::hold && state_ != State::fault) {
    reason_ = isWanted(state_, wish.mode) ? Reason::none : obstacle(wish, health);
  }
  return state_;
}

}  // namespace eyeslam::servo
