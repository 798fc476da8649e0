# SPDX-License-Identifier: GPL-3.0-or-later
"""Each pulse by the truth: who asked for it, what it was to be, where it went."""
from dataclasses import dataclass
from typing import Optional

import numpy as np

FIRE = 2
EDGE_us = 1000  # a message about an edge of the emission may be a millisecond before or after the truth's
STATE_us = 10_000  # between two LASER_STATE; a laser that says nothing at all is not asked here, but by laser_fresh


@dataclass
class Pulse:
    """Indices of TRUTH [first, last], times in us; the command is its first FIRE, an index of LASER_COMMAND."""
    first: int
    last: int
    begin: int
    end: int
    command: Optional[int] = None
    number: int = 0
    session: int = 0
    target: int = -1
    plan: Optional[int] = None  # index of the proposal that the operator approved
    placement: Optional[float] = None  # m
    moved: Optional[float] = None  # m, of the retina, from the newest frame to the pulse's end

    def is_far(self, limits):
        """What is not a number is far."""
        return self.placement is not None and not self.placement <= limits.far

    def is_explained(self, limits):
        return self.moved is not None and self.moved > limits.explains


def find(log, plans, truth, findings, limits):
    """All pulses, in their order."""
    found = [_command(log, findings, pulse) for pulse in _emissions(log)]
    for pulse in found:
        if pulse.command is not None:
            pulse.plan = plans.approved(log.laser_command.rank[pulse.command])
            _place(log, plans, truth, pulse)
            _held(log, findings, limits, pulse)
            _dose(log, plans, findings, limits, pulse)
            _explained(log, plans, findings, limits, pulse)
    _told(log, findings, found)
    _once(log, plans, findings, found)
    return found


def _emissions(log):
    on = np.concatenate([[0], (log.truth["emitting"] != 0).astype(np.int8), [0]])
    for first, after in zip(np.flatnonzero(np.diff(on) > 0), np.flatnonzero(np.diff(on) < 0)):
        time = log.truth.time
        end = time[after] if after < len(time) else time[after - 1] + 1000
        yield Pulse(int(first), int(after) - 1, int(time[first]), int(end))


def _command(log, findings, pulse):
    commands = log.laser_command
    newest = int(commands.last_before(log.truth.rank[pulse.first]))
    if newest < 0 or commands["action"][newest] != FIRE:
        findings.add("pulse_commanded", log.seconds(pulse.begin), "the truth emits, and nobody asked for it")
        return pulse
    pulse.number, pulse.session = int(commands["pulse"][newest]), int(commands["session"][newest])
    pulse.target = int(commands["target"][newest])
    pulse.command = int(_fires(log, pulse, newest)[0])
    return pulse


def _fires(log, pulse, one):
    """The row of this pulse's FIRE commands that holds one of them."""
    commands = log.laser_command
    others = np.flatnonzero((commands["action"] != FIRE) | (commands["pulse"] != pulse.number)
                            | (commands["session"] != pulse.session))
    after = np.searchsorted(others, one)
    first = others[after - 1] + 1 if after > 0 else 0
    return np.arange(first, others[after] if after < len(others) else len(commands))


def _target(plans, pulse):
    return plans.targets[pulse.plan].get(pulse.target) if pulse.plan is not None else None


def _place(log, plans, truth, pulse):
    """Placement, and how far the retina went since the newest frame that the servo could know when it began."""
    target = _target(plans, pulse)
    if target is None or truth.image_centre is None:
        return
    place_px = float(target["x_px"]), float(target["y_px"])
    if plans.by_hand:  # its map is the true one, and it sees what the camera would
        place, newest = np.array(place_px) * truth.m_per_px(), int(log.truth["frame_utime"][pulse.first])
    else:
        place, newest = _by_frames(log, truth, pulse, plans.messages[pulse.plan]["map_id"], place_px)
    if place is None:
        return
    spot = log.truth["spot"][pulse.first:pulse.last + 1].mean(axis=0)
    pulse.placement = float(np.hypot(*(spot - place)))
    way = truth.world_of_retina(pulse.end, place) - truth.world_of_retina(newest, place)
    pulse.moved = float(np.hypot(*way))


def _by_frames(log, truth, pulse, map_id, place_px):
    """(place on the retina, us of the newest frame); none where no frame tells."""
    poses = log.retina_pose
    tracked = np.flatnonzero(poses["tracked"] != 0)
    known = tracked[poses.rank[tracked] < log.laser_command.rank[pulse.command]]
    begun = tracked[(poses["map_id"][tracked] == map_id) | (map_id == 0)]
    if not len(known) or not len(begun):
        return None, 0
    first = {name: poses[name][begun[0]] for name in ("utime", "x_px", "y_px", "theta")}
    return truth.retina_of_map(first, place_px), int(poses["utime"][known[-1]])


