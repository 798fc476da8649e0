# SPDX-License-Identifier: GPL-3.0-or-later
"""A live run, logged by lcm-logger, and its tracker again from the video beside the log.
live_replay_test.py PROGRAM_FOLDER."""
import json
import shutil
import signal
import subprocess
import unittest

from live_case import LiveCase

SECONDS = 5


class LiveLog(LiveCase):
    def log_and_video(self):
        """Of a live eye and the tracker that watches it."""
        log, video = self.path("live.lcm"), self.path("live.mkv")
        logger = subprocess.Popen(["lcm-logger", "-q", "-f", f"--lcm-url={self.url}&recv_buf_size=2000000", log],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(logger.kill)
        eye = self.start("eyeslam-sim", "--live", "--size", "320x240", "--seed", "4", "--shm", self.shm, "--lcm", self.url,
                         "--duration", str(SECONDS))
        tracker = self.start("eyeslam-track", f"shm:{self.shm}", "--out", self.path("out"), "--lcm", self.url, "--no-overlay",
                             "--record", video, "--timeout", "5", "--quiet")
        self.assertEqual(eye.process.wait(timeout=60), 0, eye.text())
        self.assertEqual(tracker.process.wait(timeout=60), 0, tracker.text())
        logger.send_signal(signal.SIGINT)
        logger.wait(timeout=10)
        return log, video

    @unittest.skipUnless(shutil.which("lcm-logger"), "lcm-logger (Debian: liblcm-bin) is not installed")
    def test_the_tracker_of_a_real_time_log_says_the_same_again(self):
        log, video = self.log_and_video()
        result = self.path("replay.json")
        replay = self.call("eyeslam-replay", log, "--video", video, "--only", "tracker", "--quiet", "--json", result,
                           seconds=120)
        self.assertEqual(replay.returncode, 0, replay.stdout + replay.stderr)
        with open(result) as file:
            replayed = json.load(file)
        channels = {channel["name"]: channel for channel in replayed["channels"]}
        for name in ("RETINA_POSE", "TOOL_TIP", "VESSEL_MAP"):
            self.assertGreater(channels[name]["compared"], 15 * SECONDS, name)  # of 30 a second; some may be lost
            self.assertEqual(channels[name]["identical"], channels[name]["compared"], name)
        self.assertLess(abs(replayed["video"]["offset_frames"]), 0.5)
        # Nobody moved the manipulator: its servo is missed by name.
        self.assert_refused(self.call("eyeslam-replay", log, "--only", "servo"), 1, "eyeslam-servo", log)


if __name__ == "__main__":
    unittest.main()
