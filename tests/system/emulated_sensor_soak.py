# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""An emulated sensor of 128 beams at 20 Hz, for minutes, into the daemon.

usage: emulated_sensor_soak.py GLINT GLINTD CONFIG [--minutes N] [--beams N] [--ask-sensor]
First over a good line: the kernel drops nothing. Then over one that loses, reorders and doubles
packets, with a restart every minute, a clock jump and foreign packets: the daemon's counters are
those of the emulator's report, and tracking resumes. --ask-sensor has the daemon take metadata
from the sensor and set it, in place of reading a file.
"""
import argparse
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time

SCENARIO = """
[[event]]
at_s = {jump}
action = "clock_jump"
seconds = 3.0
[[event]]
at_s = {foreign}
every_s = 60.0
action = "foreign_packets"
count = 90
[[event]]
at_s = {restart}
every_s = 60.0
action = "restart"
"""


def free_port(kind):
    with socket.socket(socket.AF_INET, kind) as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Daemon:
    """glintd with a client of it."""

    def __init__(self, options, meta, sensor_port, directory):
        self.lidar, self.imu = free_port(socket.SOCK_DGRAM), free_port(socket.SOCK_DGRAM)
        tcp = free_port(socket.SOCK_STREAM)
        settings = {"sensor.lidar_port": self.lidar, "sensor.imu_port": self.imu,
                    "sensor.bind_address": "127.0.0.1", "sensor.source_address": "127.0.0.1",
                    "server.listen": f"127.0.0.1:{tcp}", "server.unix_socket": "",
                    "state.directory": os.path.join(directory, "state")}
        command = [options.glintd, "--config", options.config, "--source", "udp"]
        if options.ask_sensor:
            settings["sensor.host"] = f"127.0.0.1:{sensor_port}"
        else:
            command += ["--meta", meta]
        for key, value in settings.items():
            command += ["--set", f"{key}={value}"]
        self.log = open(os.path.join(directory, "glintd.log"), "w+")
        self.process = subprocess.Popen(command, stderr=self.log, stdout=self.log)
        self.stream = self.connect(tcp)

    def connect(self, tcp):
        deadline = time.monotonic() + 30
        while True:
            try:
                stream = socket.create_connection(("127.0.0.1", tcp), timeout=30).makefile("rw", newline="\n")
                assert json.loads(stream.readline())["method"] == "hello"
                return stream
            except ConnectionRefusedError:
                assert self.process.poll() is None and time.monotonic() < deadline, "glintd did not start"
                time.sleep(0.05)

    def status(self):
        self.stream.write('{"jsonrpc":"2.0","id":1,"method":"get_status","params":{}}\n')
        self.stream.flush()
        return json.loads(self.stream.readline())["result"]

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(timeout=60)
        self.log.seek(0)
        sys.stderr.write(self.log.read()[-4000:])
        assert code == 0, f"glintd ended with {code}"


def cpu_s(pid):
    with open(f"/proc/{pid}/stat") as stat:
        fields = stat.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def run(options, capture, meta, directory, seconds, line):
    """Emulates for so long. The daemon's last status, the report, and the states seen."""
    http = free_port(socket.SOCK_STREAM)
    daemon = Daemon(options, meta, http, directory)
    report = os.path.join(directory, "report.json")
    to = ["--imu-port", str(daemon.imu), "--to", f"127.0.0.1:{daemon.lidar}"]
    sensor = subprocess.Popen([options.glint, "emulate", capture, "--meta", meta, "--http", str(http), "--report",
                               report, "--seconds", str(seconds), *to, *line], stdout=subprocess.DEVNULL)
    states, cpu = [], 0.0
    while sensor.poll() is None:
        assert daemon.process.poll() is None, "glintd is gone"
        states.append(daemon.status()["state"])
        cpu = cpu_s(sensor.pid) if sensor.poll() is None else cpu
        time.sleep(0.5)
    assert sensor.returncode == 0, sensor.returncode
    time.sleep(3)  # The last scan leaves when nothing has come for a while.
    status = daemon.status()
    daemon.stop()
    done = json.load(open(report))
    print(f"  emulator: {100 * cpu / seconds:.1f} % of a core, worst lateness {done['worst_lateness_ms']:.1f} ms")
    print(f"  emulator: {json.dumps({k: done[k] for k in ('lidar', 'imu', 'foreign', 'cut_packets', 'scans')})}")
    print(f"  daemon:   {json.dumps(status['counters'])}")
    return status["counters"], done, states


