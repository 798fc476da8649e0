# SPDX-License-Identifier: GPL-3.0-or-later
"""A laser trial's log composed by hand, message by message, encoded by what lcm-gen makes of the message types."""
import cmath
import copy
import hashlib
import importlib
import math
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
BEGIN_us = 1_700_000_000_000_000
MS = 1000
LENGTH_ms = 1100
PULSES = {1: 500, 2: 800}  # target: ms of the first FIRE; the truth emits from a millisecond later
PULSE_ms = 20
UM_PER_PX = 5.0
SIZE = (800, 608)
FRAME_ms, AGE_ms = 33, 18  # a frame's period, and the age of its pose when it is sent
FIRST_POSE = (12.5, -7.25, 0.03)  # the truth's pose of frame 0: px, px, rad
TARGETS = {1: (300.0, 250.0), 2: (460.0, 330.0), 3: (500.0, 200.0)}
OFF_um = 12.0  # of each spot
TILE = 20  # cells
VESSEL_COLUMN = 39  # cell, from top to bottom; its edge lies 56 px from the first target, 280 um, the burn's edge 180 um
CHANNELS = {"MICRON_STATE": "micron_state_t", "LASER_STATE": "laser_state_t", "TRUTH": "truth_t", "MARK": "mark_t",
            "RETINA_POSE": "retina_pose_t", "OPERATOR": "operator_t", "BURN_PLAN": "burn_plan_t", "VESSEL_MAP": "vessel_map_t",
            "MICRON_COMMAND": "micron_command_t", "LASER_COMMAND": "laser_command_t", "REGISTRATION": "registration_t",
            "SERVO_STATUS": "servo_status_t", "TOOL_TIP": "tool_tip_t"}
CONFIGURATION = """# how it is called
name: "trial"
aid: automated
hardware:
  camera:
    # of a frame
    width: 800  # [64, 4096]; px
    height: 608  # [64, 4096]; px
servo:
  burning:
    interlocks:
      latency_ms: 20
      frame_ms: 33.4
"""


def message_types():
    """The classes that lcm-gen makes; a folder to be removed."""
    folder = tempfile.mkdtemp(prefix="trial_log_types_")
    types = [str(path) for path in sorted((ROOT / "lcmtypes").glob("*.lcm"))]
    subprocess.run(["lcm-gen", "--python", "--ppath", folder, *types], check=True, capture_output=True, timeout=60)
    operator = pathlib.Path(folder, "eyeslam", "operator_t.py")  # a field has the name of a word of Python
    operator.write_text(re.sub(r'(self\.|")lambda\b', r"\1lambda_", operator.read_text()))
    sys.path.insert(0, folder)
    names = {*CHANNELS.values(), "burn_target_t"}
    found = {name: getattr(importlib.import_module("eyeslam." + name), name) for name in names}
    sys.path.remove(folder)
    shutil.rmtree(folder)
    return found


def retina_of_map(place_px):
    """Where a place of the map is on the retina, m: in the picture's plane, complex numbers turn about its centre."""
    centre = complex((SIZE[0] - 1) / 2, (SIZE[1] - 1) / 2)
    place = centre + cmath.rect(1, FIRST_POSE[2]) * (complex(*place_px) - centre) + complex(*FIRST_POSE[:2])
    return place * UM_PER_PX * 1e-6


def plan_hash(plan):
    packed = struct.pack("<dddq", plan.um_per_px, plan.margin_um, plan.localization_um, plan.map_id) + bytes(plan.map_hash)
    packed += struct.pack("<I", plan.targets)
    for t in plan.target:
        packed += struct.pack("<iidddddd?", t.id, t.tile, t.x_px, t.y_px, t.spot_um, t.burn_um, t.duration, t.power, t.state == 3)
    return hashlib.sha256(packed).digest()


