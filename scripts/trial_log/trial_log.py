# SPDX-License-Identifier: GPL-3.0-or-later
"""A trial's log as arrays: each channel's messages in the order in which they could be known."""
import re

import numpy as np

from trial_log.log_events import LogEvents
from trial_log.message_types import LEAST, read_types

TYPES = {"RETINA_POSE": "retina_pose_t", "VESSEL_MAP": "vessel_map_t", "TOOL_TIP": "tool_tip_t",
         "REGISTRATION": "registration_t", "MICRON_STATE": "micron_state_t", "MICRON_COMMAND": "micron_command_t",
         "LASER_COMMAND": "laser_command_t", "LASER_STATE": "laser_state_t", "OPERATOR": "operator_t",
         "BURN_PLAN": "burn_plan_t", "SERVO_STATUS": "servo_status_t", "MARK": "mark_t", "TRUTH": "truth_t"}
START = 0  # of a MARK
OTHER_CLOCK_us = 500_000  # a sender farther from the log's own time has another clock: the log's counts then
SETTING = re.compile(r"^( *)([\w]+):(?: +(.*?))?(?: +#.*)?$")


class Channel:
    """Messages of one channel. `data` by field name; `time` us, when sent; `rank` in the order of the whole log."""

    def __init__(self, data, events):
        self.data = data
        self.bytes = [(event[1], event[2]) for event in events]  # first, length
        self.logged = np.array([event[0] for event in events], dtype=np.int64)
        self.place = np.array([event[3] for event in events], dtype=np.int64)
        sent = np.asarray(data["utime_sent"], dtype=np.int64)
        self.time = np.where(np.abs(sent - self.logged) < OTHER_CLOCK_us, sent, self.logged)
        self.rank = self.place

    def __len__(self):
        return len(self.time)

    def __getitem__(self, field):
        return self.data[field]

    def last_before(self, rank):
        """Index of the newest message that was known before this rank (a number or an array); -1 = none."""
        return np.searchsorted(self.rank, rank) - 1


def settings(yaml):
    """"a.b.c" -> text, of the plain nested YAML that the programs write."""
    found, path = {}, []
    for line in yaml.splitlines():
        match = SETTING.match(line)
        if not match:
            continue
        while path and path[-1][0] >= len(match.group(1)):
            path.pop()
        path.append((len(match.group(1)), match.group(2)))
        if match.group(3):
            found[".".join(name for _, name in path)] = match.group(3).strip('"')
    return found


class TrialLog:
    """@throws OSError, ValueError  the file cannot be read as a log; TypeFileError  the types cannot"""

    def __init__(self, path, types_folder):
        self.types = read_types(types_folder)
        self.events = LogEvents(path)
        self.strangers = []  # (channel, time, what is wrong) of messages that are not what their channel carries
        self.channels = {name: self._channel(name) for name in TYPES}
        for name in sorted(set(self.events.channels) - set(TYPES)):
            self.strangers.append((name, self.events.channels[name][0][0], "a channel that the contracts do not know"))
        self._rank()
        self._configure()

    def __getattr__(self, name):
        channels = self.__dict__.get("channels", {})
        if name.upper() not in channels:
            raise AttributeError(name)
        return channels[name.upper()]

    def _channel(self, name):
        kind = self.types.get(TYPES[name])
        events = self.events.channels.get(name, [])
        if kind is None:
            raise ValueError(f"no type {TYPES[name]} for {name}")
        good = [event for event in events if self._has_type(name, kind, event)]
        if kind.layout is not None or name == "VESSEL_MAP":
            return Channel(self._heads(kind.head, good), good)
        return Channel(*self._varying(name, kind, good))

    def _has_type(self, name, kind, event):
        time, first, length, _ = event
        size = 8 + kind.head.itemsize
        if length < max(LEAST, size) or (kind.layout is not None and length != size):
            self.strangers.append((name, time, f"{length} bytes are no {kind.name}"))
            return False
        if int.from_bytes(self.events.bytes[first:first + 8], "big") != kind.fingerprint:
            self.strangers.append((name, time, f"its fingerprint is not that of {kind.name}"))
            return False
        return True

    def _heads(self, head, events):
        packed = np.dtype([("fingerprint", ">u8"), ("message", head)])
        bytes_ = b"".join(self.events.bytes[first:first + packed.itemsize] for _, first, _, _ in events)
        return _fields((np.frombuffer(bytes_, packed) if events else np.zeros(0, packed))["message"])

    def _varying(self, name, kind, events):
        rows, good = [], []
        for event in events:
            data = self.events.bytes[event[1] + 8:event[1] + event[2]]
            try:
                row, end = kind.read(data)
                if end != len(data):
                    raise ValueError("its length is another")
            except ValueError as error:
                self.strangers.append((name, event[0], str(error)))
                continue
            rows.append(row)
            good.append(event)
        fields = [field for field, _, _ in kind.fields]
        return {field: _column([row[field] for row in rows]) for field in fields}, good

    def _rank(self):
        """By time, of one time as logged. Where each message was logged the moment it was sent, the log's order is
        the order in which everything became known."""
        place = np.concatenate([channel.place for channel in self.channels.values()])
        time = np.concatenate([channel.time for channel in self.channels.values()])
        order = np.lexsort((place, time))
        rank = np.empty(len(order), dtype=np.int64)
        rank[order] = np.arange(len(order))
        self.times, at = time[order], 0
        for channel in self.channels.values():
            channel.rank, at = rank[at:at + len(channel)], at + len(channel)
            _sort(channel)
        self.in_step = all(np.array_equal(channel.logged, channel.time) for channel in self.channels.values())
        self.start = int(self.times[0]) if len(order) else 0

    def known_at(self, time):
        """The rank before which everything had been sent at that time, us (a number or an array)."""
        return np.searchsorted(self.times, time, side="right")

    def seconds(self, time):
        return (int(time) - self.start) * 1e-6

    def _configure(self):
        """Of all programs that tell theirs; of a key that two have, the first's."""
        self.settings = {}
        for kind, text in zip(self.mark["kind"], self.mark["configuration"]):
            self.settings = {**(settings(text) if kind == START else {}), **self.settings}

    def setting(self, ending):
        """The number under the first key that ends so; none where there is none."""
        for key, text in self.settings.items():
            if key == ending or key.endswith("." + ending):
                try:
                    return float(text)
                except ValueError:
                    return None
        return None


def _fields(table):
    """The columns of a table, in the byte order of this computer."""
    return {field: np.ascontiguousarray(table[field].astype(table[field].dtype.newbyteorder("=")))
            for field in table.dtype.names}


def _column(values):
    simple = not values or not isinstance(values[0], (list, str))
    return np.array(values) if simple else values


def _sort(channel):
    order = np.argsort(channel.rank, kind="stable")
    if np.array_equal(order, np.arange(len(order))):
        return
    channel.bytes = [channel.bytes[i] for i in order]
    for name in ("rank", "time", "place", "logged"):
        setattr(channel, name, getattr(channel, name)[order])
    for field, values in channel.data.items():
        channel.data[field] = values[order] if isinstance(values, np.ndarray) else [values[i] for i in order]
