# SPDX-License-Identifier: GPL-3.0-or-later
"""Patches to learn from: pieces of the mosaics, turned, scaled, mirrored, and made worse in the ways that mosaics are."""
import glob
import os

import cv2
import numpy as np

from mosaics import UNIT
from net import INPUT_LIMIT, INPUT_UNIT

SIDE = 256
FROM_SEQUENCES, DRAWN = 0.45, 0.12  # shares
BACKGROUND = (29, 13)               # px: the boxes of the background mean, as in mosaics.contrast


def around(middle_x, middle_y, side=SIDE):
    return np.meshgrid(np.arange(side) - middle_x, np.arange(side) - middle_y)


def without_background(green):
    background = green
    for side in BACKGROUND: background = cv2.blur(background, (side, side))
    return ((green / background - 1) * UNIT).astype(np.float32)


def disc_edge(random):
    """The edge of a bright or dark round area: an optic disc, pigment, the fovea."""
    border = 64
    x, y = around(*(random.uniform(-0.3, 1.3, 2) * SIDE + border), SIDE + 2 * border)
    turn = random.uniform(0, np.pi)
    u, v = x * np.cos(turn) + y * np.sin(turn), y * np.cos(turn) - x * np.sin(turn)
    beyond = np.hypot(u, v * random.uniform(0.75, 1.0)) - random.uniform(25, 130)
    amount = random.uniform(0.15, 0.9) if random.random() < 0.8 else -random.uniform(0.1, 0.45)
    step = 1 / (1 + np.exp(np.clip(beyond / random.uniform(1.2, 7), -30, 30)))
    return without_background((1 + amount * step).astype(np.float32))[border:-border, border:-border]


def seams(random):
    """Views that met with unlike backgrounds: straight edges and staircases."""
    result = np.zeros((SIDE, SIDE), np.float32)
    for _ in range(random.integers(1, 3)):
        x, y = around(*random.uniform(0, SIDE, 2))
        turn = random.integers(4) * np.pi / 2 + random.normal() * 0.08
        beyond, along = x * np.cos(turn) + y * np.sin(turn), y * np.cos(turn) - x * np.sin(turn)
        inside = beyond > 0
        if random.random() < 0.6: inside &= along > 0
        if random.random() < 0.5: inside &= beyond < random.uniform(4, 60)
        result += inside * random.uniform(-160, 160)
    return cv2.GaussianBlur(result, (0, 0), random.uniform(0.5, 1.5)) if random.random() < 0.5 else result


def spots(random):
    """Ghosts of blooms, burns, shadows."""
    result = np.zeros((SIDE, SIDE), np.float32)
    for _ in range(random.integers(1, 4)):
        x, y = around(*random.uniform(0, SIDE, 2))
        size = random.uniform(3, 25, 2)
        r = np.hypot(x / size[0], y / size[1])
        amount = random.uniform(100, 600) * random.choice([-1, 1])
        soft = np.exp(-0.5 * r * r)
        hard = 1 / (1 + np.exp(np.clip((r - 1) * random.uniform(4, 15), -30, 30)))
        result += amount * (soft if random.random() < 0.5 else hard)
    return result


def bands(random, factor):
    """(width in full px, from, to) of short straight pieces that make up tapering, bending, branching vessels."""
    todo = [(random.uniform(0, SIDE * factor, 2), random.uniform(0, 2 * np.pi), np.exp(random.uniform(np.log(3.5), np.log(30))), 0)
            for _ in range(random.integers(2, 7))]
    while todo:
        at, turn, width, level = todo.pop()
        bend = 0.0
        for _ in range(random.integers(10, 45)):
            bend = 0.8 * bend + random.normal() * 0.05
            turn += bend
            to = at + 28 * np.array([np.cos(turn), np.sin(turn)])
            yield width, at, to
            at, width = to, max(width * (1 - random.uniform(0, 0.012)), 3.0)
            if level < 2 and width > 5 and random.random() < 0.05:
                todo.append((at, turn + random.choice([-1, 1]) * random.uniform(0.5, 1.2), width * random.uniform(0.4, 0.8), level + 1))


