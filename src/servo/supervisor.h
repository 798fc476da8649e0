// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "eyeslam/retina/reason.h"

namespace eyeslam::servo {

/// What the human wants; the numbers are those of operator_t.
enum class Mode { standby = 0, ready = 1, assist = 2, laser = 3 };

/// What the servo does; the numbers are those of servo_status_t.
enum class State {
  standby = 0,  ///< nothing is commanded
  ready = 1,    ///< tremor is cancelled, nothing guides
  assist = 2,   ///< a fixture guides
  laser = 3,    ///< targets are approached, and pulses may be asked for
  hold = 4,     ///< something is missing: tremor cancelling only, laser off, until a human re-arms
  fault = 5,    ///< something is wrong: nothing is commanded, laser off, until a human re-arms
};

/// All that a transition may depend on, judged anew in every cycle: none = as it should be, else what is the matter.
struct Health {
  retina::Reason cycle = retina::Reason::none;          ///< an exception or an impossible value in the loop itself
  retina::Reason clock = retina::Reason::none;          ///< a clock stepped
  retina::Reason controller = retina::Reason::none;     ///< restarted, unpowered, or its state is no number
  retina::Reason rival = retina::Reason::none;          ///< another servo commands the same manipulator
  retina::Reason state_link = retina::Reason::none;     ///< MICRON_STATE has not come for 50 ms
  retina::Reason operator_link = retina::Reason::none;  ///< OPERATOR has not come for 200 ms
  retina::Reason messages = retina::Reason::none;       ///< too many were refused, or no command is obeyed
  retina::Reason registration = retina::Reason::none;   ///< the camera is not registered well enough
  retina::Reason retina = retina::Reason::none;         ///< no pose for 250 ms
  retina::Reason fixture = retina::Reason::none;        ///< no fixture can be made of what the human asked for
  retina::Reason plan = retina::Reason::none;           ///< no plan is approved, or it is not the one in force
};

/// The human's part.
struct Wish {
  Mode mode = Mode::standby;
  bool stop = false;
  bool rearmed = false;  ///< in this cycle: the counter in OPERATOR has grown
};

/// One row of the table: in any of these states, when the guard says so, to that state.
struct Transition {
  unsigned from = 0;  ///< bits, 1 << State
  State to = State::standby;
  retina::Reason (*guard)(const Wish& wish, const Health& health) = nullptr;  ///< none = stays
};

/// Which state the servo is in, and why. One table, looked through from its top in every cycle; the first row that
/// applies counts, so what stops stands above what starts. Hold and Fault are left by a human act alone.
/// Never throws, never allocates.
class Supervisor {
 public:
  /// The new state after this cycle's inputs.
  State update(const Wish& wish, const Health& health);

  State state() const { return state_; }
  /// Why it is not in the wanted state; none when it is.
  retina::Reason reason() const { return reason_; }
  bool guides() const { return state_ == State::assist || state_ == State::laser; }
  /// Whether motion may be commanded at all.
  bool moves() const { return state_ != State::standby && state_ != State::fault; }

 private:
  State state_ = State::standby;
  retina::Reason reason_ = retina::Reason::none;
};

}  // namespace eyeslam::servo
