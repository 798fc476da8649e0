# SPDX-License-Identifier: GPL-3.0-or-later
"""eyeslam-replay on logs of a live simulator, and beside LCM's own tools. eyeslam_replay_test.py PROGRAM_FOLDER."""
import csv
import itertools
import json
import os
import resource
import shutil
import signal
import stat
import struct
import subprocess
import sys
import tempfile
import time
import unittest

import lcm_log
from live_case import FOLDER, LiveCase

SECONDS = 3
HEADER = struct.Struct(">qqqqq")  # of a message of ours: fingerprint, utime, utime_sent, seq, session
SCENARIOS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scenarios")
TABLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts/replay_table.py")
_live = []
_trials = []


def record(url, path, play):
    """What lcm-logger hears on an address while `play` runs."""
    logger = subprocess.Popen(["lcm-logger", "-f", f"--lcm-url={url}&recv_buf_size=2000000", path],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        time.sleep(1.0)  # until it listens; it does not say so
        play()
        time.sleep(0.5)
    finally:
        logger.send_signal(signal.SIGINT)
        logger.wait(10)
    return path


def simulate(url, shm):
    subprocess.run([os.path.join(FOLDER, "eyeslam-sim"), "--live", "--size", "200x152", "--duration", str(SECONDS), "--shm", shm,
                    "--lcm", url], check=True, capture_output=True, timeout=120)


def by_time(log):
    return sorted(lcm_log.read(log), key=lambda event: event[0])  # lcm-logger's own order is not always that


def missing_numbers(messages):
    """Numbers that are not there between the first and the last of a channel's messages of one session."""
    numbers = {HEADER.unpack_from(data)[3] for data in messages}
    return max(numbers) - min(numbers) + 1 - len(numbers)


class ReplayCase(LiveCase):
    def require(self, *tools):
        for tool in tools:
            if shutil.which(tool) is None:
                self.skipTest(f"{tool} is not installed (Debian: liblcm-bin)")

    def simulated(self):
        """lcm-logger's log of a live simulator, made once; not to be changed."""
        self.require("lcm-logger")
        if not _live:
            folder = tempfile.mkdtemp(prefix="eyeslam_replay_test_")
            unittest.addModuleCleanup(shutil.rmtree, folder, ignore_errors=True)
            _live.append(record(self.url, f"{folder}/live.lcm", lambda: simulate(self.url, self.shm)))
        return _live[0]

    def replay(self, *arguments, status=0):
        done = self.call("eyeslam-replay", *arguments)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done

    def survey(self, log):
        self.replay("info", log, "--quiet", "--json", self.path("info.json"))
        with open(self.path("info.json")) as file:
            return json.load(file)

    def channels(self, log):
        return {channel["name"]: channel for channel in self.survey(log)["channels"]}

    def cost(self, *arguments):
        """Peak memory, MB, and CPU time, s."""
        process = subprocess.Popen([os.path.join(FOLDER, "eyeslam-replay"), *arguments, "--quiet"])
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 0)
        return usage.ru_maxrss / 1024, usage.ru_utime + usage.ru_stime


