# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""Client of glintd: pose, status, map and commands over its JSON protocol, with nothing but Python's own library.

    from glint_client import Client
    glint = Client("127.0.0.1:7788")            # or the path of a Unix socket
    print(glint.get_pose()["state"])
    for pose in glint.subscribe("pose"):        # goes on when the daemon has been restarted
        print(pose["t"], pose.get("p_m"))

Results are the dictionaries that daemon/PROTOCOL.md describes; what is absent is unknown. A Client is for one thread,
and so is a Subscription, which has a connection of its own: the two may run in different threads.
"""
import array
import base64
import json
import select
import socket
import ssl
import sys
import time

try:
    import numpy
except ImportError:  # The map then comes as array.array.
    numpy = None

DEFAULT_TARGET = "127.0.0.1:7788"
PROTOCOL_MAJOR = "1"
_MAX_LINE_BYTES = 1 << 20  # Before hello has told.
_POINT_BYTES = 16
_FIRST_DELAY_S, _LONGEST_DELAY_S = 0.1, 5.0


class GlintError(Exception):
    """Whatever goes wrong between a client and its daemon."""


class ConnectionLost(GlintError):
    """The daemon cannot be reached, went away, does not answer, or is something else than glintd."""


class RequestError(GlintError):
    """The daemon answered with an error. str() is its sentence; `number` its JSON-RPC code; `code` its name, such as
    "BUSY", or None; `field` the parameter or key that is meant, or None; `data` all that the answer tells."""

    def __init__(self, error):
        super().__init__(error.get("message", "error without a message"))
        self.number = error.get("code")
        self.data = error.get("data", {})
        self.code = self.data.get("code")
        self.field = self.data.get("field")


class JobError(GlintError):
    """A job failed or was cancelled; `job` is what the daemon says of it."""

    def __init__(self, job):
        super().__init__(f"{job['kind']} {job['state']}: {job.get('error', 'no reason is told')}")
        self.job = job


class Notification(dict):
    """The params of a notification; `method` says what it is: "pose", "status" or "event"."""

    def __init__(self, method, params):
        super().__init__(params)
        self.method = method


def _open_socket(target, timeout_s):
    if "/" in target:
        opened = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        opened.settimeout(timeout_s)
        try:
            opened.connect(target)
        except OSError:
            opened.close()
            raise
        return opened
    host, _, port = target.rpartition(":")
    if not host or not port.isdigit():
        raise ValueError(f"{target!r} is neither HOST:PORT nor the path of a Unix socket")
    opened = socket.create_connection((host.strip("[]"), int(port)), timeout_s)
    # A daemon whose machine vanished is noticed after half a minute, also by who only listens.
    opened.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    for option, value in (("TCP_KEEPIDLE", 10), ("TCP_KEEPINTVL", 5), ("TCP_KEEPCNT", 4)):
        opened.setsockopt(socket.IPPROTO_TCP, getattr(socket, option), value)
    opened.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return opened


class _Connection:
    """Lines of JSON to and from the daemon, after its hello and, where it asks for that, authentication."""

    def __init__(self, place):
        self._place = place
        self._input = bytearray()
        self._next_id = 1
        self._max_line = _MAX_LINE_BYTES
        try:
            self._socket = _open_socket(place.target, place.timeout_s)
        except OSError as error:
            raise self._lost(f"cannot be reached ({error}); is it running?") from error
        try:
            if place.tls is not None and "/" not in place.target:
                host = place.target.rpartition(":")[0].strip("[]")
                self._socket = place.tls.wrap_socket(self._socket, server_hostname=host)
            self.hello = self._greeted()
            self._max_line = self.hello.get("max_line", _MAX_LINE_BYTES)
            if place.token is not None and self.hello.get("authentication") == "token":
                self.call("authenticate", {"token": place.token})
        except OSError as error:
            self.close()
            raise self._lost(f"refuses the connection ({error})") from error
        except BaseException:
            self.close()
            raise

    def _lost(self, why):
        return ConnectionLost(f"glintd at {self._place.target} {why}")

    def _greeted(self):
        message = self.read(self._place.timeout_s)
        if message is None:
            raise self._lost("says nothing; is it glintd?")
        if "error" in message:  # One client too many.
            raise RequestError(message["error"])
        if message.get("method") != "hello":
            raise self._lost("does not begin with hello, so it is no glintd")
        hello = message["params"]
        if hello["protocol"].split(".")[0] != PROTOCOL_MAJOR:
            raise self._lost(f"speaks protocol {hello['protocol']}, this client {PROTOCOL_MAJOR}.x; update the older one")
        return hello

    def close(self):
        self._socket.close()

    def call(self, method, params):
        """The result of a method; notifications that come meanwhile are dropped."""
        request_id = self._next_id
        self._next_id += 1
        line = json.dumps({"jsonrpc": "2.0", "id": request_id, "method": method, "params": params}) + "\n"
        try:
            self._socket.settimeout(self._place.timeout_s)
            self._socket.sendall(line.encode())
        except OSError as error:
            raise self._lost(f"went away ({error})") from error
        deadline = time.monotonic() + self._place.timeout_s
        while True:
            message = self.read(deadline - time.monotonic())
            if message is None:
                raise self._lost(f"has not answered {method} for {self._place.timeout_s} s")
            # A line that the daemon cannot make out it refuses without its id.
            if "error" in message and message.get("id") in (request_id, None):
                raise RequestError(message["error"])
            if message.get("id") == request_id:
                return message["result"]

    def read(self, timeout_s):
        """The next message; None when there is none within `timeout_s` (None: however long it takes)."""
        deadline = None if timeout_s is None else time.monotonic() + timeout_s
        searched = 0
        while True:
            end = self._input.find(b"\n", searched)
            if end >= 0:
                line = bytes(self._input[:end])
                del self._input[:end + 1]
                return self._parsed(line)
            searched = len(self._input)
            if searched > self._max_line:
                raise self._lost("sends a longer line than it said it would")
            if not self._fill(deadline):
                return None

    def _parsed(self, line):
        try:
            message = json.loads(line)
        except ValueError as error:
            raise self._lost("sends what is no JSON, so it is no glintd") from error
        if not isinstance(message, dict):
            raise self._lost("sends what is no JSON-RPC, so it is no glintd")
        return message

    def _fill(self, deadline):
        """Takes in what has come; False when nothing has come in time."""
        try:
            pending = isinstance(self._socket, ssl.SSLSocket) and self._socket.pending() > 0
            if not pending:
                left_s = None if deadline is None else max(0.0, deadline - time.monotonic())
                if not select.select([self._socket], [], [], left_s)[0]:
                    return False
            chunk = self._socket.recv(65536)
        except OSError as error:
            raise self._lost(f"went away ({error})") from error
        if not chunk:
            raise self._lost("closed the connection")
        self._input += chunk
        return True


def _may_pass(error):
    """Whether it is worth another try to connect."""
    return isinstance(error, ConnectionLost) or getattr(error, "code", None) == "BUSY"


class _Place:
    """Where the daemon is and how it is spoken to."""

    def __init__(self, target, token, tls, timeout_s):
        self.target, self.token, self.timeout_s = target, token, timeout_s
        self.tls = ssl.create_default_context(cafile=tls) if isinstance(tls, str) else tls

    def connect(self, wait_s):
        """A connection; while there is none it is tried again for `wait_s` (None: for ever)."""
        deadline = None if wait_s is None else time.monotonic() + wait_s
        delay_s = _FIRST_DELAY_S
        while True:
            try:
                return _Connection(self)
            except GlintError as error:
                if not _may_pass(error) or (deadline is not None and time.monotonic() + delay_s > deadline):
                    raise
            time.sleep(delay_s)
            delay_s = min(2 * delay_s, _LONGEST_DELAY_S)


def _given(**params):
    """Without those that are None: what is absent the daemon has a default for."""
    return {name: value for name, value in params.items() if value is not None}


class Client:
    """A connection to glintd at `target`: HOST:PORT, or the path of a Unix socket (anything with a slash).

    `token` is sent to daemons that ask for one. `tls` is the file of the certificates to trust, or an ssl.SSLContext.
    An answer may take `timeout_s`. With `wait_s` a daemon that is not there yet is waited for. A connection that was
    lost is made anew by the next call; questions (get_*, list_maps) are asked again by themselves.
    Raises ConnectionLost and RequestError here and in every call. Use it in a `with`, or close() it.
    """

    def __init__(self, target=DEFAULT_TARGET, *, token=None, tls=None, timeout_s=10.0, wait_s=0.0):
        self._place = _Place(target, token, tls, timeout_s)
        self._connection = self._place.connect(wait_s)
        self.hello = self._connection.hello

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Hangs up; a later call connects anew."""
        if self._connection is not None:
            self._connection.close()
            self._connection = None

    def call(self, method, **params):
        """The result of any method of the protocol."""
        may_repeat = self._connection is not None and method.startswith(("get_", "list_"))
        try:
            return self._call_once(method, params)
        except ConnectionLost:
            if not may_repeat:
                raise
            return self._call_once(method, params)

    def _call_once(self, method, params):
        if self._connection is None:
            self._connection = self._place.connect(0.0)
            self.hello = self._connection.hello
        try:
            return self._connection.call(method, params)
        except ConnectionLost:
            self.close()
            raise

    def get_pose(self, frame="map", child="sensor", *, at_ns=None, at=None, predict_ms=None):
        """The newest pose; that of a time (`at_ns`, or `at` in seconds as a string); or one carried on."""
        return self.call("get_pose", frame=frame, child=child, **_given(at_ns=at_ns, at=at, predict_ms=predict_ms))

    def get_status(self):
        """How sensor, tracking and map fare."""
        return self.call("get_status")

    def get_config(self):
        """The effective configuration: a dictionary for each group of keys."""
        return self.call("get_config")["config"]

    def get_metrics(self):
        """The daemon's counters as Prometheus reads them, from daemons that have this."""
        return self.call("get_metrics")["text"]

    def get_image(self, kind):
        """The latest scan's image ("range", "signal", "reflectivity", "near_ir", "filtered"), the bytes of a PNG file, from
        daemons that have this."""
        return base64.b64decode(self.call("get_image", kind=kind)["png"])

    def get_trajectory(self, since_ns=None, frame="map", child="sensor"):
        """All past poses later than `since_ns`, oldest first. They are of one map_epoch."""
        params = dict(_given(since_ns=since_ns), frame=frame, child=child)
        while True:
            page = self.call("get_trajectory", **params)
            epoch, poses = page["map_epoch"], page["poses"]
            while page["map_epoch"] == epoch and "next_cursor" in page:
                page = self.call("get_trajectory", **params, cursor=page["next_cursor"])
                poses += page["poses"]
            if page["map_epoch"] == epoch:
                return poses

    def get_map(self, voxel_m=None, region=None):
        """The whole map, or its part in `region` ((min x, y, z), (max x, y, z)), one point in each cube of `voxel_m`."""
        box = None if region is None else {"min_m": list(region[0]), "max_m": list(region[1])}
        loaded = Map(self, _given(voxel_m=voxel_m, region=box))
        loaded.update()
        return loaded

    def pause(self):
        """Scans are not used until resume()."""
        return self.call("pause")

    def resume(self):
        return self.call("resume")

    def reset_odometry(self):
        """Begins a new odometry frame and keeps the map."""
        return self.call("reset_odometry")

    def relocalize(self):
        """Has the place in the map looked for anew."""
        return self.call("relocalize")

    def set_initial_pose(self, p_m, q_xyzw=None, *, child="sensor", sigma_m=None):
        """Like relocalize(), beginning at a guess in frame map."""
        return self.call("set_initial_pose", p_m=list(p_m), child=child,
                         **_given(q_xyzw=None if q_xyzw is None else list(q_xyzw), sigma_m=sigma_m))

    def list_maps(self):
        """The saved maps, a dictionary each."""
        return self.call("list_maps")["maps"]

    def delete_map(self, name):
        return self.call("delete_map", name=name)

    def save_map(self, name):
        """Begins to save the map; the job, for wait_for()."""
        return self.call("save_map", name=name)["job"]

    def load_map(self, name, mode="extend"):
        """Begins to go on with a saved map, or with mode "localize" only to read it; the job, for wait_for()."""
        return self.call("load_map", name=name, mode=mode)["job"]

    def clear_map(self):
        """Begins an empty map; the job, for wait_for()."""
        return self.call("clear_map")["job"]

    def wait_for(self, job, timeout_s=600.0):
        """The result of a job once it is done. Raises JobError when it failed, ConnectionLost after `timeout_s` and when
        the daemon knows it no more, since it was started anew."""
        deadline = time.monotonic() + timeout_s
        while time.monotonic() < deadline:
            known = [other for other in self.get_status()["jobs"]
                     if (other["id"], other["kind"]) == (job["id"], job["kind"])]
            if not known:
                raise ConnectionLost(f"glintd at {self._place.target} knows job {job['id']} no more")
            if known[0]["state"] == "done":
                return known[0]["result"]
            if known[0]["state"] != "running":
                raise JobError(known[0])
            time.sleep(0.1)
        raise ConnectionLost(f"job {job['id']} ({job['kind']}) has not ended after {timeout_s} s")

    def subscribe(self, *topics, rate_hz=None, frame="map", child="sensor", reconnect=True, **more):
        """Notifications of `topics` ("pose", "status", "events", "map", "image"), over a connection of their own: a
        Subscription. `more`: voxel_m, region and encoding of the map, kind of the image."""
        params = dict(_given(rate_hz=rate_hz), topics=list(topics), frame=frame, child=child, **more)
        return Subscription(self._place, params, reconnect)