def drawn(random):
    """Vessels of known width on nothing: what a width is must not depend on how photographs were labelled alone."""
    factor = 4
    dark, calibre = np.zeros((2, SIDE * factor, SIDE * factor), np.float32)
    tone = random.uniform(0.6, 1.6)
    for width, start, end in sorted(bands(random, factor), key=lambda band: band[0]):
        start, end = (tuple(int(v) for v in point) for point in (start, end))
        cv2.line(dark, start, end, float(tone * min(0.04 + 0.009 * width, 0.3)), max(1, round(factor / 2 * width)))
        cv2.line(calibre, start, end, float(width), max(1, round(factor / 2 * width)))
    green = 1 - cv2.resize(dark, (SIDE, SIDE), interpolation=cv2.INTER_AREA)
    contrast = without_background(cv2.GaussianBlur(green, (0, 0), random.uniform(0.35, 0.9)))
    return contrast, np.ones((SIDE, SIDE), np.uint8), np.ascontiguousarray(calibre[factor // 2::factor, factor // 2::factor])


class Patches:
    def __init__(self, folder, photographs, sequences, random):
        self.random = random
        self.pictures = {}
        for kind, names in (("photograph", photographs), ("sequence", sequences)):
            paths = [p for name in names for p in sorted(glob.glob(f"{folder}/{kind}_{name}_*.npz"))]
            self.pictures[kind] = [self.read(path) for path in paths if os.path.getsize(path)]

    @staticmethod
    def read(path):
        z = np.load(path)
        return z["mean"].astype(np.float32), z["known"], z["calibre"]

    def cut(self, kind):
        """A piece around a known px, turned, mirrored and scaled; None where too little is known."""
        random = self.random
        mean, known, calibre = self.pictures[kind][random.integers(len(self.pictures[kind]))]
        y, x = random.integers(0, mean.shape[0]), random.integers(0, mean.shape[1])
        if not known[y, x]: return None
        turn, scale = random.uniform(0, 2 * np.pi), np.exp(random.uniform(-0.22, 0.22))
        linear = scale * np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        if random.random() < 0.5: linear[:, 0] *= -1
        map_ = np.column_stack([linear, np.array([x, y]) - linear @ [SIDE / 2, SIDE / 2]])
        warp = lambda values, how: cv2.warpAffine(values, map_, (SIDE, SIDE), flags=how | cv2.WARP_INVERSE_MAP)
        seen = warp(known, cv2.INTER_NEAREST)
        if seen.mean() < 0.3: return None
        return warp(mean, cv2.INTER_CUBIC), seen, warp(calibre, cv2.INTER_NEAREST).astype(np.float32) / scale

    def worsen(self, contrast, known):
        random = self.random
        contrast = contrast * np.exp(random.uniform(np.log(0.4), np.log(1.15)))
        if random.random() < 0.6: contrast = cv2.GaussianBlur(contrast, (0, 0), random.uniform(0.3, 1.2))
        if random.random() < 0.7:
            noise = cv2.GaussianBlur(random.standard_normal((SIDE, SIDE)).astype(np.float32), (0, 0), random.uniform(0.3, 2.2))
            contrast = contrast + noise / noise.std() * np.exp(random.uniform(np.log(8), np.log(60)))
        if random.random() < 0.5:  # the end of what was seen
            turn = random.uniform(0, 2 * np.pi)
            x, y = around(SIDE / 2, SIDE / 2)
            ragged = (random.random() < 0.5) * (4 * np.sin(x / 16) + 2 * random.standard_normal())
            known = known & (np.cos(turn) * x + np.sin(turn) * y + ragged < random.uniform(-0.1, 0.45) * SIDE)
        for share, spoil in ((0.35, disc_edge), (0.3, seams), (0.3, spots)):
            if random.random() < share: contrast = contrast + spoil(random)
        return contrast, known

    def next(self):
        """Input contrast, known, labelled calibre in full px; SIDE x SIDE."""
        random, patch = self.random, None
        while patch is None:
            kind = "sequence" if random.random() < FROM_SEQUENCES else "photograph"
            if random.random() < DRAWN:
                kind, patch = "drawn", drawn(random)
            else:
                patch = self.cut(kind)
        contrast, known, calibre = patch
        if kind == "sequence":
            contrast = contrast * np.exp(random.uniform(np.log(0.7), np.log(1.3)))
        else:
            contrast, known = self.worsen(contrast, known)
        shown = np.clip(contrast * known / INPUT_UNIT, -INPUT_LIMIT, INPUT_LIMIT)
        return shown.astype(np.float32), known.astype(np.float32), calibre
