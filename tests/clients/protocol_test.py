# SPDX-License-Identifier: Apache-2.0
# Copyright 2026 The Glint Authors
"""daemon/PROTOCOL.md, the schemas beside it and the daemon agree with each other.

usage: protocol_test.py GLINTD
Every example of the page is held against its schema, and every example request is put to a running daemon, whose answer
must be of the same kind and fit the schema. Here, unlike for clients, a member that no schema knows is an error.
"""
import glob
import json
import os
import re
import sys
import unittest

import jsonschema

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "support"))
from glintd_process import ROOT, GlintdProcess, await_status
from glint_client import Client, RequestError

GLINTD = sys.argv.pop(1)
NO_METHODS = {"common", "error", "hello", "pose", "status", "event", "map", "image"}
# What takes the map from under the others comes last.
LATE = ["relocalize", "set_initial_pose", "reset_odometry", "load_map", "clear_map"]


def closed(schema):
    """The schema with members that it does not know forbidden in every whole object."""
    if isinstance(schema, list):
        return [closed(part) for part in schema]
    if not isinstance(schema, dict):
        return schema
    out = {key: closed(part) for key, part in schema.items()}
    if out.get("type") == "object" and "additionalProperties" not in out:
        out["unevaluatedProperties"] = False
    return out


def load_schemas():
    schemas = {}
    for path in glob.glob(os.path.join(ROOT, "daemon", "schema", "*.json")):
        with open(path) as file:
            schemas[os.path.basename(path)[:-len(".json")]] = json.load(file)
    return schemas


SCHEMAS = load_schemas()
STORE = {schema["$id"]: closed(schema) for schema in SCHEMAS.values()}


def check(instance, name, part=""):
    """Raises ValidationError unless `instance` fits the schema `name`, or its `part`."""
    base = SCHEMAS[name]["$id"]
    resolver = jsonschema.RefResolver(base, STORE[base], STORE)
    jsonschema.Draft202012Validator({"$ref": base + part}, resolver=resolver).validate(instance)


def check_message(message, method=None):
    """A line of either side; `method`: what a reply answers."""
    assert message["jsonrpc"] == "2.0", message
    if "error" in message:
        check(message["error"], "error")
    elif "result" in message:
        check(message["result"], method, "#/$defs/result")
    elif "id" in message:
        check(message.get("params", {}), message["method"], "#/$defs/params")
    else:
        check(message["params"], message["method"])


def read_page():
    with open(os.path.join(ROOT, "daemon", "PROTOCOL.md")) as file:
        return file.read()


PAGE = read_page()
EXAMPLES = [json.loads(line) for block in re.findall(r"^```json\n(.*?)^```", PAGE, re.S | re.M)
            for line in block.splitlines()]


def read_pairs():
    """Each request with its answer, which follows it."""
    pairs, request = [], None
    for example in EXAMPLES:
        if "id" in example and "method" in example:
            assert request is None, f"no answer follows {request}"
            request = example
        elif "id" in example:
            assert request is not None and request["id"] == example["id"], f"no request comes before {example}"
            pairs.append((request, example))
            request = None
    return pairs


PAIRS = read_pairs()


class ThePage(unittest.TestCase):
    def test_schemas_are_schemas(self):
        for schema in SCHEMAS.values():
            jsonschema.Draft202012Validator.check_schema(schema)
            jsonschema.Draft202012Validator.check_schema(STORE[schema["$id"]])

    def test_examples_fit_their_schemas(self):
        for request, answer in PAIRS:
            with self.subTest(request=request):
                check_message(request)
                check_message(answer, request["method"])
        for example in EXAMPLES:
            with self.subTest(example=json.dumps(example)[:120]):
                if "jsonrpc" not in example:
                    check(example, "status", "#/$defs/sensor_session")
                elif "id" not in example:
                    check_message(example)

    def test_a_member_that_no_schema_knows_is_noticed(self):
        pose = next(answer["result"] for _, answer in PAIRS if "p_m" in answer.get("result", {}))
        for spoilt in ({**pose, "speed": 1.0}, {**pose, "T_map_odom": {**pose["T_map_odom"], "r": 0}},
                       {**pose, "p_m": [1, 2]}, {**pose, "state": "GOOD"}):
            with self.assertRaises(jsonschema.ValidationError):
                check(spoilt, "get_pose", "#/$defs/result")

    def test_kinds_of_events_are_those_of_the_table_and_of_the_daemon(self):
        known = set(SCHEMAS["event"]["properties"]["kind"]["enum"])
        table = re.search(r"^\| kind \|.*?\n\n", PAGE, re.S | re.M).group()
        self.assertEqual(known, set(re.findall(r"^\| `(\w+)`", table, re.M)))
        posted = set()
        for path in glob.glob(os.path.join(ROOT, "daemon", "*.cpp")):
            if not path.endswith("_test.cpp"):
                with open(path) as file:
                    posted |= set(re.findall(r"\.post\(\s*\{\"(\w+)\"", file.read()))
        self.assertEqual(known, posted)
        shown = {example["params"]["kind"] for example in EXAMPLES if example.get("method") == "event"}
        self.assertEqual(known, shown)

    def test_codes_of_errors_are_those_of_the_table(self):
        table = re.search(r"^## Errors\n.*", PAGE, re.S | re.M).group()
        rows = re.findall(r"^\| (-\d+) \| `?(\w*)`?", table, re.M)
        self.assertEqual({int(number) for number, _ in rows}, set(SCHEMAS["error"]["properties"]["code"]["enum"]))
        names = set(SCHEMAS["error"]["properties"]["data"]["properties"]["code"]["enum"])
        self.assertEqual({name for _, name in rows if name}, names)


