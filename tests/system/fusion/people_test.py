"""People, events, the lean form and slow streams of a running tracker: real processes, simulated sensors."""
import http.client
import json
import signal
import subprocess
import time
import unittest

from rig import BIN, Rig, get, get_json, send, wait_for

COUNT = 3


def stream(server, path, headers=None):
    """An open event stream: yields (time, id, data) of each event."""
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=20)
    connection.request("GET", path, headers={"Accept": "text/event-stream", **(headers or {})})
    answer = connection.getresponse()
    assert answer.status == 200, answer.read()
    event = {}
    while line := answer.readline().decode().rstrip("\n"):
        key, _, value = line.partition(": ")
        event[key] = value
        if key == "data":
            yield time.monotonic(), event.get("id"), json.loads(value)
        if key in ("data", "retry"):
            answer.readline()
            event = {}


class People(Rig):
    def setUp(self):
        super().setUp()
        self.sensors = [self.sensor(i, COUNT) for i in range(COUNT)]
        self.server = self.fusion({f"s{i + 1}": s.url for i, s in enumerate(self.sensors)}, **{"registration.file": self.given_ring(COUNT)})
        self.people = wait_for("somebody is there", lambda: get_json(self.server.url + "people/")["people"])

    def events(self, after=0):
        return get_json(f"{self.server.url}events?after={after}")["events"]

    def await_event(self, kind, after=0):
        return wait_for(kind, lambda: next((e for e in self.events(after) if e["kind"] == kind), None))

    def test_names_forgetting_and_events(self):
        person = next(iter(self.people))
        place = self.server.url + "people/" + person
        bodies = [str(body["bodyId"]) for body in get_json(self.server.url + "frame")["bodies"]]
        self.assertIn(person, bodies, "the ids are those of frames")
        self.assertEqual(send("PATCH", place, b'{"name": "Anna"}')[0], 200)
        self.assertEqual(get_json(self.server.url + "people/")["people"][person]["name"], "Anna")
        for bad in (b'{"name": "a/b"}', b'{"name": "' + b"x" * 300 + b'"}', b'{"name": "\\u202e"}', b"\xff", b""):
            self.assertEqual(send("PATCH", place, bad)[0], 400, bad[:20])
        foreign = {"Origin": "http://elsewhere.example", "Content-Type": "application/json"}
        self.assertEqual(send("PATCH", place, b'{"name": "Eve"}', foreign)[0], 403, "a page of another origin")
        came = self.await_event("person-came")
        self.assertEqual(send("POST", place + "/forget")[0], 204)
        self.assertEqual(get(place)[0], 404)
        anew = wait_for("they are somebody new", lambda: get_json(self.server.url + "people/")["people"])
        self.assertNotIn(person, anew)
        frame = get_json(self.server.url + "frame")
        self.assertEqual([body.get("slot") for body in frame["bodies"]], [0], "the slot was freed")
        self.sensors[0].stop(signal.SIGKILL)
        lost = self.await_event("sensor-lost")
        self.assertEqual((lost["about"], lost["severity"]), ("s1", "warning"))
        following = stream(self.server, "/events", {"Last-Event-ID": str(int(lost["eventId"]) - 1)})
        _, number, told = next(following)
        self.assertEqual((number, told["eventId"], told["message"]), (lost["eventId"], lost["eventId"], lost["message"]), "what came after that id, first")
        from_the_start = stream(self.server, "/events")
        self.assertEqual([next(from_the_start)[1] for _ in range(2)], [e["eventId"] for e in self.events()[:2]])
        self.sensor(0, COUNT, port=self.sensors[0].port)
        self.assertEqual(next(e for _, _, e in following if e["kind"].startswith("sensor"))["kind"], "sensor-back")
        said = subprocess.run([BIN / "chorus", "status", "--events", "--url", self.server.url], capture_output=True, text=True, timeout=20, check=True).stdout
        self.assertIn("warning  " + lost["message"], said)
        self.assertLess(int(came["eventId"]), int(lost["eventId"]))

    def test_a_tokens_holder_may_name_and_others_may_not(self):
        guarded = self.fusion({"s2": self.sensors[1].url}, **{"registration.file": self.given_ring(COUNT), "http.bearer_token": "sesame-0123456789"})
        person = next(iter(wait_for("somebody", lambda: get_json(guarded.url + "people/")["people"])))
        place = f"{guarded.url}people/{person}"
        self.assertEqual(send("PATCH", place, b'{"name": "Anna"}')[0], 401)
        self.assertEqual(send("POST", place + "/forget")[0], 401)
        self.assertEqual(send("PATCH", place, b'{"name": "Anna"}', {"Authorization": "Bearer sesame-0123456789"})[0], 200)

    def test_the_lean_form_and_slow_streams(self):
        full = get(self.server.url + "frame")[2]
        lean = get(self.server.url + "frame?form=pose")[2]
        self.assertLessEqual(len(lean), len(full) / 4, f"{len(lean)} of {len(full)} bytes")
        print(f"lean form: {len(lean)} of {len(full)} bytes")
        body = json.loads(lean)["bodies"][0]
        self.assertEqual(set(body["joints"]["Head"]), {"x", "y", "z", "state"})
        at = get_json(self.server.url + "frame?form=pose&at=now")
        self.assertEqual(set(at["bodies"][0]["joints"]["Head"]), {"x", "y", "z", "state"})
        self.assertEqual(get(self.server.url + "frame?form=prose")[0], 404)
        self.assertEqual(get(self.server.url + "frame?form=pose", accept="text/turtle")[0], 406)
        self.assertEqual(get(self.server.url + "frame?max_rate=0", accept="text/event-stream")[0], 400)
        sequences = []
        for _, _, frame in stream(self.server, "/frame?form=pose&max_rate=5"):
            self.assertLessEqual(len(json.dumps(frame, separators=(",", ":"))), len(full) / 4)
            sequences.append(frame["sequence"])
            if len(sequences) == 11:
                break
        # How often exactly is asked of the reader's own clock, in a unit test: a busy machine fuses fewer instants in between.
        steps = sorted(b - a for a, b in zip(sequences, sequences[1:]))
        self.assertGreater(steps[0], 0, "none comes twice")
        self.assertGreaterEqual(steps[len(steps) // 2], 3, "others were left out: the newest wins")


if __name__ == "__main__":
    assert BIN.exists(), f"build chorus-fusion first ({BIN})"
    unittest.main(verbosity=2)
