# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""What bash offers behind `glint` and `glintd`, against what --help says.

usage: completion_test.py GLINT GLINTD
"""
import os
import re
import subprocess
import sys
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
GLINTD, GLINT = sys.argv.pop(), sys.argv.pop()


def offered(*words):
    """What may be in place of the last of `words`."""
    script = ('. "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _glint; printf "%s\\n" "${COMPREPLY[@]}"')
    completion = os.path.join(ROOT, "daemon", "cli", "completion.bash")
    run = subprocess.run(["bash", "-c", script, "bash", completion, *words], capture_output=True, text=True, cwd=ROOT)
    assert run.stderr == "", run.stderr
    return run.stdout.split()


def help_of(*words):
    return subprocess.run([*words, "--help"], capture_output=True, text=True, check=True).stdout


class Completion(unittest.TestCase):
    def test_every_command_and_option_is_offered(self):
        commands = re.findall(r"^  ([a-z-]+) ", help_of(GLINT).split("Subcommands:")[1], re.M)
        self.assertIn("status", commands)
        self.assertEqual(commands, offered(GLINT, ""))
        for program in [[GLINT, command] for command in commands] + [[GLINTD]]:
            options = re.findall(r"^  (?:-\w,)?(--[\w-]+)", help_of(*program), re.M)
            self.assertIn("--help", options)
            self.assertEqual(options, offered(*program, "--"), program)

    def test_what_is_begun_is_ended(self):
        self.assertEqual(["status"], offered(GLINT, "stat"))
        self.assertEqual(["--check-config"], offered(GLINTD, "--ch"))

    def test_values_are_offered(self):
        self.assertEqual(["map", "odom"], offered(GLINT, "watch", "--frame", ""))
        self.assertEqual(["sensor"], offered(GLINT, "pose", "--child", "s"))
        self.assertEqual(["README.md"], offered(GLINT, "config", "--config", "READ"))
        self.assertEqual(["README.md"], offered(GLINT, "replay", "READ"))
        self.assertIn("--json", offered(GLINT, "watch", "--json", "--"))


if __name__ == "__main__":
    unittest.main()
