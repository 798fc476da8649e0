# SPDX-License-Identifier: GPL-3.0-or-later
"""eyeslam-replay on trials that were filmed: the tracker again, another video, pictures drawn over, many logs at a time.
replay_video_test.py PROGRAM_FOLDER."""
import csv
import io
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

import lcm_log
from trial_case import PROGRAMS, ROOT, TRACING, TrialCase, small

TABLE = ROOT / "scripts/replay_table.py"
_filmed = []


def filmed():
    """A folder with log and video of each of two short trials, made once; not to be changed."""
    if not _filmed:
        folder = pathlib.Path(tempfile.mkdtemp(prefix="eyeslam_replay_video_test_"))
        unittest.addModuleCleanup(shutil.rmtree, folder, ignore_errors=True)
        subprocess.run([PROGRAMS / "eyeslam-trial", TRACING, "--seeds", "2", "--video", "--quiet", "--out", folder,
                        *small(aid="hard", duration_s=1)], check=True, timeout=600)
        _filmed.append(folder)
    return sorted(path.parent for path in _filmed[0].rglob("trial.lcm"))


class ReplayVideoCase(TrialCase):
    def replay(self, *arguments, status=0):
        done = subprocess.run([PROGRAMS / "eyeslam-replay", *map(str, arguments)], capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done

    def comparison(self, *arguments, status=0):
        self.replay(*arguments, "--only", "tracker", "--quiet", "--json", self.folder / "replay.json", status=status)
        replay = json.loads((self.folder / "replay.json").read_text())
        return replay["video"], {channel["name"]: channel for channel in replay["channels"]}


class OneVideo(ReplayVideoCase):
    def test_the_tracker_says_the_same_bytes_again(self):
        log = filmed()[0] / "trial.lcm"
        recorded = [event[1] for event in lcm_log.read(log)]
        video, channels = self.comparison(log)
        for name in ("RETINA_POSE", "TOOL_TIP", "VESSEL_MAP"):
            self.assertEqual(channels[name]["compared"], recorded.count(name))
            self.assertEqual(channels[name]["identical"], recorded.count(name))
        self.assertEqual(video["tracked_again"], recorded.count("RETINA_POSE"))
        self.assertLess(abs(video["offset_frames"]), 0.5)
        self.assertEqual(video["warnings"], [])
        self.assertEqual(self.replay(log).stderr.count("differ"), 0)

    def test_another_video_is_found_out_by_its_name(self):
        here, other = filmed()
        _, channels = self.comparison(here / "trial.lcm", "--video", other / "video.mkv", status=1)
        self.assertLess(channels["RETINA_POSE"]["identical"], channels["RETINA_POSE"]["compared"])

    def test_a_video_that_begins_later_is_told_and_taken_as_it_is_said_to_be(self):
        late = self.folder / "late.mkv"
        subprocess.run(["ffmpeg", "-v", "error", "-i", filmed()[0] / "video.mkv", "-vf", "select=gte(n\\,7),setpts=PTS-STARTPTS",
                        "-c:v", "huffyuv", "-pix_fmt", "bgr0", late], check=True, timeout=120)
        video, _ = self.comparison(filmed()[0] / "trial.lcm", "--video", late, status=1)
        self.assertAlmostEqual(video["offset_frames"], 7.0, delta=0.5)
        self.assertTrue(video["offset_certain"])
        self.assertTrue(any("frames off" in line for line in video["warnings"]), video["warnings"])
        video, _ = self.comparison(filmed()[0] / "trial.lcm", "--video", late, "--offset", 7 / 30, status=1)
        self.assertLess(abs(video["offset_frames"]), 0.5)
        self.assertEqual((video["shift_frames"], video["poses_without_picture"]), (7, 7))
        self.assertAlmostEqual(video["advised_offset_s"], 7 / 30, delta=0.5 / 30)

    def test_a_what_if_of_the_tracker_is_another_servo(self):
        log = filmed()[0] / "trial.lcm"
        changed = ("--set", "vision.tracker.frame.scale=0.5")
        told = self.replay(log, *changed, "--json", self.folder / "what_if.json", status=1)
        self.assertIn("RETINA_POSE", told.stdout)
        channels = {channel["name"]: channel for channel in json.loads((self.folder / "what_if.json").read_text())["channels"]}
        self.assertLess(channels["MICRON_COMMAND"]["identical"], channels["MICRON_COMMAND"]["compared"])

    def test_everything_is_drawn_over_it(self):
        for name in ("overlay.mp4", "overlay.mkv"):
            self.replay("overlay", filmed()[0] / "trial.lcm", "--from", "8", "--to", "9", "--out", self.folder / name)
            told = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of",
                                   "csv=p=0", self.folder / name], capture_output=True, text=True, check=True).stdout
            self.assertAlmostEqual(int(told.strip().strip(",")), 30, delta=1)

    def test_a_damaged_number_of_a_pose_costs_its_picture_alone(self):
        events = list(lcm_log.read(filmed()[0] / "trial.lcm"))
        poses = [i for i, event in enumerate(events) if event[1] == "RETINA_POSE"]
        utime, channel, data = events[poses[40]]
        seq = int.from_bytes(data[24:32], "big") ^ 1 << 50
        events[poses[40]] = (utime, channel, data[:24] + seq.to_bytes(8, "big") + data[32:])
        lcm_log.write(self.folder / "flipped.lcm", events)
        self.replay("overlay", self.folder / "flipped.lcm", "--video", filmed()[0] / "video.mkv", "--to", "2",
                    "--out", self.folder / "overlay.mkv")

    def test_what_cannot_be_done_is_refused_in_one_line(self):
        alone = self.folder / "trial.lcm"
        shutil.copy(filmed()[0] / "trial.lcm", alone)
        text = self.folder / "text.mkv"
        text.write_text("no video\n")
        for status, words in ((2, [alone, "--only", "tracker"]), (2, ["overlay", alone, "--out", self.folder / "o.mp4"]),
                              (1, [alone, "--video", text]), (2, [alone, "--offset", "1"])):
            done = self.replay(*words, status=status)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertFalse((self.folder / "o.mp4").exists())

    def test_memory_does_not_grow_with_the_video(self):
        def peak(log):
            process = subprocess.Popen([PROGRAMS / "eyeslam-replay", log, "--only", "tracker", "--quiet", *cut])
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            self.assertEqual(process.returncode, 0)
            return usage.ru_maxrss / 1024
        cut = ("--to", "4")
        first = peak(filmed()[0] / "trial.lcm")
        cut = ()
        whole = peak(filmed()[0] / "trial.lcm")
        print(f"\n4 s: {first:.0f} MB, all: {whole:.0f} MB")
        self.assertLess(whole, first + 40)
        self.assertLess(whole, 300)


