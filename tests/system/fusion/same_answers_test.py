"""The same request gets the same answer from a sensor and from the tracker: status and headers."""
import http.client
import time
import unittest

from rig import BIN, Rig, get_json, wait_for

# Headers that differ between any two services or answers: times, tags, sizes and links.
ITS_OWN = {"date", "chorus-clock", "server-timing", "etag", "content-length", "content-location", "link"}
TURTLE, JSON, N_TRIPLES = "text/turtle", "application/json", "application/n-triples"


class Asked:
    def __init__(self, process):
        self.port = process.port
        frame = get_json(process.url + "frame")
        self.names = {"newest": frame["sequence"], "body": frame["bodies"][0]["bodyId"],
                      "instant": int(frame["capturedNanoseconds"]) - 300_000_000,
                      "later": int(frame["capturedNanoseconds"]) + 3_600_000_000_000,
                      "recent": frame["sequence"] - 15}

    def answer(self, method, path, accept):
        """(status, headers without the service's own, names of the headers) of one request."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        try:
            connection.request(method, path.format(**self.names), headers={"Accept": accept})
            response = connection.getresponse()
            response.read()
            headers = {name.lower(): value for name, value in response.getheaders()}
            return (response.status, {k: v for k, v in headers.items() if k not in ITS_OWN}, sorted(headers))
        finally:
            connection.close()


REQUESTS = [
    ("/frame", 200), ("/frame?profile=nonsense", 404), ("/frame?at=noon", 400), ("/frame?at=", 400),
    ("/frame?at={instant}", 200), ("/frame?at={later}", 404), ("/frame?at=1970-01-02T00:00:00Z", 410),
    ("/frames/{recent}", 200), ("/frames/0{recent}", 404), ("/frames/1", 410), ("/frames/{later}", 404),
    ("/frames/x", 404), ("/frames/", 404), ("/skeletons/", 200), ("/skeletons", 308), ("/skeletons/{body}", 200),
    ("/skeletons/00{body}", 404), ("/skeletons/x", 404), ("/skeletons/{later}", 404),
    ("/floor-plane", 200), ("/", 200), ("/clock", 200), ("/healthz", 200), ("/recordings/", 200),
    ("/recordings/none", 404), ("/ns", 200), ("/nothing", 404),
]


class SameAnswers(Rig):
    def test_a_sensor_and_the_tracker_answer_alike(self):
        sensor = self.sensor(0, history_s=2, **{"device.simulated.scene.path": "stand"})
        fusion = self.fusion({"s1": sensor.url}, **{"registration.file": self.given_ring(6)})
        for process in (sensor, fusion):
            wait_for("a body", lambda url=process.url: get_json(url + "frame")["bodies"])
            wait_for("health", lambda url=process.url: get_json(url + "healthz")["status"] == "ok")
        oldest = Asked(sensor)
        wait_for("the first frame is gone", lambda: oldest.answer("GET", "/frames/1", JSON)[0] == 410)
        for path, status in REQUESTS:
            for method, accept in (("GET", JSON), ("HEAD", TURTLE), ("GET", N_TRIPLES), ("GET", "image/png"),
                                   ("OPTIONS", JSON), ("PUT", JSON)):
                with self.subTest(path=path, method=method, accept=accept):
                    ours, theirs = (Asked(process).answer(method, path, accept) for process in (sensor, fusion))
                    self.assertEqual(ours, theirs)
                    if (method, accept) == ("GET", JSON) and path not in ("/ns",):
                        self.assertEqual(ours[0], status)


if __name__ == "__main__":
    assert BIN.exists(), f"build chorus-fusion first ({BIN})"
    unittest.main(verbosity=2)
