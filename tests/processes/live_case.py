# SPDX-License-Identifier: GPL-3.0-or-later
"""A test case that runs the live programs together: PROGRAM_FOLDER is the first argument."""
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

FOLDER = sys.argv.pop(1) if len(sys.argv) > 1 else "."


class Running:
    """A program whose lines are read while it runs."""

    started = []  # those of the test at hand, whose lines tell together why one did not come

    def __init__(self, name, *arguments):
        self.started.append(self)
        self.name = name
        self.lines = []
        self.process = subprocess.Popen([os.path.join(FOLDER, name), *arguments], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, bufsize=1)
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        for line in self.process.stdout:
            self.lines.append(line.rstrip("\n"))

    def tell(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def text(self):
        return f"{self.name}:\n" + "\n".join(self.lines)

    def expect(self, pattern, seconds=30, since=0):
        """The first line from number `since` on that matches; the test fails when none comes."""
        end = time.monotonic() + seconds
        while True:
            for line in self.lines[since:]:
                found = re.search(pattern, line)
                if found:
                    return found
            if time.monotonic() > end or (self.process.poll() is not None and not self.reader.is_alive()):
                raise AssertionError(f"no line with '{pattern}' from {self.name} in {seconds} s\n" +
                                     "\n".join(program.text() for program in self.started))
            time.sleep(0.02)

    def end(self, number=signal.SIGINT, seconds=30):
        """Ends it by a signal; the exit status."""
        if self.process.poll() is None:
            self.process.send_signal(number)
        status = self.process.wait(timeout=seconds)
        self.reader.join(timeout=5)
        return status


class LiveCase(unittest.TestCase):
    def setUp(self):
        Running.started.clear()
        self.folder = tempfile.mkdtemp(prefix="eyeslam_live_test_")
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        # A group of its own for each test: others may run beside it.
        number = (os.getpid() * 7 + abs(hash(self.id())) % 5000) % 40000
        self.url = f"udpm://239.255.76.67:{20000 + number}?ttl=0"
        self.shm = f"eyeslam_test_{os.getpid()}_{number}"

    def path(self, name):
        return os.path.join(self.folder, name)

    def start(self, name, *arguments):
        running = Running(name, *arguments)
        self.addCleanup(self.kill, running)
        return running

    @staticmethod
    def kill(running):
        if running.process.poll() is None:
            running.process.kill()
            running.process.wait()
        for stream in (running.process.stdin, running.process.stdout):
            stream.close()

    def call(self, name, *arguments, lines="", seconds=60):
        return subprocess.run([os.path.join(FOLDER, name), *arguments], input=lines, capture_output=True, text=True,
                              timeout=seconds)

    def assert_refused(self, process, status, *named):
        self.assertEqual(process.returncode, status, process.stdout + process.stderr)
        lines = [line for line in process.stderr.splitlines() if "unsigned" not in line]
        self.assertEqual(len(lines), 1, process.stderr)
        for name in named:
            self.assertIn(name, lines[0])