class Subscription:
    """Notifications as they come: iterate over it, or call next(). With `reconnect` a connection that was lost is made
    anew, for as long as it takes; what happened meanwhile is not told, and `reconnects` counts how often. `missed` is how
    many notifications this client was too slow for, `settings` what the daemon has in effect, `hello` what it said last:
    its `instance` differs after a restart. Close it, or use it in a `with`."""

    def __init__(self, place, params, reconnect):
        self._place, self._params, self._reconnect = place, params, reconnect
        self._missed_before, self._missed = 0, {}
        self.reconnects = 0
        self._connection = None
        self._connect(0.0)

    def _connect(self, wait_s):
        connection = self._place.connect(wait_s)
        try:
            self.settings = connection.call("subscribe", self._params)["settings"]
        except GlintError:
            connection.close()
            raise
        self._connection, self.hello = connection, connection.hello

    @property
    def missed(self):
        return self._missed_before + sum(self._missed.values())

    def next(self, timeout_s=None):
        """The next Notification; None when there is none within `timeout_s` (None: however long it takes)."""
        deadline = None if timeout_s is None else time.monotonic() + timeout_s
        while True:
            left_s = None if deadline is None else max(0.0, deadline - time.monotonic())
            try:
                if self._connection is None:
                    self._connect(left_s)
                    self.reconnects += 1
                message = self._connection.read(left_s)
            except GlintError as error:
                self._drop()
                if not self._reconnect or not _may_pass(error):
                    raise
                if deadline is not None and time.monotonic() >= deadline - _FIRST_DELAY_S:
                    return None
                continue
            if message is None:
                return None
            if "method" in message:
                self._missed[message["method"]] = message["params"].get("missed", 0)
                return Notification(message["method"], message["params"])

    def _drop(self):
        if self._connection is not None:
            self._connection.close()
            self._connection = None
        self._missed_before, self._missed = self.missed, {}

    def __iter__(self):
        return self

    def __next__(self):
        return self.next()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self._reconnect = False
        self._drop()