class Trial:
    """Messages in the order of sending: (us, channel, message). Time in the methods: ms since the beginning."""

    def __init__(self, types):
        self.types, self.messages, self.numbers = types, [], {}
        self.in_force = None
        self.say(0, "MARK", kind=0, sender="eyeslam-trial", configuration=CONFIGURATION, configuration_hash="0" * 64)
        self.plan = self.make_plan()
        for t in range(LENGTH_ms):
            self._hardware(t)
            self._vision(t)
            self._human(t)
            self._servo(t)
        self.say(LENGTH_ms, "MARK", kind=1, sender="eyeslam-trial")

    def say(self, t, channel, seq_of="", **fields):
        message = self.types[CHANNELS[channel]]()
        number = self.numbers.setdefault((channel, seq_of), 0)
        self.numbers[(channel, seq_of)] += 1
        message.utime = message.utime_sent = BEGIN_us + t * MS
        message.seq, message.session = number, 7
        if hasattr(message, "tag"):
            message.tag = bytes(16)
        for name, value in fields.items():
            assert name in message.__slots__, name
            setattr(message, name, value)
        self.messages.append((BEGIN_us + t * MS, channel, message))
        return message

    def make_plan(self):
        plan = self.types["burn_plan_t"]()
        plan.map_id, plan.map_hash, plan.um_per_px, plan.margin_um, plan.localization_um = 7, bytes(range(32)), UM_PER_PX, 100.0, 20.0
        for id_, (x_px, y_px) in TARGETS.items():
            target = self.types["burn_target_t"]()
            target.id, target.x_px, target.y_px, target.spot_um, target.burn_um = id_, x_px, y_px, 200.0, 200.0
            target.duration, target.power, target.clearance_um = PULSE_ms * 1e-3, 0.2, 180.0
            plan.target.append(target)
        plan.targets = len(plan.target)
        plan.hash = plan_hash(plan)
        return plan

    def fires(self, t):
        """The target that the servo asks to burn in a millisecond; none, none."""
        return next((target for target, begin in PULSES.items() if begin <= t < begin + PULSE_ms), None)

    def emits(self, t):
        return self.fires(t - 1)

    def begun(self, t):
        """The last target whose pulse has begun."""
        return max((target for target, begin in PULSES.items() if begin < t), default=None)

    def retina(self, t):
        """shift (m, complex) and theta of the retina."""
        return complex(3e-5 * math.sin(t * 1e-3), 2e-5 * math.cos(t * 1e-3)), 0.01 * math.sin(2e-3 * t)

    def _hardware(self, t):
        null = [0.03 + 2e-4 * math.sin(0.03 * t), -0.02, 0.05]
        tip = [null[0] + 3e-4 * math.sin(0.005 * t), null[1] + 4e-4, null[2]]
        self.say(t, "MICRON_STATE", utime=BEGIN_us + (t - 1) * MS, null_position=null, tip_position=tip, null_orientation=[0, 1, 0, 0],
                 tip_orientation=[0, 1, 0, 0], handle_orientation=[0, 1, 0, 0], reach_lateral=2e-3, reach_axial=2e-3,
                 cycle_rate=1e3, speed_limit=0.03, acceleration_limit=10.0, lead=0.0048, flags=(11 if t else 3),
                 command_session=7 if t else 0, command_seq=t - 1)
        emits, last = self.emits(t), self.begun(t)
        if t % 10 == 0 or (emits is None) != (self.emits(t - 1) is None):
            self.say(t, "LASER_STATE", foot_switch=True, armed=True, interlock_closed=True, aiming=True, emitting=emits is not None,
                     pulse=last or 0, target=-1 if last is None else last, pulse_done=emits is None)
        place = retina_of_map(TARGETS[last or 1])
        shift, theta = self.retina(t)
        frame = (t - AGE_ms) // FRAME_ms
        pose = complex(*FIRST_POSE[:2]) + cmath.rect(max(frame, 0), FIRST_POSE[2])  # by a px a frame along the map's x
        self.say(t, "TRUTH", um_per_px=UM_PER_PX, retina_centre=[2e-3, 1.5e-3], retina_shift=[shift.real, shift.imag, 0.0],
                 retina_theta=theta, spot=[place.real + OFF_um * 1e-6, place.imag], **self._places(t, null, tip),
                 shaft=[0, 0, -1], emitting=emits is not None, frame=max(frame, -1),
                 frame_utime=BEGIN_us + frame * FRAME_ms * MS if frame >= 0 else 0, frame_x_px=pose.real,
                 frame_y_px=pose.imag, frame_theta=FIRST_POSE[2])

    def _places(self, t, null, tip):
        """World's places on the retina, that moves."""
        shift, theta = self.retina(t)
        centre = complex(2e-3, 1.5e-3)
        found = {}
        for name, (x, y, z) in (("null", null), ("tip", tip)):
            place = centre + cmath.rect(1, -theta) * (complex(x, y) - centre - shift)
            found[name] = [place.real, place.imag, z]
        return found

    def _vision(self, t):
        if t >= AGE_ms and (t - AGE_ms) % FRAME_ms == 0:
            frame = (t - AGE_ms) // FRAME_ms
            self.say(t, "RETINA_POSE", utime=BEGIN_us + frame * FRAME_ms * MS, frame=frame, exposure=0.008, tracked=True,
                     x_px=float(frame), scale=1.0, map_id=7, um_per_px=UM_PER_PX)
            self._say_tile(t, frame)
            self.say(t, "TOOL_TIP", utime=BEGIN_us + frame * FRAME_ms * MS, frame=frame)

    def _say_tile(self, t, frame):
        """One of 80 x 60 cells' twelve, in turn; the map has grown to that after its first tiles, by the upper row."""
        column, row = frame % 4 * TILE, frame // 4 % 3 * TILE
        cells = bytes(255 if column + i == VESSEL_COLUMN else 0 for _ in range(TILE) for i in range(TILE))
        grown = frame >= 4
        self.say(t, "VESSEL_MAP", map_id=7, map_width=80, map_height=60 if grown else 40, origin_x_px=202.0,
                 origin_y_px=152.0 if grown else 232.0, px_per_cell=4.0, um_per_px=UM_PER_PX, column=column, row=row, width=TILE,
                 height=TILE, cells=TILE * TILE, probability=cells, calibre_px=cells, seen=cells)

    def _human(self, t):
        if t % 50 == 0:
            ready = t >= 100
            self.say(t, "OPERATOR", mode=3 if ready else 1, arm=ready, map_id=7, vessel=-1, plan_approved=ready,
                     plan_hash=self.plan.hash if ready else bytes(32))
        if t == 60:
            self._say_plan(t, 0)

    def _say_plan(self, t, state):
        done = [target for target, begin in PULSES.items() if begin + PULSE_ms < t]
        plan = self.say(t, "BURN_PLAN", seq_of=state, state=state)
        for name in ("hash", "map_hash", "map_id", "um_per_px", "margin_um", "localization_um", "targets"):
            setattr(plan, name, getattr(self.plan, name))
        plan.target = copy.deepcopy(self.plan.target)
        for target in plan.target:
            target.state = int(target.id in done)

    def image(self, t):
        """Of the newest frame whose pose the servo has."""
        return BEGIN_us + (t - AGE_ms) // FRAME_ms * FRAME_ms * MS if t >= AGE_ms else 0

    def _servo(self, t):
        self.say(t, "MICRON_COMMAND", utime=BEGIN_us + (t - 1) * MS, utime_image=self.image(t), mode=2, reference=1,
                 speed_bound=0.03, expiry=0.05)
        target = self.fires(t)
        if t >= 200:
            fire = target is not None
            self.say(t, "LASER_COMMAND", utime=BEGIN_us + (t - 1) * MS, utime_image=self.image(t), action=2 if fire else 1,
                     target=target if fire else -1, pulse=target if fire else 0, duration=PULSE_ms * 1e-3 if fire else 0.0,
                     power=0.2 if fire else 0.0, expiry=0.005)
        if t % 500 == 50:
            self.say(t, "REGISTRATION", valid=True)
        if t == 110 or t in (530, 830):
            self._say_plan(t, 1)
        if t % 20 == 0:
            self.say(t, "SERVO_STATUS", state=3 if t >= 120 else 1)

    def of(self, channel, first=0, last=LENGTH_ms):
        """The messages of a channel sent in [first, last] ms."""
        return [message for time, name, message in self.messages
                if name == channel and BEGIN_us + first * MS <= time <= BEGIN_us + last * MS]

    def leave_out(self, channel, first, last, only=lambda message: True):
        gone = {id(message) for message in self.of(channel, first, last) if only(message)}
        self.messages = [entry for entry in self.messages if id(entry[2]) not in gone]

    def set(self, channel, first, last, only=lambda message: True, **fields):
        for message in self.of(channel, first, last):
            if only(message):
                for name, value in fields.items():
                    assert name in message.__slots__, name
                    setattr(message, name, value)

    def number_again(self, channel):
        """Sequence numbers without gaps once more."""
        for seq, message in enumerate(self.of(channel)):
            message.seq = seq

    def add(self, t, channel, **fields):
        """One message more, sent after all others of that millisecond."""
        message = self.say(t, channel, **fields)
        entry = self.messages.pop()
        time = BEGIN_us + t * MS
        at = next((i for i, other in enumerate(self.messages) if other[0] > time), len(self.messages))
        self.messages.insert(at, entry)
        self.number_again(channel)
        return message

    def write(self, path, late_us=lambda i: 0, damage=lambda data: data):
        with open(path, "wb") as file:
            events = []
            for number, (time, channel, message) in enumerate(self.messages):
                data = message if isinstance(message, bytes) else message.encode()
                events.append((time + late_us(number), struct.pack(
                    ">IqqII", 0xEDA1DA01, number, time + late_us(number), len(channel), len(data)) + channel.encode() + data))
            file.write(damage(b"".join(event for _, event in events)))
