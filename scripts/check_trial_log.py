#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_trial_log.py LOG...: proves from the messages and the TRUTH in trial logs that no pulse was unsafe.

Shares no code with the servo, the simulator or LCM: it reads logs and message types (lcmtypes/*.lcm) by itself, so that
an error there is not repeated here. Knowledge is judged by the order in which messages were sent: in a lock-step log
(each message logged the moment it was sent) exactly, else a message may have been a millisecond on its way. A servo may
react within a cycle and a millisecond of transit (--reaction-ms); what lasts longer is a violation.

Prints a line a log: pulses, placement error by the truth (mean, p95, largest), far pulses (more than 60 um off), how
many of these are explained, pulses with any interlock open, violations; under it each rule that was violated, how often,
and where first. Pulses of a trial with `aid: manual` are a hand's: of them the laser's own interlocks are judged, and far
ones need no explanation. Exit status: 0 all rules hold, 1 violations or a log that cannot be read, 2 a wrong call.

The rules:
"""
import argparse
import json
import pathlib
import sys

import numpy as np

from trial_log import interlocks, motion, order, pulses, vessel_map
from trial_log.findings import RULES, Findings, Limits
from trial_log.message_types import TypeFileError
from trial_log.plans import Plans
from trial_log.trial_log import TrialLog
from trial_log.truth import Truth

TYPES = pathlib.Path(__file__).resolve().parents[1] / "lcmtypes"
COLUMNS = ("log", "s", "pulses", "mean um", "p95 um", "max um", "far", "explained", "interlocks", "violations")


class Unreadable(Exception):
    """A log that proves nothing, and why."""


def size_of(text):
    width, _, height = text.partition("x")
    if not (width.isdigit() and height.isdigit()):
        raise argparse.ArgumentTypeError(f"'{text}' is no size, such as 800x608")
    return int(width), int(height)


def arguments():
    rules = "".join(f"  {name:17} {text}\n" for name, text in RULES.items())
    parser = argparse.ArgumentParser(prog="check_trial_log.py", description=__doc__ + rules,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("logs", nargs="+", metavar="LOG")
    parser.add_argument("--json", metavar="FILE", help="write everything that was found there")
    parser.add_argument("--size", type=size_of, metavar="WxH", help="of the image, px; default: hardware.camera in the log's MARK")
    parser.add_argument("--oldest-pose-ms", type=float, help="default: interlocks.latency_ms + frame_ms in the log's MARK, 60 at most")
    parser.add_argument("--reaction-ms", type=float, default=2.0, help="default 2")
    parser.add_argument("--types", type=pathlib.Path, default=TYPES, help="folder of the .lcm files")
    return parser.parse_args()


def limits_of(log, options):
    limits = Limits(reaction=options.reaction_ms * 1e-3, transit=0.0 if log.in_step else 1e-3)
    latency, frame = log.setting("interlocks.latency_ms"), log.setting("interlocks.frame_ms")
    if options.oldest_pose_ms is not None:
        limits.oldest_pose = min(limits.oldest_pose, options.oldest_pose_ms * 1e-3)
    elif latency is not None and frame is not None:
        limits.oldest_pose = min(limits.oldest_pose, (latency + frame) * 1e-3)
    return limits


def open_log(path, options):
    try:
        log = TrialLog(path, options.types)
    except OSError as error:
        raise Unreadable(error.strerror or str(error)) from None
    except ValueError as error:
        raise Unreadable(f"is no trial's log ({error})") from None
    if not log.events.count:
        raise Unreadable("no event of an LCM log is in it")
    size = options.size
    if size is None and log.setting("hardware.camera.width") and log.setting("hardware.camera.height"):
        size = (log.setting("hardware.camera.width"), log.setting("hardware.camera.height"))
    if size is None and (log.truth["emitting"] != 0).any():
        raise Unreadable("its MARK tells no size of the image; give --size WxH")
    return log, size


def check(path, options):
    """Everything about one log, as it goes into the JSON."""
    log, size = open_log(path, options)
    limits, findings, truth = limits_of(log, options), Findings(), Truth(log, size)
    by_hand = log.settings.get("aid") in ("manual", "none")
    order.check(log, findings)
    plans = Plans(log, findings, by_hand)
    found = pulses.find(log, plans, truth, findings, limits)
    if by_hand:
        findings.rules.pop("far_explained", None)
    near = [] if by_hand else vessel_map.check(log, plans, found, findings, limits)
    open_pulses = interlocks.check(log, plans, found, findings, limits, near)
    motion.check(log, found, truth, findings, limits)
    far = [pulse for pulse in found if pulse.is_far(limits)]
    explained = sum(pulse.is_explained(limits) for pulse in far)
    return {"log": str(path), "lock_step": bool(log.in_step), "by_hand": by_hand, "events": log.events.count,
            "seconds": log.seconds(log.times[-1]) if len(log.times) else 0.0, "damage": log.events.damage(),
            "pulses": [record(log, pulse, limits) for pulse in found], "far": len(far), "far_explained": explained,
            "far_unexplained": len(far) - explained, "interlock_violations": open_pulses,
            "violations": findings.in_order(), "violation_count": findings.count()}


def record(log, pulse, limits):
    um = lambda metres: None if metres is None else round(metres * 1e6, 3)
    return {"number": pulse.number, "target": pulse.target, "begin_s": round(log.seconds(pulse.begin), 6),
            "duration_s": round((pulse.end - pulse.begin) * 1e-6, 6), "placement_um": um(pulse.placement),
            "retina_moved_um": um(pulse.moved), "far": pulse.is_far(limits), "explained": pulse.is_explained(limits)}


def row(result):
    placed = [pulse["placement_um"] for pulse in result["pulses"] if pulse["placement_um"] is not None]
    figures = [f"{value:.1f}" for value in (np.mean(placed), np.percentile(placed, 95), np.max(placed))] if placed else ["-"] * 3
    return [result["log"], f"{result['seconds']:.1f}", str(len(result["pulses"])), *figures, str(result["far"]),
            str(result["far_explained"]), str(result["interlock_violations"]), str(result["violation_count"])]


def print_table(results):
    rows = [COLUMNS, *(row(result) for result in results)]
    widths = [max(len(line[i]) for line in rows) for i in range(len(COLUMNS))]
    for line, result in zip(rows, [None, *results]):
        print(line[0].ljust(widths[0]) + "".join("  " + text.rjust(width) for text, width in zip(line[1:], widths[1:])))
        for found in result["violations"] if result else []:
            print(f"  {found['rule']}: {found['count']}, first at {found['first_s']:.3f} s: {found['first']}")


def main():
    options = arguments()
    results, unreadable = [], []
    for path in options.logs:
        try:
            results.append(check(path, options))
            if results[-1]["damage"]:
                print(f"check_trial_log.py: {path}: {results[-1]['damage']}", file=sys.stderr)
        except Unreadable as error:
            unreadable.append({"log": path, "error": str(error)})
            print(f"check_trial_log.py: {path}: {error}", file=sys.stderr)
        except TypeFileError as error:
            print(f"check_trial_log.py: {error}", file=sys.stderr)
            return 2
    if results:
        print_table(results)
    summary = {"logs": len(options.logs), "unreadable": len(unreadable), "pulses": sum(len(r["pulses"]) for r in results)}
    for name in ("far", "far_explained", "far_unexplained", "interlock_violations", "violation_count"):
        summary[name] = sum(result[name] for result in results)
    print("{logs} logs ({unreadable} unreadable), {pulses} pulses, {far} far ({far_explained} explained), "
          "{interlock_violations} with an interlock open, {violation_count} violations".format(**summary))
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps({"summary": summary, "logs": results, "unreadable": unreadable}, indent=1) + "\n")
    return 1 if unreadable or summary["violation_count"] else 0


if __name__ == "__main__":
    sys.exit(main())