class OneLog(ReplayCase):
    def test_survey_counts_what_is_there(self):
        events = list(lcm_log.read(self.simulated()))
        survey = self.survey(self.simulated())
        self.assertEqual(survey["events"], len(events))
        self.assertEqual(survey["damage"]["skipped_bytes"], 0)
        for name, channel in self.channels(self.simulated()).items():
            self.assertEqual(channel["events"], sum(event[1] == name for event in events), name)
            if channel["type"]:
                self.assertEqual(channel["lost"], missing_numbers(event[2] for event in events if event[1] == name), name)
        states = self.channels(self.simulated())["MICRON_STATE"]
        self.assertEqual(states["type"], "micron_state_t")
        self.assertAlmostEqual(states["rate_per_s"], 1000.0, delta=100.0)
        self.assertEqual([mark["sender"] for mark in survey["marks"]], ["eyeslam-sim", "eyeslam-sim"])
        self.assertIn("MICRON_STATE", self.replay("info", self.simulated()).stdout)

    def test_parts_add_up_to_the_whole(self):
        whole = by_time(self.simulated())
        self.replay("cut", self.simulated(), "--to", "1.25", "--out", self.path("a.lcm"))
        self.replay("cut", self.simulated(), "--from", "1.25", "--out", self.path("b.lcm"))
        first, second = list(lcm_log.read(self.path("a.lcm"))), list(lcm_log.read(self.path("b.lcm")))
        self.assertEqual(sorted(first + second), sorted(whole))
        self.assertTrue(max(first)[0] < whole[0][0] + 1250000 <= min(second)[0])
        parts = [self.channels(self.path(name)) for name in ("a.lcm", "b.lcm")]
        for name, channel in self.channels(self.simulated()).items():
            self.assertEqual(sum(part[name]["events"] for part in parts if name in part), channel["events"])
        self.replay("cut", self.simulated(), "--channels", "LASER_.*|MARK", "--out", self.path("c.lcm"))
        self.assertEqual({event[1] for event in lcm_log.read(self.path("c.lcm"))}, {"LASER_STATE", "MARK"})

    def test_tables_hold_what_the_messages_say(self):
        self.replay(self.simulated(), "--csv", self.path("tables"), "--from", "0.5", "--to", "1.5")
        begin = by_time(self.simulated())[0][0]
        wanted = [(utime, *HEADER.unpack_from(data)[1:]) for utime, channel, data in by_time(self.simulated())
                  if channel == "MICRON_STATE" and 500000 <= utime - begin < 1500000]
        with open(self.path("tables/MICRON_STATE.csv")) as file:
            rows = list(csv.DictReader(file))
        columns = ("log_utime_us", "utime_us", "utime_sent_us", "seq", "session")
        self.assertEqual([tuple(int(row[name]) for name in columns) for row in rows], wanted)
        lengths = [float(row["tip_orientation_w"]) ** 2 + sum(float(row[f"tip_orientation_{axis}"]) ** 2 for axis in "xyz")
                   for row in rows]
        self.assertTrue(all(abs(length - 1.0) < 1e-9 for length in lengths))

    def test_a_changed_type_is_refused_by_name_and_the_rest_is_written(self):
        changed = [(utime, channel, bytes([data[0] ^ 1]) + data[1:] if channel == "LASER_STATE" else data)
                   for utime, channel, data in lcm_log.read(self.simulated())]
        lcm_log.write(self.path("older.lcm"), changed)
        refused = self.replay(self.path("older.lcm"), "--csv", self.path("tables"), status=1)
        self.assert_refused(refused, 1, "LASER_STATE", "laser_state_t", "no migration")
        self.assertEqual(sorted(os.listdir(self.path("tables"))), ["MARK.csv", "MICRON_STATE.csv"])
        self.assertIn("not today's laser_state_t", self.replay("info", self.path("older.lcm")).stdout)
        self.assertGreater(self.channels(self.path("older.lcm"))["LASER_STATE"]["refused"]["changed_type"], 0)

    def test_damage_is_told_and_the_rest_is_read(self):
        with open(self.simulated(), "rb") as file:
            content = bytearray(file.read())
        middle = len(content) // 2
        content[middle:middle + 5000] = b"\xff" * 5000
        with open(self.path("damaged.lcm"), "wb") as file:
            file.write(content[:-100])
        survey = self.survey(self.path("damaged.lcm"))
        self.assertTrue(survey["damage"]["cut_off"])
        self.assertGreaterEqual(survey["damage"]["skipped_bytes"], 5000)
        lost = self.survey(self.simulated())["events"] - survey["events"]
        self.assertTrue(5 <= lost <= 40, lost)
        self.assertGreater(self.channels(self.path("damaged.lcm"))["MICRON_STATE"]["lost"], 5)

    def test_what_cannot_be_done_is_refused_in_one_line(self):
        with open(self.path("text.lcm"), "w") as file:
            file.write("no log\n")
        self.assert_refused(self.call("eyeslam-replay"), 2, "LOG")
        self.assert_refused(self.call("eyeslam-replay", "info", self.path("absent.lcm")), 1, "absent.lcm")
        self.assert_refused(self.call("eyeslam-replay", "info", self.path("text.lcm")), 1, "text.lcm", "no event")
        self.assert_refused(self.call("eyeslam-replay", self.simulated(), "--speed", "2"), 2, "--lcm")
        self.assert_refused(self.call("eyeslam-replay", self.simulated(), "--lcm", "udpm://239.255.76.67:7667?ttl=1"), 2, "--key")
        self.assert_refused(self.call("eyeslam-replay", "cut", self.simulated(), "--out", self.simulated()), 2, "the log itself")
        self.assert_refused(self.call("eyeslam-replay", "cut", self.simulated(), "--from", "99", "--out", self.path("a.lcm")), 1,
                            "no event in this part")
        self.assertFalse(os.path.exists(self.path("a.lcm")))

    def test_a_full_disk_leaves_nothing_half_written(self):
        def limited():
            resource.setrlimit(resource.RLIMIT_FSIZE, (100000, 100000))
        for arguments in (("cut", self.simulated(), "--out", self.path("a.lcm")), (self.simulated(), "--csv", self.path("tables"))):
            done = subprocess.run([os.path.join(FOLDER, "eyeslam-replay"), *arguments], preexec_fn=limited, capture_output=True,
                                  text=True, timeout=60)
            self.assert_refused(done, 1, "cannot be written")
        self.assertEqual(os.listdir(self.folder), [])


