#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""tidy.py BUILD_DIR [MINUTES]: runs clang-tidy on our own sources, again only where a source or a header of ours changed.

It looks at what BUILD_DIR compiles at a time: of a unity build that is many sources, whose headers are read and judged
once. What was committed last comes first, the rest in any order; after so many minutes no other is begun, and it says how
many sources were left.
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import random
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
CACHE = ROOT / "build" / "tidy"
LEFT = object()
INCLUDE = re.compile(r'^\s*#include\s*"eyeslam/([^"]+)"', re.M)
UNITED = re.compile(r'^#include "([^"]+\.cpp)"', re.M)


def headers(path, seen):
    """Our headers that a file includes, directly or not."""
    for name in INCLUDE.findall(path.read_text()):
        header = ROOT / "src" / name
        if header.exists() and header not in seen:
            seen.add(header)
            headers(header, seen)
    return seen


def sources(entry):
    """What one call of the compiler takes: the source itself, or those that a unity source includes."""
    path = pathlib.Path(entry["file"])
    return [pathlib.Path(name) for name in UNITED.findall(path.read_text())] if "Unity" in path.parts else [path]


def is_ours(entry):
    return all(path.is_relative_to(ROOT) and path.relative_to(ROOT).parts[0] in ("src", "apps") for path in sources(entry))


def committed():
    """When each file was committed last, s since 1970, as far as git tells."""
    times, now = {}, 0
    log = subprocess.run(["git", "-C", ROOT, "log", "--format=@%ct", "--name-only", "--max-count=50"], capture_output=True, text=True)
    for line in log.stdout.splitlines():
        if line.startswith("@"):
            now = int(line[1:])
        elif line:
            times.setdefault(ROOT / line, now)
    return times


def key(entry):
    digest = hashlib.sha256(entry["command"].encode())
    for source in sources(entry):
        for part in (source, *sorted(headers(source, set(source.parent.glob("*.h"))))):
            digest.update(part.read_bytes())
    digest.update((ROOT / ".clang-tidy").read_bytes())
    return digest.hexdigest()


def check(build, entry):
    """None when it is clean, else what clang-tidy says."""
    mark = CACHE / key(entry)
    if mark.exists():
        return None
    # A unity source includes sources by its nature.
    done = subprocess.run(["clang-tidy-14", "--quiet", "--checks=-bugprone-suspicious-include", "-p", build, entry["file"]],
                          capture_output=True, text=True)
    if done.returncode:
        return done.stdout + done.stderr
    mark.touch()
    return None


def main():
    build = sys.argv[1]
    end = time.monotonic() + 60.0 * float(sys.argv[2]) if len(sys.argv) > 2 else float("inf")
    CACHE.mkdir(parents=True, exist_ok=True)
    entries = [entry for entry in json.loads((pathlib.Path(build) / "compile_commands.json").read_text()) if is_ours(entry)]
    random.shuffle(entries)  # so that several short runs look at all of them
    times = committed()
    entries.sort(key=lambda entry: max(times.get(source, 0) for source in sources(entry)), reverse=True)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        complaints = left = 0
        said = pool.map(lambda entry: check(build, entry) if time.monotonic() < end else LEFT, entries)
        for entry, words in zip(entries, said):
            if words is LEFT:
                left += len(sources(entry))
            elif words:
                complaints += 1
                print(words, flush=True)
    print(f"{sum(len(sources(entry)) for entry in entries) - left} sources, {complaints} with findings; {left} not looked at")
    sys.exit(1 if complaints or not entries else 0)


if __name__ == "__main__":
    main()
