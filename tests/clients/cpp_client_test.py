# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""The C++ client against a real glintd: it gets what the Python client gets, and the README's example runs.

usage: cpp_client_test.py GLINTD CPP_CLIENT_CHECK COMPILER
"""
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "support"))
from glintd_process import ROOT, GlintdProcess, await_status
from glint_client import Client

COMPILER, CHECK, GLINTD = sys.argv.pop(), sys.argv.pop(), sys.argv.pop()


class CppClient(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.daemon = GlintdProcess(GLINTD)
        cls.daemon.start()
        cls.client = Client(cls.daemon.tcp)
        await_status(cls.client, lambda status: status["map"]["points"] > 60000)  # Several pages.

    @classmethod
    def tearDownClass(cls):
        cls.client.close()
        cls.daemon.__exit__()

    def test_it_gets_what_the_python_client_gets(self):
        self.client.pause()  # Nothing is added to the map meanwhile.
        await_status(self.client, lambda status: status["state"] == "PAUSED" and status["queues"]["keyframes"]["size"] == 0)
        try:
            for target in (self.daemon.tcp, self.daemon.unix):
                run = subprocess.run([CHECK, target, "ask"], capture_output=True, text=True, timeout=30)
                self.assertEqual(0, run.returncode, run.stderr)
                self.compare(json.loads(run.stdout))
        finally:
            self.client.resume()

    def compare(self, got):
        self.assertEqual(self.client.hello["instance"], got["instance"])
        pose = self.client.get_pose("odom")
        self.assertEqual({"state": "PAUSED", "t_ns": pose["t_ns"], "p_m": pose["p_m"], "q": pose["q_xyzw"]}, got["pose"])
        whole = self.client.get_map()
        points = whole.points().astype(float)
        self.assertEqual((whole.count, whole.revision), (got["map"]["points"], got["map"]["revision"]))
        self.assertAlmostEqual((points[:, 0] + 2 * points[:, 2]).sum(), got["map"]["sum_m"], places=3)
        self.assertEqual(got["map"], got["updated"])
        self.assertEqual(self.client.get_map(voxel_m=2.0).count, got["coarse"]["points"])
        self.assertEqual({"number": -32602, "code": "", "field": "frame"}, got["bad_frame"])
        self.assertEqual({"number": -32005, "code": "NO_SUCH_MAP", "field": "name"}, got["no_map"])

    def test_it_connects_anew(self):
        with GlintdProcess(GLINTD) as daemon:
            with subprocess.Popen([CHECK, daemon.tcp, "follow"], stdout=subprocess.PIPE, text=True) as follower:
                self.assertRegex(follower.stdout.readline(), r'^"\d+\.\d{9}"$')
                daemon.stop()
                daemon.start()
                for line in follower.stdout:
                    if line.startswith("reconnected"):
                        self.assertEqual("reconnected 1\n", line)
                        break
                else:
                    self.fail(f"it ended with {follower.wait()}")
                self.assertRegex(follower.stdout.readline(), r'^"\d+\.\d{9}"$')
                follower.terminate()

    def test_a_daemon_that_is_not_there_is_named(self):
        run = subprocess.run([CHECK, "127.0.0.1:1", "ask"], capture_output=True, text=True, timeout=30)
        self.assertEqual(1, run.returncode)
        self.assertIn("glintd at 127.0.0.1:1 cannot be reached: Connection refused", run.stderr)

    def test_the_example_of_the_readme(self):
        with open(os.path.join(ROOT, "README.md")) as file:
            example = re.search(r"^    #include <glint_client.hpp>.*?^    }\n", file.read(), re.S | re.M).group()
        with tempfile.TemporaryDirectory(prefix="glint-example-") as directory:
            source, program = os.path.join(directory, "example.cpp"), os.path.join(directory, "example")
            with open(source, "w") as file:
                file.write(example.replace("127.0.0.1:7788", self.daemon.tcp))
            subprocess.run([COMPILER, "-std=c++17", "-Wall", "-Wextra", "-Wpedantic", "-Werror",
                            "-I" + os.path.join(ROOT, "clients", "cpp"), source, "-o", program], check=True)
            with subprocess.Popen([program], stdout=subprocess.PIPE, text=True) as run:
                lines = [run.stdout.readline() for _ in range(4)]
                run.terminate()
        self.assertRegex(lines[0], r"^(TRACKING|PAUSED) [1-9]\d*\n$")
        for line in lines[1:]:
            self.assertRegex(line, r'^"\d+\.\d{9}" \[.*,.*,.*\]\n$')


if __name__ == "__main__":
    unittest.main()
