# SPDX-License-Identifier: GPL-3.0-or-later
"""eyeslam-replay on logs of a live simulator, and beside LCM's own tools. eyeslam_replay_test.py PROGRAM_FOLDER."""
import csv
import os
import resource
import signal
import subprocess
import time
import unittest

import lcm_log
from live_case import FOLDER
from replay_case import SECONDS, HEADER, ReplayCase, by_time, missing_numbers, record


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
