"""The services answer as proto/openapi.json specifies: statuses and media types of every GET."""
import json
import unittest
from functools import partial
from urllib.parse import quote, urljoin

from rig import BIN, ROOT, Rig, get, get_json, send

import thing_rules  # in tests/support, which rig adds to the path

DOCUMENT = json.loads((ROOT / "proto/openapi.json").read_text(encoding="utf-8"))
GETS = {path: methods["get"]["responses"] for path, methods in DOCUMENT["paths"].items() if "get" in methods}
NEVER = "application/x-none-of-ours"
# Who serves what: the rest is served by everybody, or documents its 404.
OF_ERGONOMICS = {"/ergonomics/", "/methods/", "/asked"}
OF_TRACKER = {"/sensors/", "/inertial/", "/people/", "/events", "/outputs/", "/props/", "/registration", "/setup", "/viewer/"}


def bare(headers):
    return headers.get("Content-Type", "").split(";")[0]


class Contract(Rig):
    def check(self, service, places):
        """Requests each path of {path of the document: path requested} with every media type that is offered."""
        for path, asked in places.items():
            documented = GETS[path]
            types = documented["200"].get("content", {})
            for accept in (*types, "*/*", NEVER):
                # A stream of events never ends, so only its head is asked for.
                ask = partial(send, "HEAD", headers={"Accept": accept}) if accept == "text/event-stream" else partial(get, accept=accept)
                status, headers, body = ask(service.url + asked.lstrip("/"))
                with self.subTest(path=path, accept=accept, status=status):
                    self.assertIn(str(status), documented, body[:200])
                    if status == 200:
                        self.assertIn(bare(headers), types)
                        if accept in types:
                            self.assertEqual(bare(headers), accept)

    def check_thing(self, service, properties, actions, events):
        """The Thing Description keeps the rules, has at least these parts, and its forms hold."""
        status, headers, body = get(service.url + ".well-known/wot", accept="application/td+json")
        self.assertEqual((status, bare(headers)), (200, "application/td+json"))
        thing = json.loads(body)
        self.assertEqual(list(thing_rules.faults(thing)), [])
        self.assertEqual(thing["base"], service.url)
        for kind, names in (("properties", properties), ("actions", actions), ("events", events)):
            self.assertLessEqual(names, set(thing[kind]), kind)
        for name, one in thing["properties"].items():
            for form in one["forms"]:
                if "{" in form["href"]:
                    continue
                with self.subTest(property=name, type=form["contentType"]):
                    status, headers, _ = get(urljoin(thing["base"], form["href"]), accept=form["contentType"])
                    self.assertIn(status, (200, 503))
                    if status == 200:
                        self.assertEqual(bare(headers), form["contentType"])
        self.assertIn('</.well-known/wot>; rel="describedby"', ", ".join(get(service.url)[1].get_all("Link")))
        broken = {**thing, "security": "none", "events": {"frame": {"forms": []}}}
        self.assertEqual(len(list(thing_rules.faults(broken))), 2, "the rules bite")

    def test_fusion_keeps_it(self):
        sensor = self.sensor(0)
        fusion = self.fusion({"s1": sensor.url}, viewer_dir=str(ROOT / "services/viewer"))
        plain = {path: path for path in GETS if "{" not in path and not path.startswith("/images/") and path not in OF_ERGONOMICS}
        self.check(fusion, plain | {"/sensors/{id}": "/sensors/s1", "/sensors/{id}/frame": "/sensors/s1/frame",
                                    "/frames/{seq}": f"/frames/{get_json(fusion.url + 'frame')['sequence']}"})
        self.check_thing(fusion, {"frame", "skeletons", "skeleton", "floorPlane", "sensors", "registration", "health", "clock"},
                         {"startRegistration", "cancelRegistrationSession", "moveOrigin", "startRecording"},
                         {"frame", "sensors", "registration"})
        self.check(fusion, {"/sensors/{id}": "/sensors/none", "/frames/{seq}": "/frames/1", "/recordings/{name}": "/recordings/none"})
        for at, expected in (("yesterday", 400), ("2001-01-01T00:00:00Z", 410)):
            status = get(fusion.url + "frame?at=" + quote(at))[0]
            self.assertEqual(status, expected, at)
            self.assertIn(str(status), GETS["/frame"])
        for query, expected in (("?limit=0", 400), ("?limit=3&after=a", 200)):
            status = get(fusion.url + "recordings/" + query)[0]
            self.assertEqual(status, expected, query)
            self.assertIn(str(status), GETS["/recordings/"])

    def test_a_sensor_keeps_it(self):
        sensor = self.sensor(0, images="true")
        self.check(sensor, {path: path for path in GETS if "{" not in path and path not in OF_TRACKER | OF_ERGONOMICS})
        self.check_thing(sensor, {"frame", "skeletons", "floorPlane", "colorImage", "depthImage", "health"}, {"startRecording"}, {"frame"})


if __name__ == "__main__":
    assert BIN.exists(), f"build chorus-fusion first ({BIN})"
    unittest.main(verbosity=2)
