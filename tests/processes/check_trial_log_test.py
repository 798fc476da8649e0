# SPDX-License-Identifier: GPL-3.0-or-later
"""The checker of trial logs finds each broken rule by its name and nothing else, and nothing in a log without fault."""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import trial_log_case
from trial_log_case import LENGTH_ms, OFF_um, PULSE_ms, ROOT, UM_PER_PX, Trial
from trial_log_faults import BREAKS, FIRST, end_at, far, jump, vessel_at

sys.path.insert(0, str(ROOT / "scripts"))
import check_trial_log  # noqa: E402  (its folder is no package of this test's)
from trial_log.findings import RULES  # noqa: E402

TYPES = trial_log_case.message_types()


class CheckTrialLog(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="check_trial_log_")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.log = os.path.join(folder.name, "trial.lcm")

    def check(self, trial, **how):
        options = argparse.Namespace(size=None, oldest_pose_ms=None, reaction_ms=how.pop("reaction_ms", 2.0), types=ROOT / "lcmtypes")
        trial.write(self.log, **how)
        return check_trial_log.check(self.log, options)

    def rules(self, trial, **how):
        return [found["rule"] for found in self.check(trial, **how)["violations"]]

    def test_a_trial_without_fault_has_no_violation(self):
        result = self.check(Trial(TYPES))
        self.assertEqual(result["violations"], [])
        self.assertTrue(result["lock_step"])
        self.assertEqual([(pulse["number"], pulse["target"], pulse["placement_um"], pulse["far"]) for pulse in result["pulses"]],
                         [(1, 1, OFF_um, False), (2, 2, OFF_um, False)])

    def test_messages_on_their_way_are_no_violation(self):
        result = self.check(Trial(TYPES), late_us=lambda number: 300 * (number > 0))
        self.assertEqual((result["violations"], result["lock_step"]), ([], False))

    def test_only_in_lock_step_is_a_message_known_the_moment_it_is_sent(self):
        for late_us, rules in ((0, ["foot_switch"]), (300, [])):
            trial = Trial(TYPES)
            trial.set("LASER_STATE", FIRST, FIRST, foot_switch=False)
            trial.set("LASER_STATE", FIRST + 1, FIRST + 1, foot_switch=True)
            self.assertEqual(self.rules(trial, late_us=lambda number: late_us), rules)

    def test_each_broken_rule_is_found_by_its_name_and_nothing_else(self):
        for i, (rule, break_it) in enumerate(BREAKS):
            with self.subTest(rule=rule, number=i):
                trial = Trial(TYPES)
                break_it(trial)
                self.assertEqual(self.rules(trial), [rule])

    def test_each_rule_is_broken_once_at_least(self):
        self.assertEqual({rule for rule, _ in BREAKS}, set(RULES))

    def test_a_map_that_began_in_a_later_frame_puts_a_target_where_the_first_would(self):
        trial = Trial(TYPES)
        trial.leave_out("RETINA_POSE", 0, 300)
        for channel in ("MICRON_COMMAND", "LASER_COMMAND"):
            trial.set(channel, 0, 350, utime_image=0)
        result = self.check(trial)
        self.assertEqual((result["violations"], result["pulses"][1]["placement_um"]), ([], OFF_um))

    def test_a_far_pulse_is_explained_by_a_retina_that_moved_within_it(self):
        trial = Trial(TYPES)
        far(trial)
        jump(trial, FIRST + 10, 42e-6)
        result = self.check(trial)
        self.assertEqual((result["violations"], result["far"], result["far_explained"]), ([], 1, 1))
        self.assertAlmostEqual(result["pulses"][0]["placement_um"], OFF_um + 60, delta=1)

    def test_a_vessel_is_near_by_the_edges_of_its_cells(self):
        for column, rules in ((35, []), (34, ["map_margin"]), (14, []), (15, ["map_margin"])):
            trial = Trial(TYPES)
            vessel_at(column)(trial)
            self.assertEqual(self.rules(trial), rules, column)

    def test_what_ends_within_the_reaction_is_no_violation(self):
        for last, rules in ((FIRST + 6, []), (FIRST + 7, ["foot_switch"])):
            trial = Trial(TYPES)
            trial.add(FIRST + 5, "LASER_STATE", emitting=True, pulse=1, target=1, armed=True, interlock_closed=True)
            trial.set("LASER_STATE", FIRST + 5, FIRST + PULSE_ms, foot_switch=False)
            end_at(trial, last)
            self.assertEqual(self.rules(trial), rules)
            self.assertEqual(self.rules(trial, reaction_ms=last - FIRST - 4), [])

    def test_a_clock_that_the_trial_sets_is_no_disorder(self):
        for fault, rules in (("", ["sender_time"]), ("fault:\n  kind: clock_step\n", [])):
            trial = Trial(TYPES)
            trial.of("MARK")[0].configuration += fault
            for state in trial.of("MICRON_STATE", 900, 950):
                state.utime, state.utime_sent = state.utime + 1_000_000, state.utime_sent + 1_000_000
            self.assertEqual(self.rules(trial), rules)

    def test_a_pulse_by_hand_needs_no_servo_and_no_explanation(self):
        trial = Trial(TYPES)
        trial.of("MARK")[0].configuration = trial_log_case.CONFIGURATION.replace("automated", "manual")
        for channel in ("SERVO_STATUS", "REGISTRATION", "MICRON_COMMAND", "OPERATOR", "RETINA_POSE", "VESSEL_MAP"):
            trial.leave_out(channel, 0, LENGTH_ms)
        trial.leave_out("BURN_PLAN", 0, LENGTH_ms, lambda plan: plan.state == 0)
        trial.set("LASER_COMMAND", 0, LENGTH_ms, utime_image=0)
        trial.set("MICRON_STATE", 0, LENGTH_ms, flags=3)
        x_px, y_px = trial_log_case.TARGETS[1]  # its map is the truth's
        trial.set("TRUTH", 0, LENGTH_ms, spot=[(x_px * UM_PER_PX + 70) * 1e-6, y_px * UM_PER_PX * 1e-6])
        result = self.check(trial)
        self.assertEqual((result["violations"], result["far"], result["interlock_violations"]), ([], 2, 0))
        self.assertAlmostEqual(result["pulses"][0]["placement_um"], 70.0, delta=1e-6)
        trial.set("LASER_STATE", 0, LENGTH_ms, interlock_closed=False)
        self.assertEqual(self.rules(trial), ["interlock_closed"])

    def test_a_type_that_has_changed_is_noticed(self):
        types = shutil.copytree(ROOT / "lcmtypes", os.path.join(self.folder, "types"))
        path = os.path.join(types, "tool_tip_t.lcm")
        text = pathlib.Path(path).read_text()
        pathlib.Path(path).write_text(text.replace("shaft_angle;", "shaft_tilt;"))
        Trial(TYPES).write(self.log)
        self.assertIn("message_type", self.program(self.log, "--types", types).stdout)

    def program(self, *arguments):
        return subprocess.run([sys.executable, str(ROOT / "scripts" / "check_trial_log.py"), *arguments],
                              capture_output=True, text=True, timeout=60)

    def test_it_tells_by_its_exit_status_and_in_json(self):
        report = os.path.join(self.folder, "report.json")
        trial = Trial(TYPES)
        trial.write(self.log)
        self.assertEqual(self.program(self.log).returncode, 0)
        far(trial)
        trial.write(self.log)
        process = self.program(self.log, "--json", report)
        self.assertEqual((process.returncode, process.stderr), (1, ""))
        self.assertIn("far_explained: 1, first at 0.501 s", process.stdout)
        found = json.loads(pathlib.Path(report).read_text())
        self.assertEqual((found["summary"]["far_unexplained"], found["logs"][0]["violations"][0]["rule"]), (1, "far_explained"))

    def test_a_damaged_log_is_named_in_one_line_and_what_is_whole_is_judged(self):
        for damage in (lambda data: data[:-20], lambda data: data[:40000] + b"noise" + data[40000:], lambda data: b"x" + data):
            Trial(TYPES).write(self.log, damage=damage)
            process = self.program(self.log)
            self.assertEqual((process.returncode, len(process.stderr.splitlines())), (1, 1), process.stderr)
            self.assertIn(self.log, process.stderr)
            self.assertIn("whole_log", process.stdout)

    def test_what_is_no_log_is_named_in_one_line(self):
        noise = os.path.join(self.folder, "noise.lcm")
        pathlib.Path(noise).write_bytes(b"\xed\xa1\xda\x01" * 999)
        empty = os.path.join(self.folder, "empty.lcm")
        pathlib.Path(empty).write_bytes(b"")
        for path in (noise, empty, self.folder, os.path.join(self.folder, "none.lcm"), __file__):
            process = self.program(path)
            self.assertEqual((process.returncode, len(process.stderr.splitlines())), (1, 1), process.stderr)
            self.assertIn(path, process.stderr)

    def test_a_log_without_the_size_of_its_image_asks_for_it(self):
        trial = Trial(TYPES)
        trial.of("MARK")[0].configuration = ""
        trial.write(self.log)
        self.assertIn("--size", self.program(self.log).stderr)
        self.assertEqual(self.program(self.log, "--size", "800x608").returncode, 0)

    def test_a_wrong_call_is_2(self):
        for call in ((), (self.log, "--size", "800"), (self.log, "--types", self.folder), (self.log, "--unknown")):
            self.assertEqual(self.program(*call).returncode, 2, call)


if __name__ == "__main__":
    unittest.main()
