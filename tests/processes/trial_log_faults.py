# SPDX-License-Identifier: GPL-3.0-or-later
"""Ways to break a composed trial, each with the one rule of the checker that it breaks."""
import trial_log_case
from trial_log_case import BEGIN_us, LENGTH_ms, MS, PULSE_ms, PULSES

FIRST = PULSES[1]  # ms of the first FIRE of the first pulse


def during(state):
    """ms from which a LASER_STATE of the log says so all along the first pulse: those before its start count too."""
    return lambda trial: trial.set("LASER_STATE", FIRST - 20, FIRST + PULSE_ms, **state)


def plan_state(state):
    """All plans in force say so of the first pulse's target, and are what their proposal was otherwise."""
    def broken(trial):
        for plan in trial.of("BURN_PLAN", 100, FIRST):
            plan.target[0].state = state
    return broken


def refused_by_the_newest_map(trial):
    """Between FIRE and the pulse's end."""
    trial._say_plan(FIRST + 5, 1)
    time, channel, plan = trial.messages.pop()
    plan.target[0].state, plan.target[0].reason = 3, 40
    trial.messages.insert(next(i for i, entry in enumerate(trial.messages) if entry[0] > time), (time, channel, plan))
    for seq, message in enumerate(m for m in trial.of("BURN_PLAN") if m.state == 1):
        message.seq = seq


def vessel_at(column):
    """The map's vessel in another column, of 20 um; 24 and 25 meet at the first target."""
    def broken(trial):
        for tile in trial.of("VESSEL_MAP"):
            row = bytes(255 if tile.column + i == column else 0 for i in range(tile.width))
            tile.probability = row * tile.height
    return broken


def propose(trial, t, margin_um):
    """Another plan with the old one's hash."""
    trial._say_plan(t, 0)
    time, channel, plan = trial.messages.pop()
    plan.margin_um = margin_um
    trial.messages.insert(next(i for i, entry in enumerate(trial.messages) if entry[0] > time), (time, channel, plan))


def clearance(trial):
    for plan in trial.of("BURN_PLAN"):
        plan.target[0].clearance_um = 99.0


def emit(trial, first, last, emitting=True):
    trial.set("TRUTH", first, last, emitting=emitting)


def end_at(trial, last):
    """The first pulse is cut: asked for no more, and the truth and the laser say so."""
    trial.set("LASER_COMMAND", last, FIRST + PULSE_ms, action=1, pulse=0, target=-1, duration=0.0, power=0.0)
    emit(trial, last + 1, FIRST + PULSE_ms, False)
    trial.set("LASER_STATE", last + 1, FIRST + PULSE_ms, emitting=False)


def status(trial, t, state):
    """One more, and all later ones say the same."""
    trial.add(t, "SERVO_STATUS", state=state)
    trial.set("SERVO_STATUS", t, LENGTH_ms, state=state)


def stop_in_pulse(trial):
    """The servo stops and says no more, but the laser goes on 3 ms longer."""
    begin = PULSES[2] + 5
    status(trial, begin, 4)
    trial.leave_out("LASER_COMMAND", begin, LENGTH_ms)
    emit(trial, begin + 3, LENGTH_ms, False)
    trial.set("LASER_STATE", begin + 3, LENGTH_ms, emitting=False)
    trial.set("MICRON_COMMAND", begin, LENGTH_ms, mode=1)
    trial.set("MICRON_STATE", begin, LENGTH_ms, flags=3)


def fire_after_stop(trial):
    """Long after the pulses; the laser begins nothing."""
    status(trial, 900, 4)
    trial.set("LASER_COMMAND", 910, 911, action=2, pulse=3, target=3, duration=PULSE_ms * 1e-3, power=0.2)
    trial.set("MICRON_COMMAND", 1000, LENGTH_ms, mode=1)
    trial.set("MICRON_STATE", 1000, LENGTH_ms, flags=3)


def rest(trial, t, state):
    status(trial, t, state)
    trial.set("MICRON_STATE", t, LENGTH_ms, flags=3)