class ManyLogs(ReplayVideoCase):
    def table(self, folder, status=0):
        paths = sorted(folder.glob("*.json"))
        done = subprocess.run([TABLE, *paths], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, status, done.stderr)
        return list(csv.DictReader(io.StringIO(done.stdout)))

    def check(self, rows):
        self.assertEqual({row["log"].split("/")[-1] for row in rows}, {folder.name for folder in filmed()})
        self.assertGreater(sum(row["channel"] == "RETINA_POSE" for row in rows), 1)
        self.assertTrue(all(row["compared"] == row["identical"] for row in rows))

    def test_are_computed_by_gnu_parallel_into_one_table(self):
        if shutil.which("parallel") is None:
            self.skipTest("GNU parallel is not installed (Debian: parallel)")
        command = f"{PROGRAMS.resolve()}/eyeslam-replay {{}} --quiet --json {self.folder}/{{= s:/trial.lcm$::; s:.*/:: =}}.json"
        logs = [str(folder / "trial.lcm") for folder in filmed()]
        subprocess.run(["parallel", "--jobs", "2", command, ":::", *logs], check=True, capture_output=True, timeout=300)
        self.check(self.table(self.folder))
        (self.folder / "broken.json").write_text("{")
        self.table(self.folder, status=1)

    def test_are_computed_by_a_slurm_job_array(self):
        missing = [name for name in ("sbatch", "slurmctld", "slurmd", "munged") if shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin") is None]
        if missing:
            self.skipTest(f"{', '.join(missing)} not installed (Debian: slurm-wlm, munge)")
        from slurm_node import SlurmNode, SlurmCannotStart
        try:
            node = SlurmNode(self.folder / "slurm")
        except SlurmCannotStart as error:
            self.skipTest(f"slurmd cannot start here: {error}")
        self.addCleanup(node.stop)
        (self.folder / "logs.txt").write_text("".join(f"{folder}/trial.lcm\n" for folder in filmed()))
        (self.folder / "job.sh").write_text(
            "#!/bin/sh\n"
            f"log=$(sed -n \"${{SLURM_ARRAY_TASK_ID}}p\" {self.folder}/logs.txt)\n"
            f"exec {PROGRAMS.resolve()}/eyeslam-replay \"$log\" --quiet --json {self.folder}/$(basename $(dirname $log)).json\n")
        node.run_array(self.folder / "job.sh", len(filmed()))
        self.check(self.table(self.folder))


if __name__ == "__main__":
    unittest.main()
