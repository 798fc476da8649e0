#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""compare_with_paper.py SEQUENCE RESULTS: the error of a trajectory against the truth, beside the paper's figures.

RMS over the frames in which the retina is visible, at the image centre, in px of the half-size picture, as the paper
processed it (Braun et al., Int J Med Robot 2018, Table II, sequence "human in vivo").
"""
import csv
import json
import math
import pathlib
import statistics
import sys

PAPER_HUMAN = {"rms_px": 4.8, "rms_deg": 0.8, "cpu_ms": 15.0}


def rows(path):
    with open(path, newline="") as file:
        return [{key: value for key, value in row.items()} for row in csv.DictReader(file)]


def rms(values):
    return math.sqrt(sum(value * value for value in values) / len(values))


def score(sequence, results):
    truth = rows(pathlib.Path(sequence) / "truth.csv")
    estimate = rows(pathlib.Path(results) / "trajectory.csv")
    if len(truth) != len(estimate):
        sys.exit(f"compare_with_paper.py: {results} has {len(estimate)} frames, {sequence} {len(truth)}")
    pairs = [(t, e) for t, e in zip(truth, estimate) if float(t["visible"]) > 0]
    difference = lambda key: [float(e[key]) - float(t[key]) for t, e in pairs]
    distance = [math.hypot(x, y) / 2 for x, y in zip(difference("x_px"), difference("y_px"))]
    return {
        "frames": len(truth), "visible": len(pairs), "rms_px": rms(distance), "max_px": max(distance),
        "rms_deg": rms([(d + 180) % 360 - 180 for d in difference("theta_deg")]),
        "tracked": sum(int(e["tracked"]) for _, e in pairs) / len(pairs),
        "cpu_ms": statistics.median(float(e["cpu_ms"]) for e in estimate),
    }


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    ours = score(sys.argv[1], sys.argv[2])
    condition = json.loads((pathlib.Path(sys.argv[1]) / "meta.json").read_text())["condition"]
    print(f"{ours['frames']} frames ({condition}), {100 * ours['tracked']:.1f} % of the visible ones tracked, "
          f"largest error {ours['max_px']:.2f} px")
    print(f"{'':<26}{'here':>10}{'paper (human in vivo)':>24}")
    for key, name in (("rms_px", "RMS error, half-size px"), ("rms_deg", "RMS error, deg"), ("cpu_ms", "ms a frame")):
        print(f"{name:<26}{ours[key]:>10.3f}{PAPER_HUMAN[key]:>24}")
    print("(the paper's own video and computer of 2015; this one is rendered, with exact truth)")


if __name__ == "__main__":
    main()