def motion_in_fault(trial):
    rest(trial, 900, 5)
    trial.set("MICRON_COMMAND", 900, LENGTH_ms, mode=1)
    trial.set("MICRON_COMMAND", 950, 950, mode=2)


def motion_in_hold(trial):
    rest(trial, 850, 4)


def held_by_nobody(trial):
    """The servo wants an end, the laser goes on."""
    trial.set("LASER_COMMAND", FIRST + 8, FIRST + PULSE_ms, action=1, pulse=0, target=-1, duration=0.0, power=0.0)


def lapsed(trial):
    trial.leave_out("LASER_COMMAND", FIRST + 8, FIRST + PULSE_ms - 2)
    trial.number_again("LASER_COMMAND")


def nobody_asked(trial):
    emit(trial, 300, 305)
    trial.set("LASER_STATE", 300, 300, emitting=True)


def other_target(trial):
    trial.set("LASER_COMMAND", 0, LENGTH_ms, lambda command: command.target == 2, target=1)
    trial.set("LASER_STATE", 0, LENGTH_ms, lambda state: state.target == 2, target=1)
    place = trial_log_case.retina_of_map(trial_log_case.TARGETS[1])
    trial.set("TRUTH", PULSES[2], LENGTH_ms, spot=[place.real, place.imag])
    for plan in trial.of("BURN_PLAN"):
        plan.target[0].state = 0


def near_a_burn(trial):
    """Target 2 is moved onto target 1, in plan and hash and approval."""
    x_px, y_px = trial_log_case.TARGETS[1]
    for plan in trial.of("BURN_PLAN"):
        plan.target[1].x_px, plan.target[1].y_px = x_px + 10.0, y_px
    approve_again(trial)
    place = trial_log_case.retina_of_map((x_px + 10.0, y_px))
    trial.set("TRUTH", PULSES[2], LENGTH_ms, spot=[place.real, place.imag])


def approve_again(trial):
    hash_ = trial_log_case.plan_hash(trial.of("BURN_PLAN", 60, 60)[0])
    for plan in trial.of("BURN_PLAN"):
        plan.hash = hash_
    trial.set("OPERATOR", 100, LENGTH_ms, plan_hash=hash_)


def same_number(trial):
    trial.set("LASER_COMMAND", 0, LENGTH_ms, lambda command: command.pulse == 2, pulse=1)
    trial.set("LASER_STATE", 0, LENGTH_ms, lambda state: state.pulse == 2, pulse=1)


def far(trial):
    for truth in trial.of("TRUTH", FIRST, FIRST + PULSE_ms):
        truth.spot = [truth.spot[0] + 60e-6, truth.spot[1]]


def jump(trial, t, size):
    """The retina, and nothing else in the world."""
    for truth in trial.of("TRUTH", t, LENGTH_ms):
        truth.retina_shift = [truth.retina_shift[0], truth.retina_shift[1] + size, 0.0]
        truth.tip = [truth.tip[0], truth.tip[1] - size, truth.tip[2]]
        truth.null = [truth.null[0], truth.null[1] - size, truth.null[2]]


def old_pose(trial):
    """No frame for 54 ms at the first FIRE; commands say so."""
    newest = [pose for pose in trial.of("RETINA_POSE", 0, FIRST) if pose.utime < BEGIN_us + (FIRST - 53) * MS][-1]
    trial.leave_out("RETINA_POSE", 0, FIRST + PULSE_ms, lambda pose: pose.utime > newest.utime)
    for channel in ("MICRON_COMMAND", "LASER_COMMAND"):
        trial.set(channel, 0, FIRST + PULSE_ms + 40, lambda command: command.utime_image > newest.utime, utime_image=newest.utime)


def pushed(trial, size):
    """The whole deflection: measured, and as it is, slowly there and back."""
    for i, (state, truth) in enumerate(zip(trial.of("MICRON_STATE"), trial.of("TRUTH"))):
        share = max(0.0, 1.0 - abs(i - FIRST - 10) / 200.0)
        state.tip_position = [state.tip_position[0], state.tip_position[1], state.tip_position[2] + share * size]
        truth.tip = [truth.tip[0], truth.tip[1], truth.tip[2] + share * size]


