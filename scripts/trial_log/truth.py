# SPDX-License-Identifier: GPL-3.0-or-later
"""The truth's frames. World and retina: m; map and frame: px of full resolution."""
import numpy as np


def turned(theta, x, y):
    return np.cos(theta) * x - np.sin(theta) * y, np.sin(theta) * x + np.cos(theta) * y


class Truth:
    """@param size  of the image, (width, height) px"""

    def __init__(self, log, size):
        self.channel = log.truth
        self.time = log.truth.time
        self.image_centre = ((size[0] - 1) / 2, (size[1] - 1) / 2) if size else None

    def m_per_px(self):
        return float(self.channel["um_per_px"][0]) * 1e-6

    def retina_of_map(self, first_pose, place_px):
        """Where a place of the tracker's map truly lies on the retina, m; none when its frame is not in the truth.
        The map's frame is the view in which it began: there the truth knows where the view was.
        @param first_pose  the map's first RETINA_POSE: utime, x_px, y_px, theta"""
        at = np.flatnonzero(self.channel["frame_utime"] == first_pose["utime"])
        if not len(at):
            return None
        x, y = place_px[0] - self.image_centre[0], place_px[1] - self.image_centre[1]
        x, y = turned(-first_pose["theta"], x - first_pose["x_px"], y - first_pose["y_px"])  # in that frame
        x, y = turned(self.channel["frame_theta"][at[0]], x, y)
        x += self.image_centre[0] + self.channel["frame_x_px"][at[0]]
        y += self.image_centre[1] + self.channel["frame_y_px"][at[0]]
        return np.array([x, y]) * self.m_per_px()

    def world_of_retina(self, time, place):
        """Where a place of the retina is at a time, us; between the milliseconds as on a straight line."""
        shift = [np.interp(time, self.time, self.channel["retina_shift"][:, i]) for i in (0, 1)]
        centre = [np.interp(time, self.time, self.channel["retina_centre"][:, i]) for i in (0, 1)]
        theta = np.interp(time, self.time, self.channel["retina_theta"])
        x, y = turned(theta, place[0] - centre[0], place[1] - centre[1])
        return np.array([centre[0] + x + shift[0], centre[1] + y + shift[1]])

    def _to_world(self, place):
        centre, theta, shift = self.channel["retina_centre"], self.channel["retina_theta"], self.channel["retina_shift"]
        x, y = turned(theta, place[:, 0] - centre[:, 0], place[:, 1] - centre[:, 1])
        return np.column_stack([centre[:, 0] + x + shift[:, 0], centre[:, 1] + y + shift[:, 1], place[:, 2] + shift[:, 2]])

    def tip_world(self):
        return self._to_world(self.channel["tip"])

    def null_world(self):
        return self._to_world(self.channel["null"])
