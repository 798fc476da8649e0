# SPDX-License-Identifier: GPL-3.0-or-later
"""A test case that runs the real eyeslam-track, named by the first argument of the program."""
import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 else "eyeslam-track"


class TrackCase(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="eyeslam_track_test_")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.out = self.path("results/out")
        os.mkdir(self.path("results"))

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_track(self, *arguments, out=None, **options):
        command = [PROGRAM, *arguments, "--out", out or self.out]
        return subprocess.run(command, capture_output=True, text=True, timeout=240, **options)

    def assert_done(self, process):
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertEqual(os.listdir(self.path("results")), ["out"], "something was left beside the results")

    def assert_refused(self, process, status, *named):
        self.assertEqual(process.returncode, status, process.stderr)
        # A slow machine, or a sanitizer, lets some seconds pass: then lines of progress come before the error.
        lines = [line for line in process.stderr.splitlines() if not re.search(r"\[#*\.*\] +\d+ %", line)]
        self.assertEqual(len(lines), 1, process.stderr)
        for name in named:
            self.assertIn(name, lines[0])
        self.assertEqual(os.listdir(self.path("results")), [], "something was written")

    def rows(self, out=None):
        with open(os.path.join(out or self.out, "trajectory.csv"), newline="") as file:
            return list(csv.DictReader(file))

    def record(self):
        with open(os.path.join(self.out, "run.json")) as file:
            return json.load(file)