def fast(trial, metres_a_step, carried):
    """Some steps of the tip, with the hand or from it."""
    for i, truth in enumerate(trial.of("TRUTH", 900, LENGTH_ms)):
        way = metres_a_step * min(i, 8)
        truth.tip = [truth.tip[0], truth.tip[1], truth.tip[2] + way]
        truth.null = [truth.null[0], truth.null[1], truth.null[2] + (way if carried else 0.0)]


def step_away(trial):
    for truth in trial.of("TRUTH", 900, LENGTH_ms):
        truth.tip = [truth.tip[0], truth.tip[1], truth.tip[2] + 50e-6]


def untracked(trial):
    newest = trial.of("RETINA_POSE", 0, FIRST)[-1]
    newest.tracked, newest.reason = False, 1


def stranger(trial):
    """Another fingerprint."""
    sight = trial.of("TOOL_TIP")[0]
    data = bytearray(sight.encode())
    data[7] ^= 1
    trial.messages = [(time, name, bytes(data) if message is sight else message) for time, name, message in trial.messages]


def too_long(trial):
    sight = trial.of("TOOL_TIP")[0]
    trial.messages = [(time, name, sight.encode() + b"0" if message is sight else message) for time, name, message in trial.messages]


def of_later(trial):
    command = trial.of("MICRON_COMMAND", 400, 400)[0]
    command.utime_image = trial.of("RETINA_POSE", 401)[0].utime


def lost_command(trial):
    trial.leave_out("MICRON_COMMAND", 400, 400)
    trial.set("MICRON_STATE", 401, 401, command_seq=399)


def followed_too_long(trial):
    trial.set("MICRON_STATE", 900, 960, command_seq=899)


