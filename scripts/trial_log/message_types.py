# SPDX-License-Identifier: GPL-3.0-or-later
"""Message types as their .lcm files say: layout and fingerprint by LCM's published rules, without LCM's own code.

A fingerprint is over the names, types and dimensions of all fields, so a message of a changed type is noticed.
"""
import functools
import re

import numpy as np

SIZES = {"int8_t": "i1", "byte": "u1", "boolean": "u1", "int16_t": ">i2", "int32_t": ">i4", "int64_t": ">i8",
         "float": ">f4", "double": ">f8"}
PRIMITIVES = {*SIZES, "string"}
ALL_64 = (1 << 64) - 1
FIELD = re.compile(r"^\s*([\w.]+)\s+(\w+)((?:\s*\[\s*\w+\s*\])*)\s*$")
LONGEST_LIST = 4096  # elements of a list that a message tells the length of
LEAST = 40  # bytes of any message: the fingerprint and what all begin with


class TypeFileError(Exception):
    """A .lcm file that is missing or says nothing that can be read."""


def _signed(value):
    value &= ALL_64
    return value - (1 << 64) if value >> 63 else value


def _add_byte(hash_so_far, byte):
    return _signed((((hash_so_far << 8) & ALL_64) ^ (hash_so_far >> 55)) + byte)


def _add_text(hash_so_far, text):
    hash_so_far = _add_byte(hash_so_far, len(text))
    for byte in text.encode():
        hash_so_far = _add_byte(hash_so_far, byte)
    return hash_so_far


def _without_comments(text):
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)


class MessageType:
    """One struct: its fields in their order, each (name, type, dimensions)."""

    def __init__(self, path, types):
        self.types, self.name = types, path.stem
        try:
            body = re.search(r"struct\s+\w+\s*\{(.*)\}", _without_comments(path.read_text()), re.S).group(1)
        except (OSError, UnicodeDecodeError, AttributeError):
            raise TypeFileError(f"{path}: not a message type") from None
        self.fields = [self._field(path, line) for line in body.split(";")
                       if line.strip() and not line.strip().startswith("const")]

    @staticmethod
    def _field(path, line):
        match = FIELD.match(line)
        if not match:
            raise TypeFileError(f"{path}: '{line.strip()}' is not a field")
        return match.group(2), match.group(1).split(".")[-1], re.findall(r"\w+", match.group(3))

    def _sum(self):
        total = 0x12345678
        for name, kind, dimensions in self.fields:
            total = _add_text(total, name)
            if kind in PRIMITIVES:
                total = _add_text(total, kind)
            total = _add_byte(total, len(dimensions))
            for size in dimensions:
                total = _add_text(_add_byte(total, 0 if size.isdigit() else 1), size)
        return total

    @functools.cached_property
    def fingerprint(self):
        inner = sum(self.types[kind].fingerprint for _, kind, _ in self.fields if kind not in PRIMITIVES)
        total = (self._sum() + inner) & ALL_64
        return ((total << 1) & ALL_64) + (total >> 63)

    @functools.cached_property
    def head(self):
        """The fields before the first whose size varies, as a numpy type, without the fingerprint."""
        parts = []
        for name, kind, dimensions in self.fields:
            if kind not in SIZES or not all(size.isdigit() for size in dimensions):
                break
            parts.append((name, SIZES[kind], tuple(int(size) for size in dimensions)))
        return np.dtype(parts)

    @functools.cached_property
    def layout(self):
        """All of it as a numpy type; none where the size of a message varies."""
        return self.head if len(self.head.names) == len(self.fields) else None

    def read(self, data, at=0):
        """(fields as a dict, where they end). @throws ValueError  too short, or a length is impossible"""
        values = {}
        for name, kind, dimensions in self.fields:
            shape = [int(size) if size.isdigit() else int(values[size]) for size in dimensions]
            if any(not 0 <= size <= LONGEST_LIST for size in shape):
                raise ValueError(f"{name} has an impossible length")
            values[name], at = self._read_field(data, at, kind, shape)
        return values, at

    def _read_field(self, data, at, kind, shape):
        if kind == "string":
            length, at = int(np.frombuffer(data, ">i4", 1, at)[0]), at + 4
            if not 1 <= length <= len(data) - at:
                raise ValueError("a text has an impossible length")
            return bytes(data[at:at + length - 1]).decode("utf-8", "replace"), at + length
        if kind in SIZES:
            count = int(np.prod(shape)) if shape else 1
            values = np.frombuffer(data, SIZES[kind], count, at)
            return (values.reshape(shape) if shape else values[0]), at + values.nbytes
        members = []
        for _ in range(shape[0] if shape else 1):
            member, at = self.types[kind].read(data, at)
            members.append(member)
        return (members if shape else members[0]), at


def read_types(folder):
    """All types of a folder by their name. @throws TypeFileError"""
    types = {}
    for path in sorted(folder.glob("*.lcm")):
        types[path.stem] = MessageType(path, types)
    if not types:
        raise TypeFileError(f"{folder}: no .lcm files")
    return types
