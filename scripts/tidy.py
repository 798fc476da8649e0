#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""tidy.py BUILD_DIR [MINUTES]: runs clang-tidy on our own sources, again only where a source or a header of ours changed.

Those that were written last come first; after so many minutes no other one is begun, and it says how many were left.
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
CACHE = ROOT / "build" / "tidy"
LEFT = object()
INCLUDE = re.compile(r'^\s*#include\s*"eyeslam/([^"]+)"', re.M)


def headers(path, seen):
    """Our headers that a file includes, directly or not."""
    for name in INCLUDE.findall(path.read_text()):
        header = ROOT / "src" / name
        if header.exists() and header not in seen:
            seen.add(header)
            headers(header, seen)
    return seen


def key(entry):
    path = pathlib.Path(entry["file"])
    digest = hashlib.sha256(entry["command"].encode())
    beside = sorted(path.parent.glob("*.h"))
    for part in (ROOT / ".clang-tidy", path, *sorted(headers(path, set(beside)))):
        digest.update(part.read_bytes())
    return digest.hexdigest()


def check(build, entry):
    """None when the file is clean, else what clang-tidy says."""
    mark = CACHE / key(entry)
    if mark.exists():
        return None
    done = subprocess.run(["clang-tidy-14", "--quiet", "-p", build, entry["file"]], capture_output=True, text=True)
    if done.returncode:
        return done.stdout + done.stderr
    mark.touch()
    return None


def main():
    build = sys.argv[1]
    end = time.monotonic() + 60.0 * float(sys.argv[2]) if len(sys.argv) > 2 else float("inf")
    CACHE.mkdir(parents=True, exist_ok=True)
    entries = [entry for entry in json.loads((pathlib.Path(build) / "compile_commands.json").read_text())
               if pathlib.Path(entry["file"]).relative_to(ROOT).parts[0] in ("src", "apps")]
    entries.sort(key=lambda entry: os.path.getmtime(entry["file"]), reverse=True)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        complaints = left = 0
        for said in pool.map(lambda entry: check(build, entry) if time.monotonic() < end else LEFT, entries):
            if said is LEFT:
                left += 1
            elif said:
                complaints += 1
                print(said, flush=True)
    print(f"{len(entries) - left} sources, {complaints} with findings; {left} not looked at")
    sys.exit(1 if complaints or not entries else 0)


if __name__ == "__main__":
    main()
