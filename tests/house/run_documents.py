# SPDX-License-Identifier: GPL-3.0-or-later
"""run_documents.py PROGRAM_DIR: runs the commands of README.md and docs/, in order, each document in its own shell.

my_video.mp4 stands for the reader's video: a short rendered one takes its place. ./test is not run again.
"""
import os
import subprocess
import sys

import tree
from documents_test import commands, documents

CHANCES = 3  # of what runs in real time, for this computer may have other work
SKIPPED = ("./test", "git ", "cmake ")  # this run; fetching; what ./test has done


def run(line, environment):
    return subprocess.run(["bash", "-c", line], cwd=tree.ROOT, env=environment).returncode == 0


def main():
    environment = dict(os.environ, PATH=os.path.abspath(sys.argv[1]) + ":" + os.environ["PATH"])
    sequence = "out/documents/sequence"
    failed = [] if run(f"eyeslam-sim --out {sequence} --condition human --seed 2 --frames 60", environment) else ["rendering a video"]
    for path in documents():
        for line in commands(tree.text(path)):
            if line.startswith(SKIPPED):
                continue
            print(f"{path}: {line}", flush=True)
            chances = CHANCES if "--real-time" in line else 1
            if not any(run(line.replace("my_video.mp4", f"{sequence}/video.mp4"), environment) for _ in range(chances)):
                failed.append(f"{path}: {line}")
    print("\n".join(f"failed: {line}" for line in failed))
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
