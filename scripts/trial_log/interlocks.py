# SPDX-License-Identifier: GPL-3.0-or-later
"""Each interlock of a pulse, judged by messages and truth at the decision to fire and until the reaction is over.

An interlock that cannot be seen to be closed (no message, not a number) is open.
"""
import numpy as np

from trial_log.findings import BY_MAP, INTERLOCKS
from trial_log.plans import DONE, MISSED, REFUSED

LASER, HOLD, FAULT = 3, 4, 5  # SERVO_STATUS
REACH_BITS = 3
OF_THE_LASER = ("foot_switch", "laser_armed", "interlock_closed")  # all that a pulse by hand has
AT_THE_START = ("target_unburnt", "not_saturated")


def check(log, plans, found, findings, limits, near):
    """@param near  pulses whose map has a vessel too near
    @return  the number of pulses with any interlock open"""
    judge, open_pulses = Judge(log, plans, limits), 0
    by_hand = plans.by_hand
    for pulse in (pulse for pulse in found if pulse.command is not None):
        names = [name for name in (OF_THE_LASER if by_hand else INTERLOCKS) if name != BY_MAP and _is_open(judge, pulse, name)]
        for name in names:
            findings.add(name, log.seconds(pulse.begin), f"pulse {pulse.number} on target {pulse.target}")
        open_pulses += bool(names) or any(pulse is other for other in near)
    return open_pulses


def _is_open(judge, pulse, name):
    """At the start: by what was known when FIRE was sent, and just before, where a message was on its way. Later: at
    any time from which the reaction has passed and the pulse still goes on."""
    log, limits = judge.log, judge.limits
    closed = getattr(judge, name)
    decided = int(log.laser_command.time[pulse.command])
    ranks, times = [log.laser_command.rank[pulse.command]], [decided]
    if limits.transit > 0:
        times.append(decided - int(limits.transit * 1e6))
        ranks.append(log.known_at(times[-1]))
    if not closed(pulse, np.array(ranks), np.array(times)).any():
        return True
    times = log.truth.time[pulse.first:pulse.last + 1] - int(limits.reaction * 1e6)
    times = times[times > decided]
    if name in AT_THE_START or not len(times):
        return False
    return not closed(pulse, log.known_at(times), times).all()


