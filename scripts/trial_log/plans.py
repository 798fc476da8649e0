# SPDX-License-Identifier: GPL-3.0-or-later
"""Burn plans by their hash, and what the one in force says of a target."""
import hashlib
import struct

PROPOSED, IN_FORCE = 0, 1
PENDING, DONE, MISSED, REFUSED = 0, 1, 2, 3
HASHED = struct.Struct("<iidddddd")


def hash_of(plan):
    """SHA-256 by the rule of the operator's approval: what decides on what is burnt, little-endian. The state counts
    only as REFUSED or not."""
    sha = hashlib.sha256(struct.pack("<dddq", plan["um_per_px"], plan["margin_um"], plan["localization_um"], plan["map_id"]))
    sha.update(bytes(plan["map_hash"]))
    sha.update(struct.pack("<I", len(plan["target"])))
    for target in plan["target"]:
        sha.update(_bytes_of(target) + bytes([int(target["state"] == REFUSED)]))
    return sha.digest()


def _bytes_of(target):
    return HASHED.pack(*(target[name] for name in ("id", "tile", "x_px", "y_px", "spot_um", "burn_um", "duration", "power")))


def _same(proposed, in_force):
    """What was proposed; only that targets have been refused since may be new."""
    head = all(proposed[name] == in_force[name] for name in ("um_per_px", "margin_um", "localization_um", "map_id"))
    if not head or bytes(proposed["map_hash"]) != bytes(in_force["map_hash"]) or len(proposed["target"]) != len(in_force["target"]):
        return False
    return all(_bytes_of(a) == _bytes_of(b) and (a["state"] != REFUSED or b["state"] == REFUSED)
               for a, b in zip(proposed["target"], in_force["target"]))


class Plans:
    """All plans of a log. A hand's has no proposal: what it burns by is in force, and that is all."""

    def __init__(self, log, findings, by_hand):
        self.log, self.channel, self.by_hand = log, log.burn_plan, by_hand
        self.messages = [{name: values[i] for name, values in self.channel.data.items()} for i in range(len(self.channel))]
        self.targets = [{int(target["id"]): target for target in plan["target"]} for plan in self.messages]
        self.proposed = {}  # hash: (index, rank) of its first proposal that bears it
        self.in_force = []  # (rank, index), rising
        for i, plan in enumerate(self.messages):
            self._take(i, plan, findings)

    def _take(self, i, plan, findings):
        hash_ = bytes(plan["hash"])
        if plan["state"] == PROPOSED or self.by_hand:
            good = hash_of(plan) == hash_
            self.proposed.setdefault(hash_, i) if good else None
        else:
            good = hash_ in self.proposed and _same(self.messages[self.proposed[hash_]], plan)
            self.in_force.append((int(self.channel.rank[i]), i))
        if not good:
            word = "proposed" if plan["state"] == PROPOSED else "in force"
            findings.add("plan_hash", self.log.seconds(self.channel.time[i]), f"the plan {word} is not what {hash_.hex()[:12]} says")

    def approved(self, rank):
        """Index of the plan that a pulse is burnt by: the one that the operator approves, or the hand's own."""
        if self.by_hand:
            return int(self.channel.last_before(rank)) if self.channel.last_before(rank) >= 0 else None
        said = int(self.log.operator.last_before(rank))
        if said < 0 or not self.log.operator["plan_approved"][said]:
            return None
        return self.proposal(bytes(self.log.operator["plan_hash"][said]), rank)

    def proposal(self, hash_, rank):
        """Index of the proposal with this hash that was known then; none where there is none."""
        index = self.proposed.get(hash_)
        return index if index is not None and self.channel.rank[index] < rank else None

    def newest_in_force(self, rank):
        """Index of the newest one in force that was known then; none before the first."""
        known = [index for at, index in self.in_force if at < rank]
        return known[-1] if known else None

    def word(self, rank, target):
        """What the newest plan in force says of a target, or none."""
        index = self.newest_in_force(rank)
        return None if index is None else self.targets[index].get(target)
