# SPDX-License-Identifier: GPL-3.0-or-later
"""The published vessel map, put together from its tiles as they came, and what lies around a burn in it."""
import math

import numpy as np

VESSEL = 128  # probability from which a cell is a vessel
LARGEST = 100_000_000  # cells; a larger map is no map
TAG = 16  # bytes after the cells


class VesselMap:
    """Of one map id. To be asked with rising ranks."""

    def __init__(self, log, map_id):
        self.log, self.tiles = log, log.vessel_map
        self.mine = np.flatnonzero(self.tiles["map_id"] == map_id)
        self.next, self.grid = 0, None
        if not len(self.mine):
            return
        size = self.tiles["px_per_cell"][self.mine]
        self.px_per_cell = float(size[0])
        self.origin = [float(self.tiles[name][self.mine].min()) for name in ("origin_x_px", "origin_y_px")]
        self.at = [np.rint((self.tiles[f"origin_{axis}_px"] - origin) / self.px_per_cell).astype(np.int64) + self.tiles[name]
                   for axis, origin, name in zip("xy", self.origin, ("column", "row"))]
        shape = [int((at + self.tiles[name])[self.mine].max()) for at, name in zip(self.at, ("width", "height"))]
        possible = all(0 < cells < LARGEST for cells in shape) and shape[0] * shape[1] < LARGEST
        if possible and (size == size[0]).all() and min(at[self.mine].min() for at in self.at) >= 0:
            self.grid = np.zeros((shape[1], shape[0]), np.uint8)

    def _take(self, rank):
        while self.next < len(self.mine) and self.tiles.rank[self.mine[self.next]] < rank:
            i = self.mine[self.next]
            self.next += 1
            width, height, cells = (int(self.tiles[name][i]) for name in ("width", "height", "cells"))
            first, length = self.tiles.bytes[i]
            begin = first + length - TAG - 3 * cells
            if cells == width * height > 0:
                x, y = int(self.at[0][i]), int(self.at[1][i])
                probability = np.frombuffer(self.log.events.bytes, np.uint8, cells, begin).reshape(height, width)
                self.grid[y:y + height, x:x + width] = probability

    def clearance_um(self, rank, place_px, burn_um, um_per_px, within_um):
        """From the burn's edge to the nearest vessel's, in the map as it was known then; `within_um` where it is not
        nearer, not a number where there is no map."""
        numbers = (*place_px, burn_um, um_per_px, within_um)
        if self.grid is None or not all(map(math.isfinite, numbers)) or not um_per_px > 0 or not 0 <= burn_um + within_um < 1e5:
            return math.nan
        self._take(rank)
        if self.next == 0:
            return math.nan
        reach = (burn_um / 2 + within_um) / um_per_px / self.px_per_cell + 1
        x, y = ((place_px[i] - self.origin[i]) / self.px_per_cell for i in (0, 1))
        left, top = max(0, math.floor(x - reach)), max(0, math.floor(y - reach))
        rows, columns = np.nonzero(self.grid[top:max(0, math.ceil(y + reach) + 1), left:max(0, math.ceil(x + reach) + 1)] >= VESSEL)
        away = np.hypot(np.maximum(np.abs(columns + left - x) - 0.5, 0), np.maximum(np.abs(rows + top - y) - 0.5, 0))
        nearest = away.min() * self.px_per_cell * um_per_px if len(away) else math.inf
        return min(within_um, nearest - burn_um / 2)


def check(log, plans, found, findings, limits):
    """A vessel that has just come into the map may be unknown to the servo for a moment. @return the pulses too near"""
    maps, near = {}, []
    for pulse in (pulse for pulse in found if pulse.plan is not None and pulse.target in plans.targets[pulse.plan]):
        plan, target = plans.messages[pulse.plan], plans.targets[pulse.plan][pulse.target]
        one = maps.setdefault(int(plan["map_id"]), VesselMap(log, plan["map_id"]))
        decided = log.laser_command.time[pulse.command]
        ranks = log.known_at(int(decided - limits.map_age * 1e6)), log.laser_command.rank[pulse.command]
        clearances = [one.clearance_um(rank, (target["x_px"], target["y_px"]), target["burn_um"], plan["um_per_px"], plan["margin_um"])
                      for rank in ranks]
        largest = max((clearance for clearance in clearances if not math.isnan(clearance)), default=math.nan)
        if not largest >= plan["margin_um"] - limits.clearance:
            findings.add("map_margin", log.seconds(pulse.begin), f"pulse {pulse.number} is {largest:.1f} um from a vessel")
            near.append(pulse)
    return near
