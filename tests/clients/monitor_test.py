# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""`glint watch --monitor` on a terminal of its own.

usage: monitor_test.py GLINT GLINTD
"""
import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import termios
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "support"))
from glintd_process import GlintdProcess

GLINTD, GLINT = sys.argv.pop(), sys.argv.pop()
ENTER, LEAVE = "\x1b[?1049h\x1b[?25l", "\x1b[?25h\x1b[?1049l"


class Monitor:
    """The program on a terminal of so many columns and rows."""

    def __init__(self, target, columns=110, rows=40):
        self.master, self.slave = pty.openpty()
        self.resize(columns, rows)
        self.before = termios.tcgetattr(self.slave)
        # A session of its own, whose terminal this is: what a resize and Ctrl-C need.
        self.process = subprocess.Popen([GLINT, "watch", "--monitor", "--connect", target], stdin=self.slave,
                                        stdout=self.slave, stderr=self.slave, start_new_session=True,
                                        preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0))
        self.seen = ""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        os.close(self.master)
        os.close(self.slave)

    def resize(self, columns, rows):
        fcntl.ioctl(self.slave, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def read(self, seconds=0.2):
        deadline = time.monotonic() + seconds
        while select.select([self.master], [], [], max(0.0, deadline - time.monotonic()))[0]:
            self.seen += os.read(self.master, 65536).decode()
            if time.monotonic() > deadline:
                break

    def frame(self):
        """The lines of the last whole picture."""
        frames = re.findall(r"\x1b\[H((?:(?!\x1b\[H).)*)\x1b\[J", self.seen, re.S)
        return frames[-1].replace("\x1b[K", "").split("\r\n") if frames else []

    def await_frame(self, holds, seconds=20):
        deadline = time.monotonic() + seconds
        while not holds(self.frame()):
            assert time.monotonic() < deadline, self.frame()
            self.read()
        return self.frame()

    def leave(self):
        """The exit code, once the program was asked to go."""
        code = self.process.wait(10)
        self.read()
        return code


def shows(pattern):
    return lambda frame: any(re.search(pattern, line) for line in frame)


class MonitorTest(unittest.TestCase):
    def test_it_shows_how_the_daemon_fares_and_outlives_it(self):
        with GlintdProcess(GLINTD) as daemon, Monitor(daemon.tcp) as monitor:
            frame = monitor.await_frame(shows(r"^rates     \d{3,} lidar and \d{2,} IMU packets, \d+\.\d scans"))
            self.assertTrue(monitor.seen.startswith(ENTER))
            for pattern in (r"^state     TRACKING, pose \d+ ms old", r"^pose      \[-?\d", r"^sensor    RUNNING \(synth:",
                            r"^losses    \w+", r"^queues    packets \d+/256 \(0 dropped\)", r"^load      \w+ left out$",
                            r"^map       [1-9]\d* points in \d+ tiles", r"^loops     \d+ accepted", r"^ {10}decode  .*\d\.\d\d$"):
                self.assertTrue(shows(pattern)(frame), (pattern, frame))
            subprocess.run([GLINT, "save", "seen", "--connect", daemon.tcp], check=True, stdout=subprocess.DEVNULL)
            monitor.await_frame(shows(r"^  \d\d:\d\d:\d\d  job      save_map 1 done"))
            monitor.resize(40, 5)
            small = monitor.await_frame(lambda frame: len(frame) == 5)
            self.assertLessEqual(max(len(line) for line in small), 40)
            monitor.resize(110, 40)
            daemon.stop()
            monitor.await_frame(shows("^NOT CONNECTED: .*glintd at " + daemon.tcp))
            daemon.start()
            monitor.await_frame(lambda frame: shows("^state     TRACKING")(frame) and not shows("NOT CONN")(frame))

    def test_the_terminal_is_as_before_however_it_is_left(self):
        with GlintdProcess(GLINTD) as daemon:
            for leave in ("key", "interrupt", "terminate"):
                with self.subTest(leave=leave), Monitor(daemon.unix) as monitor:
                    monitor.await_frame(shows("^state "))
                    self.assertNotEqual(monitor.before, termios.tcgetattr(monitor.slave))
                    if leave == "terminate":
                        monitor.process.send_signal(signal.SIGTERM)
                    else:
                        os.write(monitor.master, b"q" if leave == "key" else b"\x03")
                    self.assertEqual(0, monitor.leave())
                    self.assertTrue(monitor.seen.endswith(LEAVE), monitor.seen[-50:])
                    self.assertEqual(monitor.before, termios.tcgetattr(monitor.slave))

    def test_without_a_terminal_it_says_so(self):
        run = subprocess.run([GLINT, "watch", "--monitor"], capture_output=True, text=True, stdin=subprocess.DEVNULL)
        self.assertEqual(2, run.returncode)
        self.assertIn("--monitor needs a terminal", run.stderr)
        self.assertEqual("", run.stdout)


if __name__ == "__main__":
    unittest.main()
