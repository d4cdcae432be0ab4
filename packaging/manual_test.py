# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""The manual page of glint names every command that `glint --help` does, and no other; each page formats cleanly.

usage: manual_test.py GLINT PAGE...
"""
import re
import shutil
import subprocess
import sys

glint, *pages = sys.argv[1:]
told = subprocess.run([glint, "--help"], check=True, capture_output=True, text=True).stdout.split("Subcommands:")[1]
commands = set(re.findall(r"^  ([a-z][a-z-]*) ", told, re.M))
assert len(commands) > 10, told
with open(next(page for page in pages if page.endswith("glint.1")), encoding="utf-8") as file:
    page = file.read().replace("\\-", "-")
named = set(re.findall(r"^\.TP\n\.B ([a-z][a-z-]*)$", page, re.M))
assert named == commands, f"only the program has {commands - named}, only the page {named - commands}"
if shutil.which("groff"):
    for page in pages:
        said = subprocess.run(["groff", "-man", "-ww", "-z", page], capture_output=True, text=True).stderr
        assert not said, said