class TheDaemon(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.daemon = GlintdProcess(GLINTD, source="synth:corridor")
        cls.daemon.start()
        cls.client = Client(cls.daemon.tcp)
        cls.subscription = cls.client.subscribe("pose", "status", "events", "map", "image", kind="signal")
        await_status(cls.client, lambda status: status["map"]["keyframes"] >= 3)

    @classmethod
    def tearDownClass(cls):
        cls.subscription.close()
        cls.client.close()
        cls.daemon.__exit__()

    def ask(self, request):
        """The reply as a message."""
        try:
            result = self.client.call(request["method"], **request.get("params", {}))
            return {"jsonrpc": "2.0", "id": request["id"], "result": result}
        except RequestError as error:
            return {"jsonrpc": "2.0", "id": request["id"],
                    "error": {"code": error.number, "message": str(error), "data": error.data}}

    def test_every_feature_has_a_schema_and_an_example(self):
        check(self.client.hello, "hello")
        features = self.client.hello["features"]
        page = next(example for example in EXAMPLES if example.get("method") == "hello")
        self.assertEqual(features, page["params"]["features"])
        methods = {name.split(".")[0] for name in features}
        self.assertEqual(methods, set(SCHEMAS) - NO_METHODS)
        shown = {request["method"] for request, _ in PAIRS}
        for request, _ in PAIRS:
            params = request.get("params", {})
            shown |= {f"{request['method']}.{name}" for name in [*params, *params.get("topics", [])]}
        self.assertEqual(set(), set(features) - shown)

    def test_example_requests_are_answered_as_the_page_says(self):
        for name in ("office", "attic"):
            self.client.wait_for(self.client.save_map(name))
        kinds = set()
        for request, shown in sorted(PAIRS, key=lambda pair: [pair[0]["method"] == late for late in LATE[::-1]]):
            # That needs a daemon with tokens: access_test.cpp.
            if shown.get("error", {}).get("data", {}).get("code") == "FORBIDDEN":
                continue
            with self.subTest(request=json.dumps(request)):
                reply = self.ask(request)
                check_message(reply, request["method"])
                self.assertEqual(shown.keys(), reply.keys(), reply)
                if "error" in reply:
                    self.assertEqual(shown["error"]["data"]["code"], reply["error"]["data"]["code"])
                elif "job" in reply["result"]:
                    self.client.wait_for(reply["result"]["job"])
                if request["method"] == "pause":
                    await_status(self.client, lambda status: status["state"] == "PAUSED")
        while True:
            notification = self.subscription.next(0.3)
            check(notification, notification.method)
            kinds.add(notification.get("kind", notification.method))
            if notification.get("action") == "cleared":
                break
        self.assertLessEqual({"pose", "status", "sensor", "job", "map", "epoch", "signal"}, kinds)

    def test_other_questions_are_answered_as_the_schemas_say(self):
        now = self.client.get_pose("odom")
        for method, params in (("get_pose", {"child": "base"}), ("get_pose", {"frame": "odom", "at_ns": now["t_ns"]}),
                               ("get_pose", {"at": now["t"], "frame": "odom"}), ("get_map", {"encoding": "json", "voxel_m": 1}),
                               ("get_trajectory", {"frame": "odom"}), ("get_map", {"since_revision": 1})):
            with self.subTest(method=method, params=params):
                check(params, method, "#/$defs/params")
                check(self.client.call(method, **params), method, "#/$defs/result")
        for method, params in (("get_pose", {"frame": "moon"}), ("delete_map", {"name": "none"}), ("fly", {}),
                               ("set_initial_pose", {}), ("get_map", {"cursor": 1})):
            with self.subTest(method=method, params=params):
                reply = self.ask({"id": 1, "method": method, "params": params})
                check(reply["error"], "error")


if __name__ == "__main__":
    unittest.main()