BREAKS = [
    ("whole_log", lambda trial: trial.messages.__setitem__(700, (trial.messages[699][0] - 5 * MS, *trial.messages[700][1:]))),
    ("message_type", stranger),
    ("message_type", too_long),
    ("message_type", lambda trial: trial.messages.append((trial.messages[-1][0], "CHATTER", b"0"))),
    ("truth_complete", lambda trial: trial.leave_out("TRUTH", 700, 702)),
    ("sender_time", lambda trial: trial.set("TOOL_TIP", 400, 440, utime=BEGIN_us + 450 * MS)),
    ("sender_time", lambda trial: setattr(trial.of("OPERATOR")[9], "seq", 8)),
    ("command_numbers", lost_command),
    ("image_time", of_later),
    ("image_time", lambda trial: trial.set("LASER_COMMAND", 400, 400, utime_image=BEGIN_us + 12 * MS)),
    ("pulse_commanded", nobody_asked),
    ("pulse_told", lambda trial: trial.set("LASER_STATE", FIRST + 1, FIRST + PULSE_ms, target=3)),
    ("pulse_told", lambda trial: trial.set("LASER_STATE", 700, 700, emitting=True)),
    ("pulse_held", held_by_nobody),
    ("pulse_held", lapsed),
    ("pulse_dose", lambda trial: trial.set("LASER_COMMAND", FIRST, FIRST + PULSE_ms, lambda c: c.action == 2, power=0.21)),
    ("pulse_dose", lambda trial: trial.set("LASER_COMMAND", FIRST, FIRST + PULSE_ms, lambda c: c.action == 2, duration=0.018)),
    ("target_once", other_target),
    ("target_once", near_a_burn),
    ("pulse_number", same_number),
    ("far_explained", far),
    ("far_explained", lambda trial: (far(trial), jump(trial, FIRST + 10, 39e-6))),
    ("far_explained", lambda trial: (far(trial), jump(trial, FIRST + PULSE_ms + 2, 200e-6))),
    ("far_explained", lambda trial: trial.set("TRUTH", FIRST + 3, FIRST + 3, spot=[float("nan"), 0.0])),
    ("far_explained", lambda trial: trial.set("TRUTH", 0, FIRST, frame_utime=0)),
    ("plan_hash", lambda trial: setattr(trial.of("BURN_PLAN", 530, 530)[0].target[2], "x_px", 501.0)),
    ("plan_hash", lambda trial: setattr(trial.of("BURN_PLAN", 530, 530)[0], "margin_um", 90.0)),
    ("plan_hash", lambda trial: setattr(trial.of("BURN_PLAN", 830, 830)[0], "hash", bytes(32))),
    ("plan_hash", lambda trial: propose(trial, 900, 50.0)),
    ("foot_switch", during({"foot_switch": False})),
    ("laser_armed", during({"armed": False})),
    ("interlock_closed", during({"interlock_closed": False})),
    ("laser_fresh", lambda trial: trial.leave_out("LASER_STATE", FIRST - 55, FIRST)),
    ("operator_armed", lambda trial: trial.set("OPERATOR", FIRST - 60, FIRST + PULSE_ms, arm=False)),
    ("operator_armed", lambda trial: trial.set("OPERATOR", FIRST - 60, FIRST + PULSE_ms, stop=True)),
    ("operator_fresh", lambda trial: trial.leave_out("OPERATOR", FIRST - 210, FIRST + PULSE_ms)),
    ("plan_approved", lambda trial: trial.set("OPERATOR", FIRST - 60, FIRST + PULSE_ms, plan_approved=False)),
    ("plan_approved", lambda trial: trial.set("OPERATOR", FIRST - 60, FIRST + PULSE_ms, plan_hash=bytes(32))),
    ("plan_approved", lambda trial: trial.leave_out("BURN_PLAN", 100, FIRST)),
    ("target_valid", plan_state(3)),
    ("target_valid", refused_by_the_newest_map),
    ("target_valid", lambda trial: (trial.set("LASER_COMMAND", FIRST, FIRST + PULSE_ms, lambda c: c.action == 2, target=9),
                                    trial.set("LASER_STATE", FIRST, FIRST + PULSE_ms, target=9))),
    ("target_unburnt", plan_state(1)),
    ("target_unburnt", plan_state(2)),
    ("vessel_margin", clearance),
    ("map_margin", vessel_at(34)),
    ("map_margin", vessel_at(15)),
    ("map_margin", lambda trial: trial.leave_out("VESSEL_MAP", 0, LENGTH_ms)),
    ("pose_fresh", old_pose),
    ("pose_tracked", untracked),
    ("pose_tracked", lambda trial: trial.set("RETINA_POSE", FIRST - 50, FIRST + PULSE_ms, map_id=8)),
    ("registered", lambda trial: trial.set("REGISTRATION", 0, FIRST, valid=False)),
    ("state_fresh", lambda trial: trial.leave_out("MICRON_STATE", FIRST - 51, FIRST)),
    ("reach_left", lambda trial: pushed(trial, 1.85e-3)),
    ("not_saturated", lambda trial: trial.set("TRUTH", FIRST + 1, FIRST + 1, saturated=True)),
    ("not_saturated", lambda trial: trial.set("MICRON_STATE", FIRST, FIRST, limits=2)),
    ("servo_in_laser", lambda trial: trial.set("SERVO_STATUS", FIRST - 30, FIRST, state=2)),
    ("servo_in_laser", lambda trial: trial.add(FIRST + 5, "SERVO_STATUS", state=1)),
    ("stop_ends_pulse", stop_in_pulse),
    ("stop_ends_fire", fire_after_stop),
    ("stop_ends_motion", motion_in_fault),
    ("stop_ends_motion", motion_in_hold),
    ("command_expiry", lambda trial: trial.set("MICRON_COMMAND", 400, 400, expiry=0.051)),
    ("command_expiry", lambda trial: trial.set("LASER_COMMAND", 400, 400, expiry=0.006)),
    ("command_expiry", followed_too_long),
    ("command_expiry", lambda trial: trial.set("MICRON_STATE", 400, 400, command_seq=5000)),
    ("command_expiry", lambda trial: trial.set("MICRON_COMMAND", 400, 400, mode=1)),
    ("tip_speed", lambda trial: fast(trial, 40e-6, carried=True)),
    ("tip_speed", lambda trial: trial.set("MICRON_COMMAND", 400, 460, speed_bound=1e-4)),
    ("deflection_step", step_away),
]
