# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases with logs of a live simulator, for the tests of eyeslam-replay."""
import json
import os
import shutil
import signal
import struct
import subprocess
import tempfile
import time
import unittest

import lcm_log
from live_case import FOLDER, LiveCase

SECONDS = 3
HEADER = struct.Struct(">qqqqq")  # of a message of ours: fingerprint, utime, utime_sent, seq, session
_live = []


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
