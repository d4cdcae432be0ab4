# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""The Python client against a real glintd, and against servers that are none.

usage: glint_client_test.py GLINTD
"""
import array
import json
import os
import re
import socket
import ssl
import subprocess
import sys
import tempfile
import threading
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "support"))
from glintd_process import ROOT, GlintdProcess, await_status
import glint_client
from glint_client import Client, ConnectionLost, JobError, RequestError

GLINTD = sys.argv.pop(1)
HELLO = {"protocol": "1.0", "server": "test", "instance": "0", "map_epoch": 0, "max_line": 1 << 20, "features": []}


def line_of(**message):
    return (json.dumps({"jsonrpc": "2.0", **message}) + "\n").encode()


class FakeServer:
    """Sends each connection `first`, then what `answer(request)` gives for each line."""

    def __init__(self, first, answer=lambda request: None, tls=None):
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.target = f"127.0.0.1:{self.listener.getsockname()[1]}"
        self.first, self.answer, self.tls, self.requests = first, answer, tls, []
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        while True:
            try:
                connection, _ = self.listener.accept()
            except OSError:
                return
            threading.Thread(target=self.talk, args=(connection,), daemon=True).start()

    def talk(self, connection):
        try:
            if self.tls is not None:
                connection = self.tls.wrap_socket(connection, server_side=True)
            with connection, connection.makefile("rb") as lines:
                connection.sendall(self.first)
                for line in lines:
                    request = json.loads(line)
                    self.requests.append(request)
                    reply = self.answer(request)
                    if reply is None:
                        return
                    connection.sendall(line_of(id=request["id"], **reply))
        except OSError:
            pass  # The client has had enough.

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.listener.close()


def hello_line(**changes):
    return line_of(method="hello", params={**HELLO, **changes})


class OnGlintd(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.daemon = GlintdProcess(GLINTD)
        cls.daemon.start()
        cls.client = Client(cls.daemon.tcp)
        await_status(cls.client, lambda status: status["map"]["keyframes"] >= 3)

    @classmethod
    def tearDownClass(cls):
        cls.client.close()
        cls.daemon.__exit__()

    def test_every_method_of_the_daemon_has_one_here(self):
        methods = [name for name in self.client.hello["features"] if "." not in name]
        self.assertIn("get_pose", methods)
        elsewhere = {"unsubscribe", "authenticate"}  # A subscription is closed; a token goes to the constructor.
        self.assertEqual([], [name for name in methods if not hasattr(Client, name) and name not in elsewhere])

    def test_poses_of_now_of_a_time_and_of_soon(self):
        with Client(self.daemon.unix) as client:
            pose = client.get_pose("odom", "base")
            self.assertEqual(("odom", "base", 3), (pose["frame"], pose["child"], len(pose["p_m"])))
            self.assertTrue(client.get_pose("odom", at_ns=pose["t_ns"])["interpolated"])
            self.assertEqual(pose["t"], client.get_pose("odom", at=pose["t"])["t"])
            self.assertEqual(50, client.get_pose("odom", predict_ms=50)["predicted_ms"])
            past = client.get_trajectory(frame="odom")
            self.assertGreater(len(past), 3)
            later = client.get_trajectory(since_ns=past[1]["t_ns"], frame="odom")
            self.assertEqual(past[2], later[0])

    def test_errors_name_code_and_field(self):
        with self.assertRaises(RequestError) as raised:
            self.client.get_pose("nowhere")
        self.assertEqual((-32602, None, "frame"),
                         (raised.exception.number, raised.exception.code, raised.exception.field))
        with self.assertRaises(RequestError) as raised:
            self.client.load_map("none-of-this-name")
        self.assertEqual("NO_SUCH_MAP", raised.exception.code)
        self.assertEqual("TRACKING", self.client.get_status()["state"])

    def test_a_map_of_several_pages_is_whole(self):
        await_status(self.client, lambda status: status["map"]["points"] > 60000)
        self.client.pause()
        try:
            await_status(self.client,
                         lambda status: status["state"] == "PAUSED" and not status["queues"]["keyframes"]["size"])
            self.assertIn("next_cursor", self.client.call("get_map"))
            whole = self.client.get_map()
            self.assertEqual(self.client.get_status()["map"]["points"], whole.count)
            self.assertEqual(whole.count, len(set(map(bytes, whole.points()))))
        finally:
            self.client.resume()
            await_status(self.client, lambda status: status["state"] == "TRACKING")

    def test_the_map_follows_what_is_added(self):
        followed = self.client.get_map()
        self.assertEqual(followed.count, sum(len(tile) for tile in followed.tiles.values()))
        self.assertEqual(4, followed.points().shape[1])
        low = [16 * index for index in min(followed.tiles)]
        tile = followed.tiles[min(followed.tiles)]
        self.assertTrue((tile[:, :3] >= low).all() and (tile[:, :3] <= [edge + 16 for edge in low]).all())
        keyframes = self.client.get_status()["map"]["keyframes"]
        await_status(self.client, lambda status: status["map"]["keyframes"] > keyframes + 1)
        changed, _ = followed.update()
        self.assertTrue(changed)
        # The daemon goes on meanwhile: equal where nothing was added between the two questions.
        whole = self.client.get_map()
        if whole.revision == followed.revision:
            self.assertEqual(whole.count, followed.count)
        self.assertLess(self.client.get_map(voxel_m=2.0).count, whole.count // 4)
        x, y = (int(v) for v in self.client.get_pose("map")["p_m"][:2])
        near = self.client.get_map(region=((x - 2, y - 2, -9), (x + 2, y + 2, 9))).points()
        self.assertGreater(len(near), 0)
        self.assertTrue((abs(near[:, 0] - x) <= 2).all())

    def test_without_numpy_the_points_are_the_same(self):
        with_numpy = self.client.get_map(region=((-1, -9, -9), (0, 9, 9)))
        kept, glint_client.numpy = glint_client.numpy, None
        try:
            without = self.client.get_map(region=((-1, -9, -9), (0, 9, 9)))
            self.assertIsInstance(without.points(), array.array)
            if without.revision == with_numpy.revision:
                self.assertEqual(with_numpy.points().tobytes(), without.points().tobytes())
            self.assertEqual(4 * without.count, len(without.points()))
        finally:
            glint_client.numpy = kept

    def test_notifications_of_all_topics(self):
        with self.client.subscribe("pose", "status", "events", rate_hz=5) as subscription:
            self.assertEqual(5, subscription.settings["pose"]["rate_hz"])
            seen = set()
            deadline = time.monotonic() + 30
            self.client.wait_for(self.client.save_map("noted"))
            while seen < {"pose", "status", "event"} and time.monotonic() < deadline:
                seen.add(subscription.next(10).method)
            self.assertEqual({"pose", "status", "event"}, seen)
            self.assertEqual(0, subscription.missed)

    def test_maps_and_jobs(self):
        result = self.client.wait_for(self.client.save_map("office"))
        self.assertEqual("office", result["name"])
        self.assertIn("office", [saved["name"] for saved in self.client.list_maps()])
        self.assertEqual("office", self.client.delete_map("office")["deleted"])
        self.assertNotIn("office", [saved["name"] for saved in self.client.list_maps()])
        with self.assertRaises(ConnectionLost):
            self.client.wait_for({"id": 4711, "kind": "save_map"})

    def test_pause_and_resume(self):
        self.assertTrue(self.client.pause()["accepted"])
        await_status(self.client, lambda status: status["state"] == "PAUSED")
        self.client.resume()
        await_status(self.client, lambda status: status["state"] == "TRACKING")
        self.assertEqual("auto", self.client.get_config()["sensor"]["clock"])

    def test_the_example_of_the_readme(self):
        with open(os.path.join(ROOT, "README.md")) as file:
            readme = file.read()
        example = re.search(r"^    from glint_client import.*?\n\n", readme, re.S | re.M).group()
        example = re.sub("^    ", "", example, flags=re.M).replace("127.0.0.1:7788", self.daemon.tcp)
        environment = {**os.environ, "PYTHONPATH": os.path.join(ROOT, "clients", "python"), "PYTHONUNBUFFERED": "1"}
        with subprocess.Popen([sys.executable, "-c", example], stdout=subprocess.PIPE, text=True, env=environment) as run:
            lines = [run.stdout.readline() for _ in range(5)]
            run.terminate()
        self.assertRegex(lines[0], r"^TRACKING [1-9]\d*$")
        for line in lines[1:]:
            self.assertRegex(line, r"^\d+\.\d{9} \[.*\] 0$")


class Reconnecting(unittest.TestCase):
    def test_both_kinds_of_connection_outlive_a_restart(self):
        with GlintdProcess(GLINTD) as daemon:
            client = Client(daemon.tcp, wait_s=5)
            subscription = client.subscribe("pose", frame="odom")
            first = subscription.hello["instance"]
            self.assertEqual("pose", subscription.next(20).method)
            held = client.get_map()
            daemon.stop()
            with self.assertRaises(ConnectionLost):
                client.get_status()
            while subscription.next(0.2) is not None:  # What had come before.
                pass
            daemon.start()
            self.assertEqual("pose", subscription.next(30).method)
            self.assertEqual(1, subscription.reconnects)
            self.assertNotEqual(first, subscription.hello["instance"])
            self.assertIn("state", client.get_status())
            await_status(client, lambda status: status["map"]["points"] > 0)
            held.update()
            self.assertEqual(client.hello["instance"], held._instance)
            epoch = client.wait_for(client.clear_map())["map_epoch"]
            await_status(client, lambda status: status["map"]["points"] > 0)
            held.update()
            self.assertEqual(epoch, held.map_epoch)
            subscription.close()
            client.close()

    def test_a_daemon_that_is_not_there_is_named(self):
        with self.assertRaisesRegex(ConnectionLost, "127.0.0.1:1 cannot be reached"):
            Client("127.0.0.1:1")
        with self.assertRaisesRegex(ConnectionLost, "/nowhere/glintd.sock cannot be reached"):
            Client("/nowhere/glintd.sock")
        with self.assertRaisesRegex(ValueError, "neither HOST:PORT nor"):
            Client("localhost")


class OnOthers(unittest.TestCase):
    def test_what_is_no_glintd_is_refused(self):
        for first, why in ((b"SSH-2.0-OpenSSH\n", "no JSON"), (b"[]\n", "no JSON-RPC"), (b'{"method":"x"}\n', "no glintd"),
                           (hello_line(protocol="2.0"), "speaks protocol 2.0"), (b"x" * (2 << 20), "longer line")):
            with FakeServer(first) as server, self.assertRaisesRegex(ConnectionLost, why):
                Client(server.target)

    def test_one_client_too_many_is_busy_and_is_tried_again(self):
        refusal = {"code": -32003, "message": "full", "data": {"code": "BUSY"}}
        with FakeServer(line_of(id=None, error=refusal)) as server:
            with self.assertRaises(RequestError) as raised:
                Client(server.target)
            self.assertEqual("BUSY", raised.exception.code)
            threading.Timer(0.3, lambda: setattr(server, "first", hello_line())).start()
            Client(server.target, wait_s=10).close()

    def test_the_token_comes_first(self):
        def answer(request):
            good = request["method"] != "authenticate" or request["params"]["token"] == "open"
            refusal = {"code": -32004, "message": "no such token", "data": {"code": "FORBIDDEN"}}
            return {"result": {}} if good else {"error": refusal}
        with FakeServer(hello_line(authentication="token"), answer) as server:
            with Client(server.target, token="open") as client:
                client.get_status()
            self.assertEqual(["authenticate", "get_status"], [r["method"] for r in server.requests])
            with self.assertRaises(RequestError) as raised:
                Client(server.target, token="shut", wait_s=5)
            self.assertEqual("FORBIDDEN", raised.exception.code)
            server.first = hello_line()
            with Client(server.target, token="open") as client:  # Nobody is told who does not ask.
                client.call("get_config")
            self.assertEqual("get_config", server.requests[-1]["method"])
            self.assertEqual("authenticate", server.requests[-2]["method"])
            self.assertEqual("shut", server.requests[-2]["params"]["token"])

    def test_tls_is_spoken_with_who_shows_the_right_certificate(self):
        with tempfile.TemporaryDirectory(prefix="glint-tls-") as directory:
            key, certificate = os.path.join(directory, "key.pem"), os.path.join(directory, "certificate.pem")
            subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-keyout", key, "-out",
                            certificate, "-subj", "/CN=127.0.0.1", "-addext", "subjectAltName=IP:127.0.0.1"],
                           check=True, stderr=subprocess.DEVNULL)
            context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
            context.load_cert_chain(certificate, key)
            with FakeServer(hello_line(), lambda request: {"result": {"state": "INIT", "padding": "x" * 300000}}, context) as server:
                with Client(server.target, tls=certificate) as client:
                    self.assertEqual("INIT", client.get_status()["state"])
                with self.assertRaisesRegex(ConnectionLost, "CERTIFICATE_VERIFY_FAILED"):
                    Client(server.target, tls=ssl.create_default_context())

    def test_only_questions_are_asked_again(self):
        answers = iter([None, {"result": {"state": "INIT"}}, None])
        with FakeServer(hello_line(), lambda request: next(answers)) as server:
            with Client(server.target) as client:
                self.assertEqual("INIT", client.get_status()["state"])
                with self.assertRaisesRegex(ConnectionLost, "closed the connection"):
                    client.clear_map()
            self.assertEqual(["get_status", "get_status", "clear_map"], [r["method"] for r in server.requests])

    def test_images_and_metrics_are_taken_out_of_their_envelope(self):
        answers = {"get_image": {"kind": "range", "png": "iVBORw0KGgo="}, "get_metrics": {"text": "glint_poses_total 5\n"}}
        with FakeServer(hello_line(), lambda request: {"result": answers[request["method"]]}) as server:
            with Client(server.target) as client:
                self.assertEqual(b"\x89PNG\r\n\x1a\n", client.get_image("range"))
                self.assertEqual({"kind": "range"}, server.requests[0]["params"])
                self.assertEqual("glint_poses_total 5\n", client.get_metrics())

    def test_a_job_that_failed_is_an_error(self):
        job = {"id": 1, "kind": "save_map", "state": "failed", "progress": 0.5, "error": "the disk is full"}
        with FakeServer(hello_line(), lambda request: {"result": {"jobs": [job]}}) as server:
            with Client(server.target) as client, self.assertRaisesRegex(JobError, "save_map failed: the disk is full"):
                client.wait_for(job)

    def test_notifications_missed_are_summed(self):
        with FakeServer(hello_line(), lambda request: {"result": {"settings": {}}}) as server:
            with Client(server.target) as client, client.subscribe("pose") as subscription:
                for missed in (3, 5):
                    subscription._connection._input += line_of(method="pose", params={"missed": missed})
                    self.assertEqual(missed, subscription.next(1)["missed"])
                subscription._drop()
                self.assertEqual(5, subscription.missed)


if __name__ == "__main__":
    unittest.main()
