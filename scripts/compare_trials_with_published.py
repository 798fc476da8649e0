#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""compare_trials_with_published.py results.csv...: what the aids change in trials, beside what was published.

Trials with and without an aid that share everything else are compared; all such pairs are averaged. The published
figures are of other tasks, eyes and hands, so they tell the size to expect and no more:
  Braun et al., Int J Med Robot 2018 (EyeSLAM): burns on printed slides with Micron, Fig. 8; localization, Table II
  Yang et al., IROS 2014: automated laser with Micron on a fixed target, against unaided
"""
import csv
import sys

UNAIDED = ("none", "manual")
SAME = ("scenario", "seed", "motion", "condition", "retina", "camera_hz", "latency_ms")


def number(row, name):
    return float(row[name]) if row[name] else None


def tracing(row):
    """Errors of other tasks are of other things: heights, and distances from a point."""
    return number(row, "rms_um") if row["path_coverage"] else None


def inverse(value):
    return 1 / value if value else None


MEASURES = (  # aid, what, of a row, published
    ("filter", "tracing error, RMS", tracing, ""),
    ("scaling", "tracing error, RMS", tracing, ""),
    ("soft", "tracing error, RMS", tracing, ""),
    ("hard", "tracing error, RMS", tracing, "better than tremor filtering (p < 0.05), T-RO 2013"),
    ("automated", "placement error, mean", lambda row: number(row, "placement_mean_um"),
     "-63.6 % (IROS 2014), over -50 % (EyeSLAM, Fig. 8)"),
    ("automated", "time a burn", lambda row: inverse(number(row, "burns_per_s")), "-28.5 % (IROS 2014)"),
)


def rows_of(paths):
    for path in paths:
        with open(path, newline="") as file:
            yield from (row for row in csv.DictReader(file) if row["scenario"] != "scenario")  # tables that were joined


def pairs(rows, aid, measure):
    """The measure without and with the aid, of trials that share all else."""
    unaided = {tuple(row[key] for key in SAME): measure(row) for row in rows if row["aid"] in UNAIDED}
    for row in rows:
        without, with_aid = unaided.get(tuple(row[key] for key in SAME)), measure(row)
        if row["aid"] == aid and without is not None and with_aid is not None:
            yield without, with_aid


def table(rows):
    yield "what the aid changes", "without", "with", "here", "published"
    for aid, what, measure, published in MEASURES:
        found = list(pairs(rows, aid, measure))
        if not found:
            continue
        without, with_aid = (sum(values) / len(values) for values in zip(*found))
        unit, places = ("s", 2) if what.startswith("time") else ("um", 1)
        count = f"{len(found)} pair{'s' if len(found) > 1 else ''}"
        yield (f"{what}, {aid} ({count})", f"{without:.{places}f} {unit}", f"{with_aid:.{places}f} {unit}",
               f"{100 * (with_aid / without - 1):+.1f} %", published)
    poses = [number(row, "pose_rms_px") for row in rows if row["pose_rms_px"]]
    if poses:
        yield "localization, RMS, half-size px", "", f"{sum(poses) / len(poses):.3f}", "", "4.8 in vivo (EyeSLAM, Table II)"


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    try:
        lines = list(table(list(rows_of(sys.argv[1:]))))
    except (OSError, KeyError, ValueError, TypeError) as error:
        sys.exit(f"compare_trials_with_published.py: {error!r}: results.csv of eyeslam-trial is wanted")
    widths = [max(len(line[i]) for line in lines) for i in range(len(lines[0]))]
    for line in lines:
        print(f"{line[0]:<{widths[0]}}  {line[1]:>{widths[1]}}  {line[2]:>{widths[2]}}  {line[3]:>{widths[3]}}  {line[4]}".rstrip())
    print("(simulated eye, hand and manipulator, with exact truth; published figures are of other tasks and eyes)")


if __name__ == "__main__":
    main()
