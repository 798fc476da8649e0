# SPDX-License-Identifier: GPL-3.0-or-later
"""A trial's log computed again, and judged again. replay_computed_test.py PROGRAM_FOLDER."""
import itertools
import json
import os
import shutil
import stat
import subprocess
import sys
import tempfile
import unittest

import lcm_log
from live_case import FOLDER
from replay_case import ReplayCase

HERE = os.path.dirname(os.path.abspath(__file__))
SCENARIOS = os.path.join(HERE, "../../scenarios")
TABLE = os.path.join(HERE, "../../scripts/replay_table.py")
_trials = []


class ComputedAgain(ReplayCase):
    """A short trial's log, computed again."""

    def trial(self):
        """The folder of a trial, made once; not to be changed."""
        if not _trials:
            folder = tempfile.mkdtemp(prefix="eyeslam_replay_test_")
            unittest.addModuleCleanup(shutil.rmtree, folder, ignore_errors=True)
            keys = {"aid": "hard", "duration_s": 1, "settling_s": 1, "hardware.camera.width": 400, "hardware.camera.height": 304,
                    "servo.image_width_px": 400, "servo.image_height_px": 304, "vision.tracker.frame.scale": 1}
            settings = [word for key, value in keys.items() for word in ("--set", f"{key}={value}")]
            subprocess.run([os.path.join(FOLDER, "eyeslam-trial"), os.path.join(SCENARIOS, "vessel_tracing.yaml"), *settings,
                            "--quiet", "--out", folder], check=True, timeout=300)
            _trials.append(folder)
        return _trials[0]

    def log(self):
        return os.path.join(self.trial(), "vessel_tracing/seed_0000/trial.lcm")

    def compared(self, *arguments, status=0):
        done = self.replay(*arguments, "--json", self.path("replay.json"), status=status)
        with open(self.path("replay.json")) as file:
            report = json.load(file)
        return done, report, {channel["name"]: channel for channel in report["channels"]}

    def test_says_the_same_bytes(self):
        done, report, channels = self.compared(self.log())
        events = list(lcm_log.read(self.log()))
        self.assertEqual((report["events"], report["skipped"]), (len(events), 0))
        for name in ("MICRON_COMMAND", "LASER_COMMAND", "SERVO_STATUS", "REGISTRATION"):
            self.assertEqual(channels[name]["compared"], sum(event[1] == name for event in events), name)
            self.assertEqual(channels[name]["identical"], channels[name]["compared"])
            self.assertIsNone(channels[name]["first_difference_utime"])
        self.assertIn("in lock step: vessel_tracing, seed 0", done.stdout)
        self.assertEqual(self.replay(self.log(), "--quiet").stdout, "")

    def test_a_changed_command_is_status_1_and_found_by_time_and_field_but_not_beside_its_part(self):
        events = list(lcm_log.read(self.log()))
        number = [i for i, event in enumerate(events) if event[1] == "MICRON_COMMAND"][1000]
        utime, channel, data = events[number]
        events[number] = (utime, channel, data[:47] + bytes([data[47] ^ 1]) + data[48:])
        lcm_log.write(self.path("changed.lcm"), events)
        done, _, channels = self.compared(self.path("changed.lcm"), status=1)
        self.assert_refused(done, 1, "changed.lcm: 1 of", "MICRON_COMMAND.utime_image_us")
        self.assertEqual(channels["MICRON_COMMAND"]["first_difference_utime"], utime)
        at = 1e-6 * (utime - events[0][0])
        _, _, channels = self.compared(self.path("changed.lcm"), "--from", str(at + 0.001))
        self.assertGreater(channels["MICRON_COMMAND"]["compared"], 1000)
        self.assert_refused(self.call("eyeslam-replay", self.path("changed.lcm"), "--to", str(at + 0.001)), 1, "1 of")

    def rewritten(self, name, change):
        """The log with each event as change(utime, channel, data) returns it."""
        lcm_log.write(self.path(name), (change(*event) for event in lcm_log.read(self.log())))
        return self.path(name)

    def test_nothing_that_is_read_and_no_device_is_replaced(self):
        shutil.copy(self.log(), self.path("own.lcm"))
        os.mkfifo(self.path("pipe"))
        for arguments in (("own.lcm", "--json", "own.lcm"), ("info", "own.lcm", "--json", "own.lcm"),
                          ("cut", "own.lcm", "--out", "own.lcm")):
            arguments = [self.path(word) if word == "own.lcm" else word for word in arguments]
            self.assert_refused(self.call("eyeslam-replay", *arguments), 2, "own.lcm", "itself")
        self.assert_refused(self.call("eyeslam-replay", "cut", self.path("own.lcm"), "--out", self.path("pipe")), 1, "no ordinary file")
        self.assertTrue(stat.S_ISFIFO(os.stat(self.path("pipe")).st_mode))
        with open(self.log(), "rb") as was, open(self.path("own.lcm"), "rb") as now:
            self.assertEqual(was.read(), now.read())

    def test_a_start_at_an_impossible_time_is_refused_at_once_and_leaves_its_reason(self):
        for bit in (22, 55, 63):
            def change(utime, channel, data):
                if channel != "MARK":
                    return utime, channel, data
                time_of_it = int.from_bytes(data[8:16], "big") ^ 1 << bit
                return utime, channel, data[:8] + time_of_it.to_bytes(8, "big") + data[16:]
            log = self.rewritten("broken.lcm", change)
            self.assert_refused(self.call("eyeslam-replay", log, "--json", self.path("broken.json")), 1, "broken.lcm", "another time")
            table = subprocess.run([sys.executable, TABLE, self.path("broken.json")], capture_output=True, text=True)
            self.assertEqual(table.returncode, 1, table.stdout)
            self.assertIn("another time", table.stdout)

    def test_to_compare_nothing_is_no_success(self):
        for arguments in ((), ("--csv", self.path("tables")), ("--lcm", "memq://", "--quiet")):
            self.assert_refused(self.call("eyeslam-replay", self.log(), "--from", "1000", *arguments), 1, "in this part")
        self.assertFalse(os.path.exists(self.path("tables")))
        with open(self.path("empty.json"), "w") as file:
            json.dump({"channels": []}, file)
        self.assertEqual(subprocess.run([sys.executable, TABLE, self.path("empty.json")], capture_output=True).returncode, 1)

    def test_a_what_if_of_a_part_that_is_not_computed_is_refused(self):
        for only in ((), ("--only", "servo")):
            refused = self.call("eyeslam-replay", self.log(), *only, "--set", "vision.tracker.frame.scale=0.3")
            self.assert_refused(refused, 2, "vision.tracker.frame.scale", "not computed again")

    def test_a_message_of_another_version_ends_what_needs_it(self):
        changed = lambda name: lambda utime, channel, data: (utime, channel, (bytes(8) if channel == name else data[:8]) + data[8:])
        for name, command in (("TRUTH", "report"), ("MARK", "report"), ("MARK", None), ("OPERATOR", None)):
            log = self.rewritten("changed.lcm", changed(name))
            call = ("report", log, "--out", self.path("report")) if command else (log,)
            self.assert_refused(self.call("eyeslam-replay", *call), 1, f"{name} is not today's", "no migration")
        self.replay(self.rewritten("changed.lcm", changed("TRUTH")))  # which no servo hears

    def test_damage_is_told_by_every_command(self):
        with open(self.log(), "rb") as file:
            data = file.read()
        with open(self.path("hole.lcm"), "wb") as file:
            file.write(data[:1_000_000] + data[1_003_000:])
        done = self.replay("cut", self.path("hole.lcm"), "--out", self.path("cut.lcm"))
        self.assertRegex(done.stderr, r"hole\.lcm: \d+ bytes of it are no events")
        self.assertEqual(self.replay("cut", self.path("cut.lcm"), "--out", self.path("again.lcm")).stderr, "")

    def test_a_what_if_says_how_far_its_goals_are_off(self):
        with open(self.path("other.yaml"), "w") as file:
            file.write("servo:\n  cycle:\n    predicts_null: false\n")
        done, _, channels = self.compared(self.log(), "--config", self.path("other.yaml"), status=1)
        self.assertRegex(done.stdout, r"goals of \d+ commands: .* um apart in the median")
        self.assertIn("goal_x_m", {field["name"] for field in channels["MICRON_COMMAND"]["fields"]})
        self.assert_refused(self.call("eyeslam-replay", self.log(), "--set", "motion=jerky"), 2, "motion", "recorded")
        self.assert_refused(self.call("eyeslam-replay", self.log(), "--set", "servo.no_such=1"), 2, "servo.no_such")

    def test_takes_no_more_memory_for_a_longer_log(self):
        length = 1e-6 * (lambda events: events[-1][0] - events[0][0])(list(lcm_log.read(self.log())))
        self.replay("cut", self.log(), "--to", str(0.5 * length), "--out", self.path("half.lcm"))
        half, _ = self.cost(self.path("half.lcm"))
        whole, seconds = self.cost(self.log())
        size = 0.5e-6 * os.path.getsize(self.log())
        print(f"\n{length:.0f} s in {seconds:.2f} s of CPU time, {whole:.0f} MB (half of it: {half:.0f} MB; half the log: {size:.0f} MB)")
        self.assertLess(whole, half + 0.5 * size)

    def test_a_report_is_that_of_the_trial_but_for_the_time_it_took(self):
        self.replay("report", self.log(), "--out", self.path("report"))
        for name, theirs in (("results.json", os.path.dirname(self.log())), ("report.html", os.path.dirname(self.log())),
                             ("results.csv", self.trial())):
            with open(self.path(f"report/{name}")) as mine, open(os.path.join(theirs, name)) as other:
                pairs = [(a, b) for a, b in itertools.zip_longest(mine, other) if a != b]
            if name == "results.csv":
                (row, was), = pairs
                fields = [i for i, (a, b) in enumerate(zip(row.split(","), was.split(","))) if a != b]
                self.assertEqual(len(fields), 1, pairs)
            else:
                self.assertEqual(len(pairs), 1, pairs)
                self.assertIn("wall_s", pairs[0][0])

    def test_a_report_of_a_log_that_was_cut_off_says_so(self):
        length = 1e-6 * (lambda events: events[-1][0] - events[0][0])(list(lcm_log.read(self.log())))
        self.replay("cut", self.log(), "--to", str(length - 0.4), "--out", self.path("short.lcm"))
        self.assert_refused(self.call("eyeslam-replay", "report", self.path("short.lcm"), "--out", self.path("report"), "--quiet"),
                            1, "short.lcm", "no MARK STOP")
        with open(self.path("report/report.html")) as file:
            self.assertIn("no MARK STOP", file.read())

    def test_a_log_that_cannot_be_computed_has_its_row_in_a_table(self):
        with open(self.path("empty.lcm"), "w"):
            pass
        self.replay(self.log(), "--json", self.path("gone.json"))
        for log, result in (("empty.lcm", "empty.json"), ("gone.lcm", "gone.json")):
            self.replay(self.path(log), "--json", self.path(result), status=1)
            table = subprocess.run([sys.executable, TABLE, self.path(result)], capture_output=True, text=True)
            self.assertEqual(table.returncode, 1, table.stdout)
            self.assertIn(log, table.stdout)

    def test_what_a_log_lacks_is_refused_in_one_line(self):
        self.assert_refused(self.call("eyeslam-replay", self.simulated()), 1, "no MARK START of eyeslam-trial or eyeslam-servo")
        self.assert_refused(self.call("eyeslam-replay", "report", self.simulated(), "--out", self.path("report")), 1,
                            "no MARK START of a trial")
        self.assertFalse(os.path.exists(self.path("report")))
        self.assert_refused(self.call("eyeslam-replay", self.log(), "--channels", "MARK"), 2, "--channels")
        self.assert_refused(self.call("eyeslam-replay", self.log(), "--csv", self.path("a"), "--set", "a=1"), 2, "--set")


if __name__ == "__main__":
    unittest.main()
