# SPDX-License-Identifier: GPL-3.0-or-later
"""What stops must stop, and how the tip may move."""
import numpy as np

FIRE, FOLLOW = 2, 2
STANDBY, HOLD, FAULT = 0, 4, 5
FOLLOWS_COMMAND = 8
SPEED_SAMPLES = 5  # ms over which the tip's speed is taken: a millisecond alone is the sensor's noise


def check(log, found, truth, findings, limits):
    _pulses(log, found, findings, limits)
    _commands(log, findings, limits)
    _expiry(log, findings, limits)
    if len(log.truth) > SPEED_SAMPLES:
        taken = _taken(log)
        _followed(log, findings, limits, taken)
        _speed(log, truth, findings, limits, taken)


def _state_at(log, rank):
    """SERVO_STATUS then; -1 before the first."""
    at = log.servo_status.last_before(rank)
    state = np.full(np.shape(at), -1)
    state[at >= 0] = log.servo_status["state"][at[at >= 0]]
    return state


def _pulses(log, found, findings, limits):
    """A pulse that began before must not outlast the entry into Hold or Fault; one that begins in it is no more the
    entry's but servo_in_laser's."""
    status = log.servo_status
    if not len(status):
        return
    stopped = status["state"] >= HOLD
    entries = status.time[stopped & ~np.concatenate([[False], stopped[:-1]])]
    for pulse in found:
        inside = entries[(entries >= pulse.begin) & (entries < pulse.end)]
        if len(inside) and pulse.end - 1000 - inside[0] >= limits.reaction * 1e6:
            findings.add("stop_ends_pulse", log.seconds(pulse.begin),
                         f"pulse {pulse.number} ends {(pulse.end - inside[0]) / 1e3:g} ms after the stop")


def _commands(log, findings, limits):
    """A state is told at the end of its cycle, so a command is judged by the state before it and by that of its time."""
    for channel, field, asks, states in ((log.laser_command, "action", FIRE, (HOLD, FAULT)),
                                         (log.micron_command, "mode", FOLLOW, (STANDBY, FAULT))):
        asking = np.flatnonzero(channel[field] == asks)
        before = _state_at(log, channel.rank[asking])
        now = _state_at(log, log.known_at(channel.time[asking]))
        bad = asking[np.isin(before, states) & np.isin(now, states)]
        rule = "stop_ends_fire" if asks == FIRE and channel is log.laser_command else "stop_ends_motion"
        findings.add_all(rule, log, channel.time[bad], lambda i: f"command {channel['seq'][bad[i]]}")
    _hold(log, findings, limits)


def _hold(log, findings, limits):
    status, motions = log.servo_status, log.micron_command
    if not len(status):
        return
    held = status["state"] == HOLD
    begins = np.flatnonzero(held & ~np.concatenate([[False], held[:-1]]))
    follows = motions["mode"] == FOLLOW
    for i in begins:
        after = np.flatnonzero(~held[i:])
        end = status.rank[i + after[0]] if len(after) else np.iinfo(np.int64).max
        late = motions.time > status.time[i] + (limits.hold_ramp + limits.period) * 1e6
        bad = np.flatnonzero(follows & late & (motions.rank > status.rank[i]) & (motions.rank < end)
                             & (_state_at(log, log.known_at(motions.time)) == HOLD))
        findings.add_all("stop_ends_motion", log, motions.time[bad], lambda i, b=bad: f"command {motions['seq'][b[i]]} in Hold")


def _expiry(log, findings, limits):
    for channel, longest in ((log.micron_command, limits.motion_expiry), (log.laser_command, limits.laser_expiry)):
        bad = np.flatnonzero(~((channel["expiry"] > 0) & (channel["expiry"] <= longest + 1e-9)))
        findings.add_all("command_expiry", log, channel.time[bad],
                         lambda i, b=bad, c=channel: f"command {c['seq'][b[i]]} asks for {c['expiry'][b[i]] * 1e3:g} ms")


def _taken(log):
    """Of each MICRON_STATE that follows a command: which MICRON_COMMAND; -1 where it follows none, -2 an unknown one."""
    motions, states = log.micron_command, log.micron_state
    number = {key: i for i, key in enumerate(zip(motions["session"].tolist(), motions["seq"].tolist()))}
    follows = (states["flags"] & FOLLOWS_COMMAND) != 0
    keys = zip(follows, states["command_session"].tolist(), states["command_seq"].tolist())
    return np.array([number.get((session, seq), -2) if follow else -1 for follow, session, seq in keys], dtype=np.int64)


def _followed(log, findings, limits, taken):
    motions, states = log.micron_command, log.micron_state
    unknown = np.flatnonzero(taken == -2)
    findings.add_all("command_expiry", log, states.time[unknown], lambda i: "a command is followed that nobody sent")
    known = np.flatnonzero(taken >= 0)
    command = taken[known]
    life = np.minimum(motions["expiry"][command], limits.motion_expiry)
    late = (states.time[known] - motions.time[command]) * 1e-6 > life + limits.period
    bad = known[late | (motions["mode"][command] != FOLLOW)]
    findings.add_all("command_expiry", log, states.time[bad],
                     lambda i: f"command {motions['seq'][taken[bad[i]]]} is followed, and is not in force")


def _speed(log, truth, findings, limits, taken):
    """The bound is the actuators', or the command's that is followed."""
    states = log.micron_state
    at = states.last_before(log.known_at(log.truth.time))
    if not len(states):
        return
    bounds = states["speed_limit"].copy()
    known = np.flatnonzero(taken >= 0)
    bounds[known] = np.minimum(bounds[known], log.micron_command["speed_bound"][taken[known]])
    actuator, bound = states["speed_limit"][np.maximum(at, 0)], bounds[np.maximum(at, 0)]
    tip, time, n = truth.tip_world(), log.truth.time, SPEED_SAMPLES
    even = (time[n:] - time[:-n]) == n * 1000
    speed = np.linalg.norm(tip[n:] - tip[:-n], axis=1) / (n * 1e-3)
    loosest = np.lib.stride_tricks.sliding_window_view(bound, n + 1).max(axis=1)
    bad = np.flatnonzero(even & ~(speed <= limits.speed_share * loosest + limits.speed_noise))
    findings.add_all("tip_speed", log, time[bad], lambda i: f"{speed[bad].max() * 1e3:.1f} mm/s at most")
    left = tip - truth.null_world()
    step = np.linalg.norm(np.diff(left, axis=0), axis=1)
    passed = np.diff(time) * 1e-6
    bad = np.flatnonzero(~(step <= limits.speed_share * actuator[1:] * passed + limits.step_noise))
    findings.add_all("deflection_step", log, time[1:][bad], lambda i: f"{step[bad].max() * 1e6:.1f} um in a step at most")
