# SPDX-License-Identifier: GPL-3.0-or-later
"""LCM logs as Python sees them: read and written without any code of ours."""
import struct

HEADER = struct.Struct(">IqqII")  # magic, number, us since 1970, bytes of channel and data
MAGIC = 0xEDA1DA01


def read(path):
    """(utime, channel, data) of each event of a whole log."""
    with open(path, "rb") as file:
        content = file.read()
    at = 0
    while at < len(content):
        magic, _, utime, channel, size = HEADER.unpack_from(content, at)
        assert magic == MAGIC, f"{path}: no event at byte {at}"
        at += HEADER.size
        yield utime, content[at:at + channel].decode(), content[at + channel:at + channel + size]
        at += channel + size


def write(path, events):
    with open(path, "wb") as file:
        for number, (utime, channel, data) in enumerate(events):
            file.write(HEADER.pack(MAGIC, number, utime, len(channel), len(data)) + channel.encode() + data)
