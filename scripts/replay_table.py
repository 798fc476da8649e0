#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Joins what `eyeslam-replay LOG --json FILE` wrote for many logs into one CSV table, a row a log and channel.

  scripts/replay_table.py out/replays/*.json > table.csv

Status 0: all logs were computed again, the same to the byte; 1: some were not.
"""
import csv
import json
import sys

COLUMNS = ["log", "channel", "compared", "identical", "missing", "extra", "first_difference_utime", "max_difference",
           "video_offset_s", "video_offset_certain", "warnings", "error"]


def rows(path):
    with open(path) as file:
        replay = json.load(file)
    log = path.removesuffix(".json")
    video = replay.get("video") or {}
    error = replay.get("error") or ("interrupted" if replay.get("interrupted") else "")
    if not error and not replay["channels"]:
        error = "nothing was compared"
    if error:
        yield {"log": log, "error": error}
    for channel in replay.get("channels", []):
        yield {"log": log, "channel": channel["name"],
               **{name: channel[name] for name in COLUMNS[2:8]},
               "video_offset_s": video.get("offset_s"), "video_offset_certain": video.get("offset_certain"),
               "warnings": len(video.get("warnings", []))}


def is_same(row):
    return "error" not in row and row["compared"] == row["identical"] and row["missing"] == 0 and row["extra"] == 0


def main(paths):
    if not paths or paths[0].startswith("-"):
        print(__doc__.strip())
        return 2
    table = csv.DictWriter(sys.stdout, COLUMNS, lineterminator="\n")
    table.writeheader()
    same = True
    for path in paths:
        try:
            for row in rows(path):
                table.writerow(row)
                same = same and is_same(row)
        except (OSError, ValueError) as error:
            print(f"replay_table.py: {path}: {error}", file=sys.stderr)
            same = False
        except (KeyError, AttributeError, TypeError):
            print(f"replay_table.py: {path}: is not what eyeslam-replay LOG --json writes", file=sys.stderr)
            same = False
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