class LongLogs(ReplayCase):
    def long_log(self, name, copies):
        """The simulated log over and over, as if it had gone on."""
        events = by_time(self.simulated())
        length = events[-1][0] - events[0][0] + 1000
        lcm_log.write(self.path(name), ((utime + copy * length, channel, data) for copy in range(copies)
                                        for utime, channel, data in events))
        return 1e-6 * length * copies

    def test_take_no_more_memory_and_a_fraction_of_their_time(self):
        self.long_log("short.lcm", 2)
        duration = self.long_log("long.lcm", 40)
        for arguments in (("info",), ("--csv", self.path("tables"))):
            short, _ = self.cost(*arguments, self.path("short.lcm"))
            long, seconds = self.cost(*arguments, self.path("long.lcm"))
            print(f"\n{arguments[0]}: {duration:.0f} s of log in {seconds:.2f} s of CPU time, {long:.0f} MB (2 copies: {short:.0f} MB)")
            self.assertLess(long, short + 10)
            self.assertLess(seconds, 0.1 * duration)


class Playing(ReplayCase):
    """Onto a log file instead of a network: what is sent is then counted exactly."""

    def test_sends_every_byte_at_its_time(self):
        url = f"file://{self.path('played.lcm')}?mode=w"
        start = time.monotonic()
        self.replay(self.simulated(), "--lcm", url, "--speed", "2")
        self.assertGreater(time.monotonic() - start, 0.5 * self.survey(self.simulated())["duration_s"])
        whole, played = by_time(self.simulated()), list(lcm_log.read(self.path("played.lcm")))
        self.assertEqual([event[1:] for event in played], [event[1:] for event in whole])
        early = [0.5 * (was[0] - whole[0][0]) - (now[0] - played[0][0]) for was, now in zip(whole, played)]
        self.assertLess(max(early), 100e3)  # us; late is the computer's doing, also with the first one; early would be ours

    def test_ends_in_order_on_an_interrupt(self):
        lcm_log.write(self.path("silent.lcm"), [(1700000000000000, "A", b"1"), (1700000000000000 + 3000 * 10**6, "A", b"2")])
        playing = self.start("eyeslam-replay", self.path("silent.lcm"), "--lcm", f"file://{self.path('played.lcm')}?mode=w")
        playing.expect("stays on this computer")
        time.sleep(0.5)
        self.assertEqual(playing.end(signal.SIGINT, seconds=5), 0, playing.text())
        self.assertIn("interrupted at 0.000 s", playing.text())
        self.assertEqual(len(list(lcm_log.read(self.path("played.lcm")))), 1)


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

    def test_what_a_log_lacks_is_refused_in_one_line(self):
        self.assert_refused(self.call("eyeslam-replay", self.simulated()), 1, "no MARK START of eyeslam-trial or eyeslam-servo")
        self.assert_refused(self.call("eyeslam-replay", "report", self.simulated(), "--out", self.path("report")), 1,
                            "no MARK START of a trial")
        self.assertFalse(os.path.exists(self.path("report")))
        self.assert_refused(self.call("eyeslam-replay", self.log(), "--channels", "MARK"), 2, "--channels")
        self.assert_refused(self.call("eyeslam-replay", self.log(), "--csv", self.path("a"), "--set", "a=1"), 2, "--set")


class RealTools(ReplayCase):
    attempts = 4  # UDP may lose what a busy computer does not fetch

    @staticmethod
    def without_times(events):
        return [event[1:] for event in events if event[1] != "LCM_SELF_TEST"]

    def arrives_whole(self, log, play):
        wanted = self.without_times(by_time(log))
        for attempt in range(self.attempts):
            heard = self.without_times(lcm_log.read(record(self.url, self.path("heard.lcm"), play)))
            if heard == wanted:
                return
            print(f"attempt {attempt + 1}: {len(heard)} of {len(wanted)} events arrived in order")
        self.fail(f"{log} did not arrive whole in {self.attempts} attempts")

    def test_a_log_of_lcm_logger_surveys_and_plays(self):
        states = self.channels(self.simulated())["MICRON_STATE"]
        self.assertEqual(states["type"], "micron_state_t")
        self.assertGreater(states["events"], 900 * SECONDS)
        self.assertEqual(states["refused"], {"changed_type": 0, "undecodable": 0})
        self.assertGreaterEqual(states["transport_ms"]["median"], 0.0)
        self.arrives_whole(self.simulated(), lambda: self.replay(self.simulated(), "--lcm", self.url))

    def test_a_cut_log_plays_in_lcm_logplayer(self):
        self.require("lcm-logplayer")
        self.replay("cut", self.simulated(), "--from", "1", "--to", "2.5", "--out", self.path("cut.lcm"))
        self.arrives_whole(self.path("cut.lcm"),
                           lambda: subprocess.run(["lcm-logplayer", "-l", self.url, self.path("cut.lcm")], check=True,
                                                  capture_output=True, timeout=60))


if __name__ == "__main__":
    unittest.main()
