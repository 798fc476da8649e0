# SPDX-License-Identifier: GPL-3.0-or-later
"""An LCM log as events, in whatever state the file is: what is no event is left out and counted."""
import mmap
import struct

SYNC = b"\xed\xa1\xda\x01"
HEAD = struct.Struct(">4sqqii")  # sync word, number, us since 1970, bytes of the channel's name, bytes of data
LONGEST_CHANNEL = 63  # bytes; LCM's own limit
LARGEST_DATA = 1 << 26  # bytes; more is damage


class LogEvents:
    """The events of a file by channel: times (us), where the data lie, and the place of each in the log."""

    def __init__(self, path):
        """@throws OSError  cannot be read; ValueError  is empty"""
        with open(path, "rb") as file:
            self.bytes = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        self.channels = {}  # name: [(time, first byte, bytes, place)]
        self.count, self.skipped, self.gaps, self.cut_off = 0, 0, 0, False
        self._read()

    def _read(self):
        at, size, places = 0, len(self.bytes), {}
        while at < size:
            event = self._event_at(at, size)
            if event is None:
                at = self._skip(at, size)
                continue
            time, channel, first, length = event
            if channel not in places:
                places[channel] = self.channels.setdefault(channel.decode("ascii", "replace"), [])
            places[channel].append((time, first, length, self.count))
            self.count += 1
            at = first + length

    def _event_at(self, at, size):
        """Believed when its header is possible and the next event follows it, or the file ends there."""
        if at + HEAD.size > size:
            return None
        sync, _, time, name, length = HEAD.unpack_from(self.bytes, at)
        if sync != SYNC or not 1 <= name <= LONGEST_CHANNEL or not 0 <= length <= LARGEST_DATA:
            return None
        first = at + HEAD.size + name
        end = first + length
        if end > size or (end < size and self.bytes[end:end + len(SYNC)] != SYNC[:size - end]):
            return None
        return time, self.bytes[at + HEAD.size:first], first, length

    def _skip(self, at, size):
        """To the next place where an event may begin."""
        self.gaps += 1
        begins_one = self.bytes[at:at + len(SYNC)] == SYNC[:size - at]
        found = self.bytes.find(SYNC, at + 1)
        while found != -1 and self._event_at(found, size) is None:
            found = self.bytes.find(SYNC, found + 1)
        self.cut_off |= found == -1 and begins_one
        end = size if found == -1 else found
        self.skipped += end - at
        return end

    def damage(self):
        """What was left out, in words; empty where nothing was."""
        if not self.gaps:
            return ""
        return f"{self.skipped} bytes in {self.gaps} places are no events" + (", its end is cut off" if self.cut_off else "")
