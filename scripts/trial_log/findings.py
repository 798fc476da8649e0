# SPDX-License-Identifier: GPL-3.0-or-later
"""The rules by name, the limits that they judge by, and what was found against them."""
from dataclasses import dataclass, field

RULES = {
    # What a log must be, before it proves anything
    "whole_log": "nothing in the file is damaged, and no time goes back",
    "message_type": "each message is what its channel carries, by fingerprint and length",
    "truth_complete": "TRUTH is there each millisecond, for without it nothing is known",
    "sender_time": "a sender's times and numbers never go back, and nothing is of a time after it was sent",
    "command_numbers": "MICRON_COMMAND and LASER_COMMAND leave out no number",
    "image_time": "utime_image of a command is a frame whose pose was sent before, never of later",
    # Pulses
    "pulse_commanded": "all emission by the truth has a FIRE before it that begins its pulse",
    "pulse_told": "LASER_STATE emits when the truth does, by the number and target of that FIRE",
    "pulse_held": "a pulse goes on only while its FIRE is renewed: the newest command is it, and has not expired",
    "pulse_dose": "duration and power asked for are the plan's, and the truth emits no longer",
    "pulse_number": "no number begins two pulses",
    "target_once": "no target of a plan gets two pulses, and no place is burnt again by another target of its map",
    "far_explained": "a pulse more than 60 um off has a retina that moved more than 40 um since its newest frame",
    "plan_hash": "a BURN_PLAN is what its hash says, and the one in force the one that was proposed",
    # Interlocks: at the start of each pulse, and until the reaction is over within it
    "foot_switch": "LASER_STATE: pressed",
    "laser_armed": "LASER_STATE: armed",
    "interlock_closed": "LASER_STATE: the remote interlock is closed",
    "laser_fresh": "LASER_STATE is not older than 50 ms",
    "operator_armed": "OPERATOR arms, and does not stop",
    "operator_fresh": "OPERATOR is not older than 200 ms",
    "plan_approved": "OPERATOR approves the hash of the plan in force",
    "target_valid": "the target is in the plan, and not refused by it or by the newest map",
    "target_unburnt": "the plan in force has it neither as done nor as missed when a pulse begins",
    "vessel_margin": "its clearance to the map's vessels is at least the plan's margin",
    "map_margin": "by the tiles of VESSEL_MAP no vessel is nearer to the burn's edge, now and a second ago",
    "pose_fresh": "the newest RETINA_POSE is not older than latency + one frame, 60 ms at most",
    "pose_tracked": "the newest frame is tracked, in the plan's map",
    "registered": "the newest REGISTRATION is valid",
    "state_fresh": "MICRON_STATE is not older than 50 ms",
    "reach_left": "the measured deflection has 0.2 mm left to the reach, across the shaft and along it",
    "not_saturated": "neither the truth nor MICRON_STATE says that the reach is at its end when a pulse begins",
    "servo_in_laser": "SERVO_STATUS: Laser, when a pulse begins and all along it",
    # Stops and motion
    "stop_ends_pulse": "emission ends within the reaction after SERVO_STATUS enters Hold or Fault",
    "stop_ends_fire": "no FIRE is sent in Hold or Fault",
    "stop_ends_motion": "no FOLLOW is sent in Standby or Fault, nor in Hold after 200 ms",
    "command_expiry": "no command asks to live longer than 50 ms (motion) and 5 ms (laser); none is followed longer",
    "tip_speed": "by the truth, over 5 ms, the tip is no faster than the bound in force, +5 % and 1 mm/s of the sensor's noise",
    "deflection_step": "by the truth, the tip leaves its null in a millisecond by no more than the actuators' speed allows",
}
INTERLOCKS = tuple(RULES)[tuple(RULES).index("foot_switch"):tuple(RULES).index("stop_ends_pulse")]
BY_MAP = "map_margin"  # judged once a pulse, by vessel_map


@dataclass
class Limits:
    """s, m; sources: contracts, section 4, and the issue of trials."""
    far: float = 60e-6
    explains: float = 40e-6
    oldest_pose: float = 0.060
    oldest_laser: float = 0.050
    oldest_operator: float = 0.200
    oldest_state: float = 0.050
    reach_left: float = 0.2e-3
    reaction: float = 0.002  # a cycle, and a millisecond on the way
    transit: float = 0.0  # of a message to who judges by it; 0 in lock step
    motion_expiry: float = 0.050
    laser_expiry: float = 0.005
    hold_ramp: float = 0.200
    period: float = 0.001
    speed_share: float = 1.05
    speed_noise: float = 1e-3  # m/s: 3 um of the sensor, over 5 ms
    step_noise: float = 1e-6  # m: the needle's bending
    map_age: float = 1.0  # of what a servo that looks at the map each half second may not know
    clearance: float = 1e-3  # um: of rounding


@dataclass
class Findings:
    """What was found: of each rule how often, when first, and what."""
    rules: dict = field(default_factory=dict)

    def add(self, rule, seconds, text, count=1):
        if rule not in RULES:
            raise KeyError(rule)
        if count > 0:
            found = self.rules.setdefault(rule, {"rule": rule, "count": 0, "first_s": round(seconds, 6), "first": text})
            found["count"] += int(count)

    def add_all(self, rule, log, times, text):
        """All at these times, us; text tells of the first by its index."""
        if len(times):
            self.add(rule, log.seconds(times[0]), text(0), len(times))

    def count(self):
        return sum(found["count"] for found in self.rules.values())

    def in_order(self):
        return [self.rules[rule] for rule in RULES if rule in self.rules]