def _explained(log, plans, findings, limits, pulse):
    if pulse.placement is None and _target(plans, pulse) is not None:
        findings.add("far_explained", log.seconds(pulse.begin), f"where pulse {pulse.number} should be cannot be told")
    elif pulse.is_far(limits) and not pulse.is_explained(limits):
        findings.add("far_explained", log.seconds(pulse.begin), f"pulse {pulse.number} is {pulse.placement * 1e6:.0f} um off, "
                     f"and the retina moved {pulse.moved * 1e6:.0f} um")


def _held(log, findings, limits, pulse):
    """From the reaction after its first command on: then the laser must have heard what the newest command says."""
    commands = log.laser_command
    times = log.truth.time[pulse.first:pulse.last + 1]
    heard = times - int(limits.reaction * 1e6)
    newest = commands.last_before(log.known_at(heard))
    judged = newest >= pulse.command
    newest, times = newest[judged], times[judged]
    still = (commands["action"][newest] == FIRE) & (commands["pulse"][newest] == pulse.number)
    newest_now = commands.last_before(log.known_at(times))
    life = np.minimum(commands["expiry"][newest_now], limits.laser_expiry)
    fresh = (times - commands.time[newest_now]) * 1e-6 <= life + limits.period
    bad = np.flatnonzero(~(still & fresh))
    if len(bad):
        findings.add("pulse_held", log.seconds(times[bad[0]]), f"pulse {pulse.number} goes on without a FIRE in force")


def _dose(log, plans, findings, limits, pulse):
    target = _target(plans, pulse)
    fires = _fires(log, pulse, pulse.command)
    asked = {name: log.laser_command[name][fires] for name in ("duration", "power")}
    if target is not None:
        for name in asked:
            if not np.allclose(asked[name], target[name], rtol=1e-9, atol=0.0):
                findings.add("pulse_dose", log.seconds(pulse.begin), f"pulse {pulse.number} asks for another {name} than the plan")
    emitted = (pulse.end - pulse.begin) * 1e-6
    if emitted > asked["duration"].max() + limits.period * 1.5:
        findings.add("pulse_dose", log.seconds(pulse.begin), f"pulse {pulse.number} emits for {emitted * 1e3:g} ms")


def _told(log, findings, found):
    """LASER_STATE by the truth. Where they differ, the edge must be near."""
    states, time = log.laser_state, log.truth.time
    says = states["emitting"] != 0
    pulse_of = np.full(len(states), -1)
    for i, pulse in enumerate(found):
        near = (states.time >= pulse.begin - EDGE_us) & (states.time <= pulse.end + EDGE_us) & says
        pulse_of[near] = i
        inside = (states.time > pulse.begin + EDGE_us) & (states.time < pulse.end - EDGE_us)
        wrong = near & ((states["pulse"] != pulse.number) | (states["target"] != pulse.target))
        spoken = ((states.time >= pulse.begin) & (states.time <= pulse.end + STATE_us)).any()
        silent = spoken and not near.any()
        if pulse.command is not None and (wrong.any() or silent or (inside & ~says).any()):
            findings.add("pulse_told", log.seconds(pulse.begin), f"LASER_STATE says something else of pulse {pulse.number}")
    if len(time):
        lies = np.flatnonzero(says & (pulse_of < 0))
        findings.add_all("pulse_told", log, states.time[lies], lambda i: "LASER_STATE emits, and the truth does not")


def _once(log, plans, findings, found):
    numbers, burnt = set(), []
    for pulse in (pulse for pulse in found if pulse.command is not None):
        if (pulse.session, pulse.number) in numbers:
            findings.add("pulse_number", log.seconds(pulse.begin), f"pulse {pulse.number} begins again")
        numbers.add((pulse.session, pulse.number))
        target = _target(plans, pulse)
        if target is None:
            continue
        plan = plans.messages[pulse.plan]
        for id_, hash_, map_id, place in burnt:
            same = (id_, hash_) == (pulse.target, bytes(plan["hash"]))
            near = np.hypot(place[0] - target["x_px"], place[1] - target["y_px"]) * plan["um_per_px"] < 0.5 * target["burn_um"]
            if same or (map_id == plan["map_id"] and near):
                findings.add("target_once", log.seconds(pulse.begin), f"target {pulse.target} is burnt where target {id_} was")
                break
        burnt.append((pulse.target, bytes(plan["hash"]), plan["map_id"], (target["x_px"], target["y_px"])))