def check_good_line(counters, done):
    assert counters["kernel_drops"] == 0, counters
    assert counters["received_packets"] == done["lidar"]["delivered"] + done["imu"]["delivered"]
    if counters["queue_drops"] + counters["early_packets"] == 0:
        assert counters["lidar_packets"] == done["lidar"]["sent"]
        assert counters["missing_packets"] <= done["cut_packets"]
    print(f"  zero kernel drops; {counters['queue_drops']} queue drops; {counters['scans']} scans")


def check_bad_line(counters, done, states, packets_per_scan):
    lidar, foreign, restarts = done["lidar"], done["foreign"], done["sensor"]["restarts"]
    # What the daemon itself dropped, for want of time or before it had metadata, is in no other counter.
    slack = counters["queue_drops"] + counters["early_packets"]

    def equal(name, seen, expected, tolerance=0):
        assert abs(seen - expected) <= tolerance + slack, f"{name}: {seen}, not {expected} +- {tolerance} (+ {slack})"

    assert counters["kernel_drops"] == 0, counters
    assert restarts >= 1 and done["clock_jumps"] == 1, done
    equal("lidar packets", counters["lidar_packets"], lidar["sent"] - lidar["lost"])
    equal("late and duplicate", counters["late_packets"] + counters["duplicate_packets"], lidar["duplicated"])
    # Those of a scan that a restart cut short may count or not.
    equal("never arrived", counters["missing_packets"], lidar["lost"], packets_per_scan * (restarts + 1))
    equal("wrong size", counters["bad_size"], foreign["size"])
    equal("other serial", counters["bad_serial"], foreign["serial"])
    equal("IMU packets", counters["imu_packets"], done["imu"]["delivered"])
    assert counters["foreign_packets"] == foreign["address"] + foreign["serial"], (counters, foreign)
    assert counters["sensor_restarts"] == restarts, (counters["sensor_restarts"], restarts)
    assert "TRACKING" in states[-8:] or "DEGRADED" in states[-8:], f"tracking has not resumed: {states[-40:]}"
    print(f"  {restarts} restarts; every counter as reported, {slack} dropped by the daemon itself; tracking resumed")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("glint")
    parser.add_argument("glintd")
    parser.add_argument("config")
    parser.add_argument("--minutes", type=float, default=10.0, help="of each line")
    parser.add_argument("--beams", type=int, default=128)
    parser.add_argument("--profile", default="RNG19_RFL8_SIG16_NIR16")
    parser.add_argument("--ask-sensor", action="store_true")
    parser.add_argument("--line", choices=["good", "bad", "both"], default="both")
    options = parser.parse_args()
    seconds = options.minutes * 60
    with tempfile.TemporaryDirectory(prefix="glint-soak-") as directory:
        world = os.path.join(directory, "world")
        # It stands still, so that the end of a loop is its beginning.
        subprocess.run([options.glint, "simulate", "--world", "room", "--seconds", "2", "--rest", "60", "--rate",
                        "20", "--beams", str(options.beams), "--profile", options.profile, "--out", world],
                       check=True, stdout=subprocess.DEVNULL)
        capture, meta = os.path.join(world, "capture.pcap"), os.path.join(world, "metadata.json")
        packets_per_scan = 64
        if options.line != "bad":
            print(f"a good line for {seconds:.0f} s")
            counters, done, _ = run(options, capture, meta, os.path.join(directory), seconds, [])
            check_good_line(counters, done)
        if options.line == "good":
            return
        print(f"a bad line for {seconds:.0f} s")
        scenario = os.path.join(directory, "scenario.toml")
        # Within a run shorter than a minute, too; the clock does not jump while the sensor restarts.
        with open(scenario, "w") as file:
            file.write(SCENARIO.format(jump=seconds / 4 + min(10.0, seconds / 20), foreign=seconds / 3, restart=min(30.0, seconds / 2)))
        line = ["--scenario", scenario, "--loss", "0.05", "--reordering", "0.05", "--duplicates", "0.02"]
        counters, done, states = run(options, capture, meta, directory, seconds, line)
        check_bad_line(counters, done, states, packets_per_scan)


if __name__ == "__main__":
    main()
