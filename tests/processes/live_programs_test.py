# SPDX-License-Identifier: GPL-3.0-or-later
"""eyeslam-servo, eyeslam-sim --live and eyeslam-view --console alone: live_programs_test.py PROGRAM_FOLDER."""
import csv
import os
import signal
import unittest

from live_case import LiveCase


class Servo(LiveCase):
    def test_helps(self):
        process = self.call("eyeslam-servo", "--help")
        self.assertEqual(process.returncode, 0)
        for option in ("--lcm", "--key", "--config", "--set", "--registration", "--timing", "--quiet", "Examples"):
            self.assertIn(option, process.stdout)

    def test_reads_back_the_configuration_it_dumps(self):
        dump = self.call("eyeslam-servo", "--dump-config", "--set", "cycle.null_at=controller")
        self.assertEqual(dump.returncode, 0, dump.stderr)
        with open(self.path("my.yaml"), "w") as file:
            file.write(dump.stdout)
        again = self.call("eyeslam-servo", "--dump-config", "--config", self.path("my.yaml"))
        self.assertEqual(dump.stdout, again.stdout)
        self.assertIn("null_at: controller", again.stdout)

    def test_refuses_what_makes_no_sense(self):
        for arguments, named in ((("--fast",), "--fast"), (("--set", "cycle.null=x"), "cycle.null"),
                                 (("--set", "cycle.lead_ms=nan"), "cycle.lead_ms"), (("--config", "gone.yaml"), "gone.yaml"),
                                 (("--lcm", "tcp"), "tcp"), (("--lcm", "udpm://239.255.76.67:7667?ttl=1"), "--key"),
                                 (("--key", self.path("gone.key")), "gone.key"), (("--dump-config=xml",), "xml")):
            with self.subTest(arguments=arguments):
                self.assert_refused(self.call("eyeslam-servo", *arguments), 2, named)

    def test_refuses_a_registration_that_is_none(self):
        for text in ("", "{}", '{"version": 2}', "[1]"):
            with open(self.path("camera.json"), "w") as file:
                file.write(text)
            process = self.call("eyeslam-servo", "--lcm", self.url, "--quiet", "--registration", self.path("camera.json"))
            self.assert_refused(process, 1, "camera.json")

    def test_refuses_a_key_that_others_can_read(self):
        with open(self.path("open.key"), "w") as file:
            file.write("0" * 64)
        os.chmod(self.path("open.key"), 0o644)
        self.assert_refused(self.call("eyeslam-servo", "--key", self.path("open.key")), 2, "open.key")

    def test_refuses_a_timing_file_that_cannot_be_written_at_the_start(self):
        process = self.call("eyeslam-servo", "--lcm", self.url, "--quiet", "--timing", self.path("gone/a.csv"))
        self.assert_refused(process, 1, "gone/a.csv")

    def assert_ends_in_order(self, number):
        servo = self.start("eyeslam-servo", "--lcm", self.url, "--timing", self.path("cycles.csv"))
        servo.expect("running at 1 kHz")
        servo.expect("^servo: standby")
        self.assertEqual(servo.end(number), 0, servo.text())
        servo.expect("interrupted: laser off, the tip is the controller's; \\d+ cycles")
        with open(self.path("cycles.csv"), newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertGreater(len(rows), 10)
        for row in rows:
            self.assertGreaterEqual(float(row["lateness_us"]), 0.0)
            self.assertGreaterEqual(float(row["computation_us"]), 0.0)

    def test_ctrl_c_ends_it_in_order(self):
        self.assert_ends_in_order(signal.SIGINT)

    def test_termination_ends_it_in_order(self):
        self.assert_ends_in_order(signal.SIGTERM)

    def test_prints_nothing_when_quiet(self):
        servo = self.start("eyeslam-servo", "--lcm", self.url, "--quiet")
        with self.assertRaises(AssertionError):
            servo.expect(".", 1)
        self.assertEqual(servo.end(), 0)
        self.assertEqual(servo.lines, [])

    def test_says_whether_it_runs_in_real_time(self):
        servo = self.start("eyeslam-servo", "--lcm", self.url)
        line = servo.expect("running at 1 kHz.*").group(0)
        if "in real time" not in line:
            servo.expect("not in real time: (no SCHED_FIFO|memory is not locked)")


class View(LiveCase):
    def view(self, lines, *arguments):
        return self.call("eyeslam-view", "--console", "--lcm", self.url, "--quiet", *arguments, lines=lines)

    def test_helps(self):
        process = self.call("eyeslam-view", "--help")
        self.assertEqual(process.returncode, 0)
        self.assertIn("--console", process.stdout)

    def test_says_that_the_window_comes_later(self):
        self.assert_refused(self.call("eyeslam-view"), 2, "--console")

    def test_lists_its_commands(self):
        process = self.view("help\n")
        self.assertEqual(process.returncode, 0, process.stderr)
        for command in ("calibrate", "fixture point", "approve HASH", "rearm", "quit"):
            self.assertIn(command, process.stdout)

    def test_the_end_of_the_input_is_standby(self):
        process = self.view("ready\n")
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertEqual(process.stdout.splitlines(), ["wanted: ready", "standby; the console ends"])

    def test_quit_leaves_the_rest_unread(self):
        process = self.view("quit\nfly\n")
        self.assertEqual(process.returncode, 0, process.stderr)

    def test_an_unfinished_last_line_counts(self):
        self.assertIn("wanted: ready", self.view("# a remark\n\nready").stdout)

    def test_a_line_of_a_pipe_that_cannot_be_obeyed_ends_it_in_standby(self):
        for line, named in (("fly", "fly"), ("fixture point 1 2", "RETINA_POSE"), ("propose gone.json", "RETINA_POSE"),
                            ("approve 12345678", "no plan"), ("await ready 0.1", "await ready"), ("wait", "S is missing")):
            with self.subTest(line=line):
                process = self.view(f"ready\n{line}\nassist\n")
                self.assert_refused(process, 1, "line 2", named)
                self.assertIn("standby", process.stdout)
                self.assertNotIn("assist", process.stdout)

    def test_ctrl_c_is_standby(self):
        view = self.start("eyeslam-view", "--console", "--lcm", self.url)
        view.tell("ready")
        view.expect("wanted: ready")
        self.assertEqual(view.end(), 0)
        view.expect("standby; the console ends")

    def test_refuses_what_makes_no_sense(self):
        self.assert_refused(self.call("eyeslam-view", "--console", "--size", "800"), 2, "--size 800")
        self.assert_refused(self.call("eyeslam-view", "--console", "--lcm", "tcp"), 2, "tcp")

    def test_hears_the_servo(self):
        servo = self.start("eyeslam-servo", "--lcm", self.url)
        servo.expect("running")
        view = self.start("eyeslam-view", "--console", "--lcm", self.url)
        view.expect("servo: standby")
        view.tell("ready")
        view.expect("servo: standby: no_state")  # there is no manipulator
        self.assertEqual(servo.end(signal.SIGKILL), -signal.SIGKILL)
        view.expect("servo: silent")


class Simulator(LiveCase):
    def test_refuses_what_makes_no_sense(self):
        for arguments, named in (((), "--live"), (("--live", "--out", self.path("a")), "--out"),
                                 (("--out", self.path("a"), "--lcm", self.url), "--lcm"),
                                 (("--live", "--fault", "states_stop"), "states_stop"),
                                 (("--live", "--fault", "fire@3"), "fire"), (("--live", "--task", "dance"), "--task"),
                                 (("--live", "--motion", "wild"), "wild"), (("--live", "--size", "9x9"), "--size"),
                                 (("--live", "--fps", "nan"), "--fps"), (("--live", "--condition", "fog"), "fog")):
            with self.subTest(arguments=arguments):
                self.assert_refused(self.call("eyeslam-sim", *arguments), 2, named)

    def test_runs_for_its_time_and_says_what_the_hand_reached(self):
        process = self.call("eyeslam-sim", "--live", "--lcm", self.url, "--shm", self.shm, "--size", "200x152",
                            "--duration", "5")
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertRegex(process.stdout, r"tip error by hand alone: \d+ um RMS, \d+ median, \d+ p95 \(\d\.\d s\)")
        self.assertNotIn("guided", process.stdout)
        self.assertFalse(os.path.exists("/dev/shm/" + self.shm), "the frames' memory is left behind")

    def test_ctrl_c_ends_it_in_order(self):
        sim = self.start("eyeslam-sim", "--live", "--lcm", self.url, "--shm", self.shm, "--size", "200x152")
        sim.expect("live: task hold")
        self.assertEqual(sim.end(), 0, sim.text())
        sim.expect("frames: ")

    def ready(self):
        servo = self.start("eyeslam-servo", "--lcm", self.url)
        sim = self.start("eyeslam-sim", "--live", "--lcm", self.url, "--shm", self.shm, "--size", "200x152")
        view = self.start("eyeslam-view", "--console", "--lcm", self.url)
        sim.expect("live:")
        servo.expect("standby")
        view.tell("ready")
        view.expect("servo: ready")
        sim.expect("controller: follows the servo")
        return servo, sim, view

    def test_tells_why_the_controller_moves_the_tip_when_the_servo_was_killed(self):
        servo, sim, _ = self.ready()
        servo.end(signal.SIGKILL)
        sim.expect("controller: moves the tip by its own filter: expired")

    def test_a_second_servo_is_in_fault_before_it_commands_anything(self):
        self.ready()
        self.start("eyeslam-servo", "--lcm", self.url).expect("servo: fault: ")

    def test_a_stop_holds_until_a_human_rearms(self):
        servo, sim, view = self.ready()
        view.tell("stop")
        servo.expect("servo: hold: stopped")
        sim.expect("controller: moves the tip by its own filter")
        view.tell("rearm")
        before = len(servo.lines)
        servo.expect("servo: ready", since=max(before - 1, 0))
        self.assertEqual(servo.end(), 0, servo.text())

    def test_drives_the_servo_to_ready_and_its_faults_out_of_it(self):
        servo = self.start("eyeslam-servo", "--lcm", self.url)
        sim = self.start("eyeslam-sim", "--live", "--lcm", self.url, "--shm", self.shm, "--size", "200x152", "--fault",
                         "power_off@8")
        view = self.start("eyeslam-view", "--console", "--lcm", self.url)
        sim.expect("live:")
        servo.expect("standby")
        view.tell("ready")
        view.expect("servo: ready")
        view.expect("servo: fault: ")
        self.assertEqual(servo.end(), 0)
        servo.expect("laser off")


if __name__ == "__main__":
    unittest.main()
