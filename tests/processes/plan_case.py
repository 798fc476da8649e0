# SPDX-License-Identifier: GPL-3.0-or-later
"""A test case that runs the real eyeslam-plan on what eyeslam-track made of a rendered video: PLAN TRACK SIM first."""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PLAN, TRACK, SIM = (sys.argv.pop(1) for _ in range(3)) if len(sys.argv) > 3 else ("eyeslam-plan", "eyeslam-track", "eyeslam-sim")
UM_PER_PX = 5.0
_tracked = {}


def must_run(*command):
    subprocess.run(command, check=True, capture_output=True, timeout=600)


def tracked(seed):
    """The folder of a tracked video, made once; not to be changed."""
    if seed not in _tracked:
        folder = tempfile.mkdtemp(prefix="eyeslam_plan_test_")
        unittest.addModuleCleanup(shutil.rmtree, folder, ignore_errors=True)
        must_run(SIM, "--out", f"{folder}/sequence", "--condition", "human", "--seed", str(seed), "--frames", "24", "--quiet")
        must_run(TRACK, f"{folder}/sequence/video.mp4", "--out", f"{folder}/out", "--no-overlay", "--snapshots", "19",
                 "--um-per-px", str(UM_PER_PX), "--quiet")
        _tracked[seed] = f"{folder}/out"
    return _tracked[seed]


class PlanCase(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="eyeslam_plan_test_")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.dir = self.path("out")
        shutil.copytree(tracked(2), self.dir)

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_plan(self, *arguments):
        return subprocess.run([PLAN, *arguments], capture_output=True, text=True, timeout=240)

    def files(self):
        return sorted(os.path.relpath(os.path.join(root, name), self.folder)
                      for root, _, names in os.walk(self.folder) for name in names)

    def plan(self, *arguments):
        """Plans, and returns the plan and the printed summary."""
        process = self.run_plan(self.dir, *arguments)
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertEqual(process.stderr, "")
        return self.read("out/plan.json"), process.stdout

    def read(self, name):
        with open(self.path(name)) as file:
            return json.load(file)

    def write(self, name, text):
        with open(self.path(name), "w") as file:
            file.write(text)
        return self.path(name)

    def edit_json(self, name, change):
        content = self.read(name)
        change(content)
        return self.write(name, json.dumps(content))

    def newest_map(self):
        return max(name for name in os.listdir(os.path.join(self.dir, "map")) if re.fullmatch(r"map_\d+\.png", name))

    def assert_refused(self, process, *named, status=(1, 2)):
        self.assertIn(process.returncode, status, process.stdout + process.stderr)
        self.assertEqual(len(process.stderr.splitlines()), 1, process.stderr)
        for name in named:
            self.assertIn(name, process.stderr)

    def assert_refused_and_nothing_written(self, arguments, *named, status=(1, 2)):
        before = self.files()
        self.assert_refused(self.run_plan(*arguments), *named, status=status)
        self.assertEqual(self.files(), before)