def _points_of(data):
    """float32 x y z intensity of a tile's bytes: n x 4 with numpy, else one after the other in an array."""
    if numpy is not None:
        return numpy.frombuffer(data, "<f4").reshape(-1, 4)
    values = array.array("f", data)
    if sys.byteorder != "little":
        values.byteswap()
    return values


class Map:
    """Points of the map in frame map, by tile: `tiles[(i, j, k)]` is float32 x y z intensity in metres, n x 4 with numpy,
    else one after the other in an array.array. `tile_m` is the edge of a tile, `map_epoch` and `revision` are those of the
    map that this is."""

    def __init__(self, client, query):
        self._client, self._query = client, query
        self.tiles = {}
        self.revision, self.map_epoch, self.tile_m = 0, None, None
        self._instance = None

    @property
    def count(self):
        """How many points there are."""
        return sum(memoryview(tile).nbytes for tile in self.tiles.values()) // _POINT_BYTES

    def points(self):
        """All points in one array, as those of a tile."""
        return _points_of(b"".join(tile.tobytes() for tile in self.tiles.values()))

    def update(self):
        """Takes over what changed since: a pair, the indices of the tiles that are new or other, and of those that are
        no more."""
        while True:
            changed = self._take_changes()
            if changed is not None:
                return changed

    def _take_changes(self):
        """As update(); None when the map was corrected meanwhile, so that its pages do not belong together."""
        since = self.revision
        pages = self._pages(since)
        if pages is None:
            return None
        parts = {}
        for tile in (tile for page in pages for tile in page["tiles"]):
            known = parts.setdefault(tuple(tile["index"]), [])
            if not tile["continued"]:
                known.clear()
            known.append(base64.b64decode(tile["points"]))
        changed = {index: _points_of(b"".join(data)) for index, data in parts.items()}
        gone = {tuple(index) for index in pages[0]["removed"]} if since else set(self.tiles) - set(changed)
        gone &= set(self.tiles)
        for index in gone:
            del self.tiles[index]
        self.tiles.update(changed)
        self.revision, self.tile_m = pages[0]["revision"], pages[0]["tile_m"]
        return set(changed), gone

    def _pages(self, since):
        pages = []
        while not pages or "next_cursor" in pages[-1]:
            cursor = {"cursor": pages[-1]["next_cursor"]} if pages else {}
            try:
                page = self._client.call("get_map", since_revision=since, **self._query, **cursor)
            except RequestError as error:
                if cursor and error.code == "OUT_OF_RANGE":
                    return None
                raise
            of = (page["map_epoch"], self._client.hello["instance"])
            if of != (self.map_epoch, self._instance):
                # All points have moved, or it is another map, whose revisions begin anew: what is known holds no more.
                (self.map_epoch, self._instance), self.revision = of, 0
                if since or pages:
                    return None
            pages.append(page)
        return pages
