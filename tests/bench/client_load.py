#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""What a thousand clients cost the one that matters: how late a good client's poses are, alone and among the others.

Starts glintd on a simulated sensor at its own speed, once with a good client alone and once with --clients more that
are subscribed to poses at 10 Hz: of these some never read, some send junk and come back, some open and close without
end. `age` is from the arrival of a scan's last packet to its pose as text, `late` by how much more a pose took to the
good client's socket than the quickest one. Runs are interleaved; the figures are medians over the runs. Numbers of a busy machine say little: look at the ratio.
"""
from __future__ import annotations

import argparse
import json
import os
import pathlib
import resource
import selectors
import socket
import statistics
import subprocess
import tempfile
import threading
import time

SUBSCRIBE = b'{"jsonrpc":"2.0","id":1,"method":"subscribe","params":{"topics":["pose"],"rate_hz":10}}\n'


class Load(threading.Thread):
    """The other clients, in one thread: nothing of what comes is looked at."""

    def __init__(self, port: int, clients: int, deaf: int, junk: int, doors: int) -> None:
        super().__init__(daemon=True)
        self.address = ("127.0.0.1", port)
        self.counts = (clients - deaf - junk - doors, deaf, junk, doors)
        self.stop = threading.Event()
        self.connected = threading.Event()
        self.cpu_s = 0.0
        self.received = 0
        self.lost = 0

    def connect(self) -> socket.socket:
        return socket.create_connection(self.address, timeout=10)

    def subscribed(self) -> socket.socket:
        client = self.connect()
        client.sendall(SUBSCRIBE)
        client.setblocking(False)
        return client

    def run(self) -> None:
        good, deaf, junk, doors = self.counts
        selector = selectors.DefaultSelector()
        for _ in range(good):
            selector.register(self.subscribed(), selectors.EVENT_READ)
        silent = [self.subscribed() for _ in range(deaf)]
        self.connected.set()
        next_abuse = time.monotonic()
        begin_s = time.thread_time()
        while not self.stop.is_set():
            for key, _ in selector.select(0.05):
                data = key.fileobj.recv(1 << 16)
                self.received += data.count(b"\n")
                if not data:
                    self.lost += 1
                    selector.unregister(key.fileobj)
                    key.fileobj.close()
            if time.monotonic() < next_abuse:
                continue
            next_abuse += 0.2
            for _ in range(junk):
                with self.connect() as client:
                    client.sendall(b"GET / HTTP/1.1\r\n" + os.urandom(200) + b"\n")
            for _ in range(doors):
                self.connect().close()
        self.cpu_s = time.thread_time() - begin_s
        for client in silent:
            client.close()
        for key in list(selector.get_map().values()):
            key.fileobj.close()


def call(client: socket.socket, reader, method: str):
    client.sendall(json.dumps({"jsonrpc": "2.0", "id": 1, "method": method}).encode() + b"\n")
    while True:
        message = json.loads(reader.readline())
        if "id" in message:
            return message["result"]


def run(glintd: pathlib.Path, source: str, seconds: float, load: dict[str, int] | None, port: int) -> dict[str, float]:
    with tempfile.TemporaryDirectory() as directory:
        settings = [f"server.listen=127.0.0.1:{port}", "server.max_clients=2000", f"state.directory={directory}",
                    "metrics.listen="]
        daemon = subprocess.Popen([glintd, "--source", source, *(word for s in settings for word in ("--set", s))],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            for _ in range(100):
                try:
                    good = socket.create_connection(("127.0.0.1", port), timeout=20)
                    break
                except ConnectionRefusedError:
                    time.sleep(0.1)
            reader = good.makefile("rb")
            others = Load(port, **load) if load else None
            if others:
                others.start()
                others.connected.wait(60)
            time.sleep(5)
            before = sum(os.times()[:2])
            cpu_before = process_cpu_s(daemon.pid)
            good.sendall(SUBSCRIBE)
            ages_ms, offsets_ms, seqs = [], [], []
            end = time.monotonic() + seconds
            while time.monotonic() < end:
                message = json.loads(reader.readline())
                if message.get("method") != "pose":
                    continue
                params = message["params"]
                ages_ms.append(params["age_ms"])
                offsets_ms.append((time.time_ns() - params["t_host_ns"]) * 1e-6)
                seqs.append(params["seq"])
            cpu_s = process_cpu_s(daemon.pid) - cpu_before
            status = call(good, reader, "get_status")
            if others:
                others.stop.set()
                others.join()
            # A simulation's host clock is not this one's: what a pose came later than the quickest.
            ages_ms.sort()
            late_ms = sorted(offset - min(offsets_ms) for offset in offsets_ms)
            return {"poses": len(seqs), "missed": seqs[-1] - seqs[0] + 1 - len(seqs),
                    "age_p50_ms": ages_ms[len(ages_ms) // 2], "age_p99_ms": ages_ms[int(len(ages_ms) * 0.99)],
                    "late_p50_ms": late_ms[len(late_ms) // 2], "late_p99_ms": late_ms[int(len(late_ms) * 0.99)],
                    "odometry_mean_ms": status["stage_ms"]["total"]["mean"], "glintd_cpu": cpu_s / seconds,
                    "load_cpu": (others.cpu_s if others else sum(os.times()[:2]) - before) / seconds,
                    "load_poses_per_s": others.received / seconds if others else 0.0,
                    "load_lost": others.lost if others else 0,
                    "files": len(os.listdir(f"/proc/{daemon.pid}/fd")), **status["server"]}
        finally:
            daemon.terminate()
            daemon.wait(30)


def process_cpu_s(pid: int) -> float:
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("glintd", type=pathlib.Path)
    parser.add_argument("--source", default="synth:building")
    parser.add_argument("--clients", type=int, default=1000)
    parser.add_argument("--deaf", type=int, default=50, help="of them: never read")
    parser.add_argument("--junk", type=int, default=20, help="send junk, and come back")
    parser.add_argument("--doors", type=int, default=10, help="open and close without end")
    parser.add_argument("--seconds", type=float, default=30.0, help="a run")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--port", type=int, default=7899)
    arguments = parser.parse_args()
    hard = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(hard, 8192), hard))
    load = {name: getattr(arguments, name) for name in ("clients", "deaf", "junk", "doors")}
    runs = {"alone": [], "among": []}
    for _ in range(arguments.runs):
        for name, others in (("alone", None), ("among", load)):
            figures = run(arguments.glintd, arguments.source, arguments.seconds, others, arguments.port)
            runs[name].append(figures)
            print(name, json.dumps({key: round(value, 2) for key, value in figures.items()}), flush=True)
    for key in ("age_p50_ms", "age_p99_ms", "late_p50_ms", "late_p99_ms", "odometry_mean_ms", "glintd_cpu", "missed", "load_cpu"):
        alone, among = (statistics.median(figures[key] for figures in runs[name]) for name in ("alone", "among"))
        ratio = f", ratio {among / alone:.2f}" if alone > 0 else ""
        print(f"{key}: {alone:.2f} alone, {among:.2f} among {arguments.clients}{ratio}")


if __name__ == "__main__":
    main()
