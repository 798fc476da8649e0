#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Trains the vessel net on mosaics made by mosaics.py.

train.py --mosaics DIR --photographs NAME,... --sequences NAME,... --minutes M --out NET.npz [--start NET.npz] [--seed N]

Name only sequences that were rendered from the photographs named, and judge on others. One core; some 2000 steps of
four patches in a quarter of an hour; the learning rate falls to nothing over the minutes given.
"""
import argparse
import time

import cv2
import numpy as np

from net import CALIBRE_UNIT, Net, load
from patches import SIDE, Patches

BATCH = 4
RATE, WARM_UP = 2e-3, 100         # of Adam; steps
CALIBRE_SHARE = 0.3               # of the calibre's error in the loss
THIN_PX = 9.0                     # calibres below it count more, above it less: the thin are few
AVERAGE = 0.998                   # of the weights over steps: the average is what is kept


def importance(calibre, known):
    vessel = (calibre > 0).astype(np.uint8)
    beside = cv2.dilate(vessel, np.ones((3, 3), np.uint8)) > vessel
    weight = np.where(vessel > 0, np.clip(THIN_PX / np.maximum(calibre, 1), 0.6, 2.0), 1.0)
    weight[beside] = 0.6  # where exactly a vessel ends, labels differ too
    return (weight * known).astype(np.float32)


def learn(net, patch, gradient):
    """Adds the gradient of one patch. @return its loss"""
    contrast, known, calibre = patch
    odds, found = net.run(contrast, known)
    weight, target = importance(calibre, known), (calibre > 0).astype(np.float32)
    each = 1 / (BATCH * SIDE * SIDE)
    probability = 1 / (1 + np.exp(-np.clip(odds, -30, 30)))
    off = np.clip(2 * (found - calibre / CALIBRE_UNIT), -1, 1) * target * known
    net.back((weight * (probability - target) * each).astype(np.float32), (CALIBRE_SHARE * each * off).astype(np.float32), gradient)
    return float((weight * (np.logaddexp(0, odds) - target * odds)).sum() * each)


class Adam:
    def __init__(self, weights):
        self.first, self.second = ({k: np.zeros_like(v) for k, v in weights.items()} for _ in range(2))
        self.average = {k: v.copy() for k, v in weights.items()}
        self.step = 0

    def descend(self, weights, gradient, rate):
        self.step += 1
        size = np.sqrt(sum(float((g * g).sum()) for g in gradient.values()))
        keep = min(AVERAGE, self.step / (self.step + 20))
        for key, weight in weights.items():
            g = gradient[key] * min(1, 1 / max(size, 1e-9))
            self.first[key] = 0.9 * self.first[key] + 0.1 * g
            self.second[key] = 0.99 * self.second[key] + 0.01 * g * g
            towards = self.first[key] / (1 - 0.9 ** self.step)
            weight -= rate * towards / (np.sqrt(self.second[key] / (1 - 0.99 ** self.step)) + 1e-6)
            self.average[key] = keep * self.average[key] + (1 - keep) * weight


def train(net, patches, minutes, out):
    adam, start, done, losses = Adam(net.weights), time.monotonic(), 0.0, []
    while done < 1:
        done = min(1, (time.monotonic() - start) / (60 * minutes))
        gradient = {k: np.zeros_like(v) for k, v in net.weights.items()}
        losses.append(sum(learn(net, patches.next(), gradient) for _ in range(BATCH)))
        fall = 0.01 + 0.99 * 0.5 * (1 + np.cos(np.pi * done))
        adam.descend(net.weights, gradient, RATE * min(1, adam.step / WARM_UP) * fall)
        if adam.step % 100 == 0 or done == 1:
            print(f"step {adam.step}, {100 * done:.0f} %, loss {np.mean(losses[-100:]):.4f}", flush=True)
            np.savez(out, **adam.average)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("mosaics", "photographs", "sequences", "out"): parser.add_argument("--" + name, required=True)
    parser.add_argument("--minutes", type=float, required=True)
    parser.add_argument("--start", help="a net to go on from")
    parser.add_argument("--seed", type=int, default=1)
    a = parser.parse_args()
    random = np.random.default_rng(a.seed)
    net = load(a.start) if a.start else Net(random)
    names = [[name for name in text.split(",") if name] for text in (a.photographs, a.sequences)]
    train(net, Patches(a.mosaics, *names, random), a.minutes, a.out)


if __name__ == "__main__":
    main()
