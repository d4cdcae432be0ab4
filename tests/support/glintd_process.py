# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""A glintd of a test's own, on a simulated corridor."""
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "clients", "python"))


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class GlintdProcess:
    """Runs until the end of its `with`; start() and stop() may be called in between, at the same place."""

    def __init__(self, glintd, source="synth:corridor,seed=3", **settings):
        self.directory = tempfile.TemporaryDirectory(prefix="glint-client-")
        self.port = free_port()
        self.tcp = f"127.0.0.1:{self.port}"
        self.unix = os.path.join(self.directory.name, "glintd.sock")
        self.log = os.path.join(self.directory.name, "log")
        self.command = [glintd, "--config", "/dev/null", "--source", source]
        defaults = {"server.listen": self.tcp, "server.unix_socket": self.unix,
                    "state.directory": os.path.join(self.directory.name, "state")}
        for key, value in {**defaults, **settings}.items():
            self.command += ["--set", f"{key}={value}"]
        self.process = None

    def start(self):
        with open(self.log, "a") as log:
            self.process = subprocess.Popen(self.command, stderr=log)
        deadline = time.monotonic() + 20
        while True:
            try:
                socket.create_connection(("127.0.0.1", self.port), 1).close()
                return
            except OSError:
                assert self.process.poll() is None and time.monotonic() < deadline, open(self.log).read()
                time.sleep(0.05)

    def stop(self, number=signal.SIGTERM):
        self.process.send_signal(number)
        code = self.process.wait(30)
        self.process = None
        return code

    def __enter__(self):
        self.start()
        return self

    def __exit__(self, *_):
        if self.process is not None:
            self.stop(signal.SIGKILL)
        self.directory.cleanup()


def await_status(client, holds, timeout_s=60):
    """The first status for which `holds`."""
    deadline = time.monotonic() + timeout_s
    while True:
        status = client.get_status()
        if holds(status):
            return status
        assert time.monotonic() < deadline, status
        time.sleep(0.1)
