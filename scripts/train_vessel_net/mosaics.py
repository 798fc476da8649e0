#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures to learn from, as the tracker's mosaic has them: contrast, what is known, labelled calibre.

mosaics.py --photographs DIR --sequences DIR --out DIR

From each photograph at five zooms (photograph_NAME_ZZZ.npz), and from each sequence with its true poses after 8 to 149
frames (sequence_NAME_FFF.npz). Contrast is the tracker's: (green / background - 1) x 4096, tracker study 2.4.
"""
import argparse
import csv
import glob
import json
import os

import cv2
import numpy as np
from scipy.ndimage import distance_transform_edt
from skimage.morphology import skeletonize

UNIT = 4096
CELL = 4
ZOOMS = (0.55, 0.7, 0.85, 1.0, 1.2)
SNAPSHOTS = (8, 15, 29, 59, 149)
OUTLIER = 0.05 * UNIT


def masked_mean(values, visible, sides):
    for side in sides:
        values = cv2.blur(values, (side, side), borderType=cv2.BORDER_CONSTANT)
        visible = cv2.blur(visible, (side, side), borderType=cv2.BORDER_CONSTANT)
    return np.where(visible > 1e-4, values / np.maximum(visible, 1e-6), 1.0)


def contrast(image):
    """Contrast of the halved green and the visible px, or None in a blackout (src/tracking/frame, occlusion_mask)."""
    height, width = image.shape[0] // 2, image.shape[1] // 2
    image = image[:2 * height, :2 * width]
    green = cv2.resize(image[..., 1].astype(np.float32), (width, height), interpolation=cv2.INTER_AREA) * 4
    rows, columns = -(-height // CELL), -(-width // CELL)
    padded = cv2.copyMakeBorder(image, 0, rows * 2 * CELL - 2 * height, 0, columns * 2 * CELL - 2 * width, cv2.BORDER_REPLICATE)
    blue, cell_green, red = cv2.split(cv2.resize(padded, (columns, rows), interpolation=cv2.INTER_AREA).astype(np.float32))
    lit = red > 25
    level = np.median(red[lit]) if lit.any() else 0
    if level < 30: return None
    grown = lambda cells: cv2.dilate(cells.astype(np.uint8), np.ones((5, 5), np.uint8))
    visible = (grown(red < 0.35 * level) | grown(blue > 0.45 * red)) == 0
    if visible.mean() < 0.1: return None
    shown = visible.astype(np.float32)
    inverse = (1 / np.maximum(masked_mean(4 * cell_green * shown, shown, (7, 3)), 1)).astype(np.float32)
    at = np.meshgrid(((np.arange(width) - 1.5) / CELL).astype(np.float32), ((np.arange(height) - 1.5) / CELL).astype(np.float32))
    inverse = cv2.remap(inverse, *at, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    n = np.minimum(green * inverse * UNIT - UNIT, 8000)
    kernel = np.array([0.25, 0.5, 0.25])
    per_px = np.repeat(np.repeat(visible, CELL, 0), CELL, 1)[:height, :width]
    return cv2.sepFilter2D(n, -1, kernel, kernel), per_px.astype(np.uint8)


def save(path, mean, known, calibre):
    np.savez_compressed(path, mean=np.round(mean).astype(np.int16), known=known.astype(np.uint8), calibre=calibre.astype(np.uint8))


def from_photograph(path, out):
    name = os.path.basename(path)[:-4]
    image = cv2.imread(path)
    labelled = cv2.imread(path[:-4] + "_vessels.png", cv2.IMREAD_GRAYSCALE) > 0
    # As in vessels.png of the sequences: twice the distance to the edge at the nearest point of the skeleton.
    depth = distance_transform_edt(labelled)
    _, (rows, columns) = distance_transform_edt(~skeletonize(labelled), return_indices=True)
    calibre = np.where(labelled, 2 * depth[rows, columns], 0).astype(np.float32)
    for zoom in ZOOMS:
        how = cv2.INTER_AREA if zoom < 1 else cv2.INTER_LINEAR
        mean, known = contrast(cv2.resize(image, None, fx=zoom, fy=zoom, interpolation=how))
        middle = lambda size: ((2 * np.arange(size) + 1) / zoom - 0.5).astype(np.float32)
        at = np.meshgrid(middle(mean.shape[1]), middle(mean.shape[0]))
        local = np.ceil(zoom * cv2.remap(calibre, *at, cv2.INTER_NEAREST))
        save(f"{out}/photograph_{name}_{int(zoom * 100):03d}.npz", mean, known, np.minimum(local, 255))


class RunningMosaic:
    """The tracker's mosaic (tracker study 2.13) on a fixed canvas, with the true poses."""

    def __init__(self, origin, shape):
        self.x, self.y = np.meshgrid(np.arange(shape[1]) + origin[0], np.arange(shape[0]) + origin[1])
        self.mean, self.count = np.zeros(shape, np.float32), np.zeros(shape, np.float32)

    def blend(self, n, visible, pose, frame):
        height, width = n.shape
        x, y, theta, scale = pose
        u, v = self.x - (width - 1) / 2 - x, self.y - (height - 1) / 2 - y
        c, s = np.cos(theta) / scale, np.sin(theta) / scale
        px = (c * u + s * v + (width - 1) / 2).astype(np.float32)
        py = (-s * u + c * v + (height - 1) / 2).astype(np.float32)
        value = cv2.remap(n, px, py, cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
        shown = cv2.remap(visible, px, py, cv2.INTER_NEAREST, borderMode=cv2.BORDER_CONSTANT) > 0
        shown &= (px > 2) & (py > 2) & (px < width - 3) & (py < height - 3)
        period = 8 if frame < 60 else 16
        turn = shown & ((self.y % period == frame % period) | (self.count == 0))
        off = turn & (self.count >= 3) & (np.abs(value - self.mean) > OUTLIER)
        self.count[off] -= 1
        add = turn & ~off
        self.count[add] = np.minimum(self.count[add] + 1, 64)
        self.mean[add] += (value[add] - self.mean[add]) / self.count[add]


def from_sequence(folder, out):
    meta = json.load(open(folder + "/meta.json"))
    with open(folder + "/truth.csv", newline="") as f:
        truth = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(f)]
    calibre = cv2.imread(folder + "/vessels.png", cv2.IMREAD_GRAYSCALE)
    left, top = meta["vessels_origin"]
    origin = (int(np.floor(left / 2)) - 1, int(np.floor(top / 2)) - 1)
    mosaic = RunningMosaic(origin, (calibre.shape[0] // 2 + 3, calibre.shape[1] // 2 + 3))
    at = ((2 * mosaic.x + 0.5 - left).astype(np.float32), (2 * mosaic.y + 0.5 - top).astype(np.float32))
    video = cv2.VideoCapture(folder + "/video.mp4")
    for frame in range(SNAPSHOTS[-1] + 1):
        _, image = video.read()
        row = truth[frame]
        made = contrast(image) if row["visible"] > 0 else None
        if made:
            mosaic.blend(*made, (row["x_px"] / 2, row["y_px"] / 2, np.radians(row["theta_deg"]), row["scale"]), frame)
        if frame in SNAPSHOTS:
            path = f"{out}/sequence_{os.path.basename(folder)}_{frame:03d}.npz"
            save(path, mosaic.mean, mosaic.count > 0, cv2.remap(calibre, *at, cv2.INTER_NEAREST))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("photographs", "sequences", "out"): parser.add_argument("--" + name, required=True)
    a = parser.parse_args()
    os.makedirs(a.out, exist_ok=True)
    for path in sorted(glob.glob(a.photographs + "/*.jpg")): from_photograph(path, a.out)
    for path in sorted(glob.glob(a.sequences + "/*/video.mp4")): from_sequence(os.path.dirname(path), a.out)


if __name__ == "__main__":
    main()
