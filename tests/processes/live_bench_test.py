# SPDX-License-Identifier: GPL-3.0-or-later
"""eyeslam-bench live for ten seconds: live_bench_test.py PROGRAM_FOLDER. The measurement takes ten minutes
(docs/results.md); here it has to run, and what must hold on any computer holds."""
import re
import unittest

from live_case import LiveCase


class Bench(LiveCase):
    def test_servo_and_tracker_run_as_processes_and_no_command_expires_needlessly(self):
        process = self.call("eyeslam-bench", "live", "--seconds", "10", "--quiet", seconds=200)
        self.assertEqual(process.returncode, 0, process.stdout + process.stderr)
        print("\n" + process.stdout)
        rows = dict(re.findall(r"^\| ([^|]+) \| ([\d.]+) \|", process.stdout, re.M))
        self.assertEqual(int(rows["commands that expired needlessly"]), 0)
        self.assertGreater(float(rows["CPU of a cycle, median, us"]), 0.0)
        self.assertLess(float(rows["frame to first command, median, ms"]), 50.0, "the tracker's frames do not reach it")
        cycles = int(process.stdout.split()[0])
        self.assertGreater(cycles, 5000, "a loop of 1 kHz on a very busy computer")

    def test_refuses_what_makes_no_sense(self):
        for arguments, named in ((("--seconds", "0"), "--seconds"), (("--programs", "gone"), "gone")):
            self.assert_refused(self.call("eyeslam-bench", "live", *arguments), 2, named)


if __name__ == "__main__":
    unittest.main()
