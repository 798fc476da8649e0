# SPDX-License-Identifier: GPL-3.0-or-later
"""eyeslam-trial on good and on bad calls: eyeslam_trial_test.py PROGRAM_DIR [unittest arguments]."""
import json
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import cv2
import lcm_log
from trial_case import PROGRAMS, ROOT, SCENARIOS, SMALL, TRACING, TrialCase, files, rows, settings, small

# contracts, section 7
COLUMNS = ("scenario,seed,aid,motion,condition,retina,camera_hz,latency_ms,mean_um,rms_um,median_um,p95_um,max_um,"
           "path_coverage,duration_s,tip_travel_mm,saturated_fraction,pose_rms_px,pose_rms_deg,tracked_fraction,targets,"
           "fired,refused,missed,placement_mean_um,placement_p95_um,placement_max_um,far_pulses,far_unexplained,"
           "burns_per_s,min_vessel_clearance_um,interlock_violations,hold_events,fault_events,wall_s,version,config_hash")
STUDY = [TRACING, *settings(aid="none hard", duration_s=5), "--seeds", "2"]
FOLDERS = [f"vessel_tracing/aid={aid}/seed_{seed:04}" for aid in ("hard", "none") for seed in (0, 1)]


class Study(TrialCase):
    """Tracing with a hard fixture and without, two seeds of five seconds: run whole, and again in two shards."""

    @classmethod
    def setUpClass(cls):
        cls.base = pathlib.Path(tempfile.mkdtemp(prefix="eyeslam_trial_test_"))
        cls.addClassCleanup(shutil.rmtree, cls.base, ignore_errors=True)
        cls.whole = cls.base / "whole"
        cls.process = subprocess.run([PROGRAMS / "eyeslam-trial", *STUDY, "--jobs", "2", "--out", cls.whole],
                                     capture_output=True, text=True, timeout=600)

    def test_it_ends_well_and_says_where_the_report_is(self):
        self.assertEqual(self.process.returncode, 0, self.process.stderr)
        for text in ("vessel_tracing", "hard fixture", "no aid", "RMS", "p95", "reduction",
                     str(self.whole / "report.html"), str(self.whole / "results.csv")):
            self.assertIn(text, self.process.stdout)

    def test_each_trial_has_a_folder_with_log_scores_and_report_and_nothing_else_is_left(self):
        names = ("report.html", "results.json", "trial.lcm")
        expected = [f"{folder}/{name}" for folder in FOLDERS for name in names]
        self.assertEqual(files(self.whole), sorted(expected + ["report.html", "results.csv"]))

    def test_the_aid_makes_tracing_better_on_each_seed(self):
        of = {(row["aid"], row["seed"]): row for row in rows(self.whole)}
        for seed in ("0", "1"):
            for figure in ("rms_um", "median_um", "p95_um"):
                # A fifth: the bound of a study is an eighth, and two seeds are few.
                self.assertLess(float(of["hard", seed][figure]), float(of["none", seed][figure]) / 5, (seed, figure))

    def test_the_table_has_its_columns_and_a_row_a_trial(self):
        self.assertEqual((self.whole / "results.csv").read_text().splitlines()[0], COLUMNS)
        self.assertEqual([(row["seed"], row["aid"]) for row in rows(self.whole)],
                         [("0", "none"), ("0", "hard"), ("1", "none"), ("1", "hard")])
        self.assertTrue(all(float(row["wall_s"]) > 0 for row in rows(self.whole)))

    def test_each_trials_scores_are_those_of_the_table(self):
        for row in rows(self.whole):
            folder = f"vessel_tracing/aid={row['aid']}/seed_{int(row['seed']):04}"
            scores = json.loads((self.whole / folder / "results.json").read_text())
            for name in COLUMNS.split(","):
                if row[name] and isinstance(scores[name], float):
                    self.assertAlmostEqual(float(row[name]), scores[name], delta=1e-5 * abs(scores[name]), msg=name)
                elif row[name]:
                    self.assertEqual(row[name], str(scores[name]), name)
                else:
                    self.assertIsNone(scores[name], name)

    def test_reports_need_nothing_but_themselves(self):
        for path in self.whole.rglob("report.html"):
            page = path.read_text()
            self.assertNotIn("<script", page)
            for target in re.findall(r"""(?:src|href)\s*=\s*["']([^"']*)|url\(([^)]*)\)|@import""", page):
                target = "".join(target)
                self.assertTrue(target.startswith(("data:", "#")), f"{path}: {target[:80]}")

    def test_an_independent_checker_finds_nothing_against_the_logs(self):
        logs = sorted(self.whole.rglob("trial.lcm"))
        check = subprocess.run([sys.executable, ROOT / "scripts" / "check_trial_log.py", *logs], capture_output=True,
                               text=True, timeout=300)
        self.assertEqual(check.returncode, 0, check.stdout + check.stderr)

    def test_shards_add_up_to_the_whole_by_logs_of_the_same_bytes_and_by_the_table(self):
        table = ""
        for part in (1, 2):
            out = self.base / f"part_{part}"
            self.trial(*STUDY, "--jobs", 1, "--shard", f"{part}/2", "--out", out, "--quiet")
            table += (out / "results.csv").read_text()
        for folder in FOLDERS:
            part = self.base / ("part_1" if folder.endswith("0") else "part_2")
            self.assertEqual((part / folder / "trial.lcm").read_bytes(), (self.whole / folder / "trial.lcm").read_bytes())
        without_time = lambda text: [re.sub(r",[^,]*(,[^,]*,[^,]*)$", r"\1", line) for line in text.splitlines()
                                     if not line.startswith("scenario,")]
        self.assertEqual(without_time(table), without_time((self.whole / "results.csv").read_text()))