class Judge:
    """An interlock a method: closed or not, at instants given by rank and time (us)."""

    def __init__(self, log, plans, limits):
        self.log, self.plans, self.limits = log, plans, limits
        self.room = _room(log.micron_state) if len(log.micron_state) else np.zeros(0)

    def _newest(self, channel, rank, holds):
        """Whether something holds of the newest message; where there is none it does not."""
        at = channel.last_before(rank)
        result = np.zeros(len(at), dtype=bool)
        result[at >= 0] = holds(at[at >= 0])
        return result

    def _is_set(self, channel, field, rank):
        return self._newest(channel, rank, lambda at: channel[field][at] != 0)

    def _is_fresh(self, channel, rank, time, oldest):
        at = channel.last_before(rank)
        age = (time - channel.time[at]) * 1e-6 if len(channel) else np.full(len(at), np.inf)
        return (at >= 0) & (age <= oldest + 1e-9)

    def foot_switch(self, pulse, rank, time):
        return self._is_set(self.log.laser_state, "foot_switch", rank)

    def laser_armed(self, pulse, rank, time):
        return self._is_set(self.log.laser_state, "armed", rank)

    def interlock_closed(self, pulse, rank, time):
        return self._is_set(self.log.laser_state, "interlock_closed", rank)

    def laser_fresh(self, pulse, rank, time):
        return self._is_fresh(self.log.laser_state, rank, time, self.limits.oldest_laser)

    def operator_armed(self, pulse, rank, time):
        said = self.log.operator
        return self._newest(said, rank, lambda at: (said["arm"][at] != 0) & (said["stop"][at] == 0))

    def operator_fresh(self, pulse, rank, time):
        return self._is_fresh(self.log.operator, rank, time, self.limits.oldest_operator)

    def plan_approved(self, pulse, rank, time):
        """The operator's hash is a proposal's that bears it rightly, and the newest plan in force has it too."""
        said = self.log.operator.last_before(rank)
        return np.array([self._approves(i, r) for i, r in zip(said, rank)], dtype=bool)

    def _approves(self, said, rank):
        in_force = self.plans.newest_in_force(rank)
        if said < 0 or in_force is None or not self.log.operator["plan_approved"][said]:
            return False
        hash_ = bytes(self.log.operator["plan_hash"][said])
        return self.plans.proposal(hash_, rank) is not None and bytes(self.plans.messages[in_force]["hash"]) == hash_

    def _target(self, pulse, rank, holds):
        """Whether something holds of the target in the operator's plan and in the newest one in force."""
        planned = self.plans.targets[pulse.plan].get(pulse.target) if pulse.plan is not None else None
        if planned is None:
            return np.zeros(len(rank), dtype=bool)
        return np.array([holds(word) and holds(planned) if (word := self.plans.word(r, pulse.target)) is not None
                         else holds(planned) for r in rank], dtype=bool)

    def target_valid(self, pulse, rank, time):
        if pulse.plan is None:  # without a plan its target is not judged: plan_approved is open
            return np.ones(len(rank), dtype=bool)
        return self._target(pulse, rank, lambda target: target["state"] != REFUSED)

    def target_unburnt(self, pulse, rank, time):
        if pulse.plan is None or pulse.target not in self.plans.targets[pulse.plan]:
            return np.ones(len(rank), dtype=bool)
        return self._target(pulse, rank, lambda target: target["state"] not in (DONE, MISSED))

    def vessel_margin(self, pulse, rank, time):
        if pulse.plan is None or pulse.target not in self.plans.targets[pulse.plan]:
            return np.ones(len(rank), dtype=bool)
        least = self.plans.messages[pulse.plan]["margin_um"] - self.limits.clearance
        return self._target(pulse, rank, lambda target: bool(target["clearance_um"] >= least))

    def pose_fresh(self, pulse, rank, time):
        poses = self.log.retina_pose
        at = poses.last_before(rank)
        age = (time - poses["utime"][at]) * 1e-6 if len(poses) else np.full(len(at), np.inf)
        return (at >= 0) & (age <= self.limits.oldest_pose + 1e-9)

    def pose_tracked(self, pulse, rank, time):
        poses = self.log.retina_pose
        map_id = self.plans.messages[pulse.plan]["map_id"] if pulse.plan is not None else 0
        return self._newest(poses, rank, lambda at: (poses["tracked"][at] != 0)
                            & ((poses["map_id"][at] == map_id) | (map_id == 0)))

    def registered(self, pulse, rank, time):
        return self._is_set(self.log.registration, "valid", rank)

    def state_fresh(self, pulse, rank, time):
        return self._is_fresh(self.log.micron_state, rank, time, self.limits.oldest_state)

    def reach_left(self, pulse, rank, time):
        return self._newest(self.log.micron_state, rank, lambda at: self.room[at] >= self.limits.reach_left - 1e-9)

    def not_saturated(self, pulse, rank, time):
        states = self.log.micron_state
        said = self._newest(states, rank, lambda at: (states["limits"][at] & REACH_BITS) == 0)
        return said & (self.log.truth["saturated"][pulse.first] == 0)

    def servo_in_laser(self, pulse, rank, time):
        """Hold and Fault that come within a pulse are judged by stop_ends_pulse."""
        status = self.log.servo_status
        starts = rank <= self.log.laser_command.rank[pulse.command]
        return self._newest(status, rank, lambda at: (status["state"][at] == LASER)
                            | (~starts[status.last_before(rank) >= 0] & (status["state"][at] >= HOLD)))


def _room(states):
    """m that each measured deflection has left to the reach: a cylinder about the null along the shaft."""
    w, x, y, z = states["tip_orientation"].T
    shaft = np.column_stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
    deflection = states["tip_position"] - states["null_position"]
    along = np.sum(deflection * shaft, axis=1)
    across = np.linalg.norm(deflection - along[:, None] * shaft, axis=1)
    return np.minimum(states["reach_lateral"] - across, states["reach_axial"] - np.abs(along))
