# SPDX-License-Identifier: GPL-3.0-or-later
"""A test case that runs the real eyeslam-trial: the folder of the programs comes first."""
import csv
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAMS = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release/apps")
ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIOS = ROOT / "scenarios"
TRACING = str(SCENARIOS / "vessel_tracing.yaml")
# A quarter of the picture takes a quarter of the time.
SMALL = {"hardware.camera.width": 400, "hardware.camera.height": 304, "servo.image_width_px": 400,
         "servo.image_height_px": 304, "vision.tracker.frame.scale": 1, "settling_s": 1}


def settings(**values):
    """--set for each; groups are joined by two underscores."""
    return [word for key, value in values.items() for word in ("--set", f"{key.replace('__', '.')}={value}")]


def small(**values):
    return settings(**SMALL, **values)


def rows(folder):
    with open(folder / "results.csv", newline="") as file:
        return list(csv.DictReader(file))


def files(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


class TrialCase(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="eyeslam_trial_test_"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def run_trial(self, *arguments):
        return subprocess.run([PROGRAMS / "eyeslam-trial", *map(str, arguments)], capture_output=True, text=True,
                              timeout=600)

    def trial(self, *arguments):
        """Runs it to a good end, and returns what it printed."""
        process = self.run_trial(*arguments)
        self.assertEqual(process.returncode, 0, process.stderr)
        return process.stdout

    def refusal(self, status, *arguments):
        """The one line of a call that is refused."""
        process = self.run_trial(*arguments)
        self.assertEqual(process.returncode, status, process.stderr)
        self.assertEqual(process.stdout, "")
        lines = process.stderr.splitlines()
        self.assertEqual(len(lines), 1, process.stderr)
        self.assertTrue(lines[0].startswith("eyeslam-trial: "), lines[0])
        return lines[0]

    def scenario(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path