class OtherCalls(TrialCase):
    def test_a_failed_verdict_is_status_1_and_the_video_holds_what_the_camera_saw(self):
        out = self.folder / "out"
        process = self.run_trial(TRACING, *small(aid="hard", duration_s=2, fault__kind="blackout", fault__at_s=0.5,
                                                 fault__for_s=1, fault__must="go_on"), "--video", "--out", out)
        self.assertEqual(process.returncode, 1, process.stderr)
        self.assertIn("of 1 trials 1 failed", process.stderr.splitlines()[-1])
        self.assertIn("FAILED", process.stdout)
        trial = out / "vessel_tracing" / "seed_0000"
        frames = sum(channel == "RETINA_POSE" for _, channel, _ in lcm_log.read(trial / "trial.lcm"))
        video = cv2.VideoCapture(str(trial / "video.mkv"))
        seen = 0
        while video.read()[0]:
            seen += 1
        self.assertGreater(frames, 300)  # 30 a second
        self.assertLessEqual(abs(seen - frames), 1)  # the last one is still being processed

    def test_without_logs_scores_and_reports_are_kept(self):
        out = self.folder / "out"
        self.assertEqual(self.trial(TRACING, *settings(aid="none", duration_s=1), "--no-logs", "--quiet", "--seed", 7,
                                    "--out", out), "")
        self.assertEqual(files(out), ["report.html", "results.csv", "vessel_tracing/seed_0007/report.html",
                                      "vessel_tracing/seed_0007/results.json"])

    def test_an_independent_checker_finds_nothing_against_an_automated_laser(self):
        out = self.folder / "out"
        self.trial(SCENARIOS / "laser_rings.yaml", *settings(aid="automated", duration_s=3), "--quiet", "--out", out)
        check = subprocess.run([sys.executable, ROOT / "scripts" / "check_trial_log.py", "--json", out / "checked.json",
                                out / "laser_rings/seed_0000/trial.lcm"], capture_output=True, text=True, timeout=300)
        self.assertEqual(check.returncode, 0, check.stdout + check.stderr)
        found = json.loads((out / "checked.json").read_text())["summary"]
        row, = rows(out)
        self.assertGreater(found["pulses"], 3)
        self.assertEqual((found["pulses"], found["far"]), (int(row["fired"]), int(row["far_pulses"])))

    def test_each_shipped_failure_does_what_must_happen(self):
        out = self.folder / "out"
        failures = sorted(SCENARIOS.glob("fault_*.yaml"))
        self.assertGreater(len(failures), 3)
        self.trial(*failures, *small(), "--no-logs", "--quiet", "--out", out)  # status 0: no verdict failed
        held = {row["scenario"]: int(row["hold_events"]) for row in rows(out)}
        self.assertEqual(held, {path.stem: int("must: hold" in path.read_text()) for path in failures})

    def test_a_trial_that_cannot_run_is_one_line_and_the_others_go_on(self):
        lost = self.scenario("lost.yaml", "task: trace\naid: none\nretina: nothing.png\n")
        good = self.scenario("good.yaml", "task: trace\naid: none\nduration_s: 1\n")
        process = self.run_trial(lost, good, "--out", self.folder / "out", "--quiet")
        self.assertEqual(process.returncode, 1)
        self.assertEqual([row["scenario"] for row in rows(self.folder / "out")], ["good"])
        lines = process.stderr.splitlines()
        self.assertEqual(len(lines), 2, process.stderr)
        self.assertIn("lost, seed 0: ", lines[0])
        self.assertIn("nothing", lines[0])
        self.assertIn("1 could not be run", lines[1])

    def interrupted(self, enough):
        """Sends SIGINT once enough() holds; the process, ended."""
        process = subprocess.Popen([PROGRAMS / "eyeslam-trial", TRACING, *small(aid="none hard", duration_s=600),
                                    "--jobs", "1", "--out", self.folder / "out"], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        until = time.monotonic() + 120
        while not enough() and time.monotonic() < until:
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        process.output, process.error = process.communicate(timeout=60)
        return process

    def test_ctrl_c_keeps_finished_trials_and_says_so(self):
        process = self.interrupted(lambda: (self.folder / "out/vessel_tracing/aid=none/seed_0000").exists())
        self.assertEqual(process.returncode, 1, process.error)
        self.assertIn("interrupted; 1 of 2 trials", process.error)
        self.assertIn("interrupted; 1 of 2 trials", (self.folder / "out/report.html").read_text())
        self.assertEqual([row["aid"] for row in rows(self.folder / "out")], ["none"])
        self.assertEqual([name for name in files(self.folder / "out") if "none" not in name], ["report.html", "results.csv"])

    def test_ctrl_c_before_anything_was_done_leaves_nothing(self):
        process = self.interrupted(lambda: True)
        self.assertNotEqual(process.returncode, 0)
        self.assertEqual(files(self.folder), [])


class Scenarios(TrialCase):
    def test_every_shipped_scenario_reads_and_its_whole_configuration_reads_back_to_the_same(self):
        shipped = sorted(SCENARIOS.glob("*.yaml"))
        self.assertGreaterEqual(len(shipped), 9)
        for path in shipped:
            whole = self.trial(path, "--dump-config")
            again = self.trial(self.scenario(path.name, whole), "--dump-config")
            self.assertEqual(again, whole, path)

    def test_every_key_is_explained(self):
        explained = self.trial("--dump-config=markdown")
        for key in ("aid", "motion", "fault.must", "laser.map_s", "prescription.pattern.kind", *SMALL):
            self.assertIn(f"`{key}`", explained)

    def test_wrong_scenarios_are_refused_by_name_of_the_key(self):
        for text, words in (("aidd: hard\n", ("aidd",)), ("duration_s: long\n", ("duration_s", "long")),
                            ("duration_s: -1\n", ("duration_s", "-1")), ("motion: wild\n", ("motion", "wild", "in_situ")),
                            ("task: trace\naid: automated\n", ("aid", "automated", "hard")),
                            ("task: laser\naid: hard\n", ("aid", "hard", "automated")),
                            ("aid: none\nfault: {kind: blackout}\n", ("fault.kind", "blackout")),
                            ("fault: {kindd: blackout}\n", ("fault.kindd",)), ("aid: [hard\n", ("wrong.yaml",))):
            line = self.refusal(2, self.scenario("wrong.yaml", text), "--out", self.folder / "out")
            for word in words:
                self.assertIn(word, line, text)
        self.assertEqual(files(self.folder), ["wrong.yaml"])

    def test_wrong_calls_are_refused_in_one_line_that_names_the_option(self):
        out = ("--out", self.folder / "out")
        same = self.scenario("vessel_tracing.yaml", "task: trace\n")
        for arguments, word in (((*out,), "SCENARIO"), ((TRACING,), "--out"), ((TRACING, *out, "--shard", "0/2"), "--shard"),
                                ((TRACING, *out, "--shard", "3/2"), "--shard"), ((TRACING, *out, "--shard", "1"), "--shard"),
                                ((TRACING, *out, "--shard", "1/x"), "--shard"), ((TRACING, *out, "--seeds", "0"), "--seeds"),
                                ((TRACING, *out, "--seeds", "2", "--seed", "1"), "--seed"),
                                ((TRACING, *out, "--seed", "-1"), "--seed"), ((TRACING, *out, "--jobs", "0"), "--jobs"),
                                ((TRACING, *out, "--set", "aid"), "--set"), ((TRACING, *out, "--set", "no.such=1"), "no.such"),
                                ((TRACING, *out, "--video", "--no-logs"), "--video"), ((TRACING, same, *out), str(same)),
                                ((self.folder / "none.yaml", *out), "none.yaml"), ((TRACING, *out, "--fast"), "--fast"),
                                ((TRACING, "--dump-config=xml"), "--dump-config"), (("--dump-config",), "SCENARIO")):
            self.assertIn(word, self.refusal(2, *arguments), arguments)
        self.assertFalse((self.folder / "out").exists())

    def test_a_folder_that_cannot_be_written_is_said_before_the_first_trial(self):
        (self.folder / "file").write_text("")
        self.assertIn("file", self.refusal(1, TRACING, "--out", self.folder / "file"))


if __name__ == "__main__":
    unittest.main()
