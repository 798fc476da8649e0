#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Coverage and false positives of a net on mosaics of sequences, by the judge's formulas, for several thresholds.

evaluate.py NET.npz --mosaics DIR --sequences DIR --names NAME,... [--frame F]

Only for sequences whose photograph the net was not trained on. The last line is the coverage by calibre at the default
threshold.
"""
import argparse
import csv
import json

import cv2
import numpy as np
from scipy.ndimage import distance_transform_edt
from skimage.morphology import skeletonize

import net as nets

TOLERANCE_PX, SEEN_FRAMES = 4.0, 9
THRESHOLDS = (-2.0, -1.5, -1.0, -0.7, -0.5, -0.25, 0.0)
DEFAULT = -0.7
CALIBRES = (1, 4, 6, 8, 10, 14, 20, 99)
APRON, GRID = 32, 128


def in_view(truth, meta, shape, last):
    """px of vessels.png that were in view in SEEN_FRAMES frames at least, as score.py counts them."""
    width, height = meta["size"]
    view = np.zeros((height, width), np.uint8)
    if meta.get("rim"):
        rim = meta["rim"]
        cv2.circle(view, (round(rim["cx"]), round(rim["cy"])), round(rim["r"] - 12 * width / 800), 1, -1)
    else:
        view[8:-8, 8:-8] = 1
    count = np.zeros(shape, np.uint16)
    centre = np.array([(width - 1) / 2, (height - 1) / 2])
    for row in truth[:last + 1:3]:
        if row["visible"] <= 0: continue
        a = np.radians(row["theta_deg"])
        turn = row["scale"] * np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
        shift = centre + [row["x_px"], row["y_px"]] - turn @ centre - meta["vessels_origin"]
        count += cv2.warpAffine(view, np.column_stack([turn, shift]), shape[::-1], flags=cv2.INTER_NEAREST)
    return 3 * count >= SEEN_FRAMES


class Sequence:
    def __init__(self, folder, mosaic, frame):
        meta = json.load(open(folder + "/meta.json"))
        with open(folder + "/truth.csv", newline="") as f:
            truth = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(f)]
        self.calibre = cv2.imread(folder + "/vessels.png", cv2.IMREAD_GRAYSCALE)
        self.duty = in_view(truth, meta, self.calibre.shape, frame)
        self.must = skeletonize(self.calibre > 0) & self.duty
        self.away = distance_transform_edt(self.calibre == 0) > TOLERANCE_PX
        z = np.load(mosaic)
        self.mean, self.known = z["mean"].astype(np.float32), z["known"].astype(np.float32)
        left, top = meta["vessels_origin"]
        # The centre of mosaic px (0, 0), seen from vessels.png.
        self.offset = 2 * np.array([np.floor(left / 2) - 1, np.floor(top / 2) - 1]) + 0.5 - [left, top]

    def odds(self, net):
        pad = [(APRON, APRON + -(size + 2 * APRON) % GRID) for size in self.mean.shape]
        contrast = np.clip(self.mean * self.known / nets.INPUT_UNIT, -nets.INPUT_LIMIT, nets.INPUT_LIMIT)
        odds, _ = net.run(np.pad(contrast, pad).astype(np.float32), np.pad(self.known, pad))
        odds = odds[APRON:APRON + self.mean.shape[0], APRON:APRON + self.mean.shape[1]]
        return np.where(self.known > 0, odds, -99)

    def score(self, claimed):
        """Found skeleton px, coverage (all, from 6, from 10 px) and share of false cells."""
        to = np.column_stack([2 * np.eye(2), self.offset])
        big = cv2.warpAffine(claimed.astype(np.uint8), to, self.calibre.shape[::-1], flags=cv2.INTER_NEAREST) > 0
        found = self.must & (distance_transform_edt(~big) <= TOLERANCE_PX)
        shares = [found[self.calibre >= least].sum() / max(1, self.must[self.calibre >= least].sum()) for least in (0, 6, 10)]
        judged = big & self.duty
        return found, (*shares, self.away[judged].mean() if judged.any() else 0.0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("net")
    for name in ("mosaics", "sequences", "names"): parser.add_argument("--" + name, required=True)
    parser.add_argument("--frame", type=int, default=149)
    a = parser.parse_args()
    net = nets.load(a.net)
    sequences = [Sequence(f"{a.sequences}/{n}", f"{a.mosaics}/sequence_{n}_{a.frame:03d}.npz", a.frame) for n in a.names.split(",")]
    odds = [s.odds(net) for s in sequences]
    for threshold in THRESHOLDS:
        rows = 100 * np.array([s.score(o >= threshold)[1] for s, o in zip(sequences, odds)])
        each = " ".join(f"{r[0]:.0f}/{r[1]:.0f}/{r[3]:.0f}" for r in rows)
        print("threshold {:5.2f}: coverage {:.1f} %, from 6 px {:.1f} %, from 10 px {:.1f} %, false {:.1f} % | ".format(
            threshold, *rows.mean(0)) + each)
    found = [s.score(o >= DEFAULT)[0] for s, o in zip(sequences, odds)]
    for low, high in zip(CALIBRES, CALIBRES[1:]):
        of = [s.must & (s.calibre >= low) & (s.calibre < high) for s in sequences]
        total = sum(k.sum() for k in of)
        print(f"{low}-{high - 1} px: {100 * sum((f & k).sum() for f, k in zip(found, of)) / max(1, total):.0f} % of {total} px")


if __name__ == "__main__":
    main()
