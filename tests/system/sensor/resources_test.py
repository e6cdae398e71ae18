"""Every resource of a sensor that replays a recording, over HTTP."""

import json
import socket
import unittest

from sensor_process import Sensor, make_recording, temporary_folder

TURTLE, JSON, JSON_LD, N_TRIPLES = ("text/turtle", "application/json", "application/ld+json",
                                    "application/n-triples")


class Resources(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = temporary_folder()
        cls.recording = make_recording(cls.folder.name)
        cls.sensor = Sensor("--id", "s9", "--recording", cls.recording, "--set", "history_s=1")
        cls.sensor.wait_for("/frame", 200)

    @classmethod
    def tearDownClass(cls):
        code, _ = cls.sensor.stop()
        cls.folder.cleanup()
        assert code == 0, f"SIGTERM ended it with {code}"

    def get(self, *arguments, **options):
        return self.sensor.get(*arguments, **options)

    def test_every_resource_in_every_format(self):
        for path in ("/", "/frame", "/skeletons/", "/skeletons/7", "/floor-plane", "/clock"):
            for accept in (TURTLE, JSON, JSON_LD, N_TRIPLES):
                with self.subTest(path=path, accept=accept):
                    answer = self.get(path, accept=accept)
                    self.assertEqual((answer.status, answer.type), (200, accept))
                    self.assertTrue(answer.bytes)

    def test_self_description_links_lead_somewhere(self):
        contained = self.get("/").json["contains"]
        self.assertIn("frame", contained)
        for path in contained:
            self.assertEqual(self.get("/" + path, accept="*/*").status, 200, path)
        page = self.get("/", accept="text/html,*/*;q=0.8")
        self.assertEqual(page.type, "text/html")
        self.assertIn("made by a test", page.text)

    def test_operations(self):
        self.assertEqual(self.get("/healthz").status, 200)
        metrics = self.get("/metrics", accept="*/*").text
        captured = [line for line in metrics.splitlines() if line.startswith("chorus_frames_captured_total ")]
        self.assertGreater(float(captured[0].split()[1]), 0)

    def test_the_frame_is_what_was_recorded_with_new_times(self):
        answer = self.get("/frame")
        frame = answer.json
        self.assertEqual((frame["source"], frame["space"]), ("s9", "SensorSpace"))
        now = int(answer.headers["Chorus-Clock"].split()[0])
        age = (now - int(frame["capturedNanoseconds"])) / 1e9
        self.assertTrue(0 <= age < 5, f"{age} s old")
        joints = frame["bodies"][0]["joints"]
        self.assertEqual(len(joints), 25)
        # The sensor looks along +z from 2.5 m; the person walks 4 cm per frame along x.
        self.assertAlmostEqual(joints["SpineBase"]["z"], 2.5, delta=0.5)
        floor = self.get("/floor-plane").json
        self.assertAlmostEqual(floor["normalY"], 1.0, places=3)
        self.assertAlmostEqual(floor["offset"], 1.2, places=3)

    def test_long_poll_sees_every_frame_once(self):
        answer = self.get("/frame")
        steps = []
        for _ in range(30):
            before = answer.json
            answer = self.get("/frame", headers={"If-None-Match": answer.headers["ETag"], "Prefer": "wait=10"})
            self.assertEqual(answer.status, 200)
            self.assertIn("wait", answer.headers["Preference-Applied"])
            after = answer.json
            steps.append(after["sequence"] - before["sequence"])
            self.assertGreater(int(after["capturedNanoseconds"]), int(before["capturedNanoseconds"]))
        self.assertTrue(all(step >= 1 for step in steps), "no frame twice")
        # Every request here opens a connection, so on a busy machine frames are missed; a poll that skips would never give the next one.
        self.assertGreaterEqual(steps.count(1), 8, steps)

    def test_conditional_get(self):
        floor = self.get("/floor-plane")
        again = self.get("/floor-plane", headers={"If-None-Match": floor.headers["ETag"]})
        self.assertEqual((again.status, again.bytes), (304, b""))

    def test_numbered_frames(self):
        location = self.get("/frame").headers["Content-Location"]
        kept = self.get("/" + location)
        self.assertEqual(kept.status, 200)
        self.assertEqual(location, f"frames/{kept.json['sequence']}")
        self.assertIn("immutable", kept.headers["Cache-Control"])
        self.assertEqual(self.get("/frames/99999999").status, 404)
        self.sensor.wait_for("/frames/1", 410)  # one second is kept

    def test_refusals_are_problem_documents_that_help(self):
        for path, status, hint in (("/nothing", 404, ""), ("/skeletons/8", 404, "7"),
                                   ("/images/color", 404, "images: true"), ("/images/", 404, "images: true")):
            answer = self.get(path)
            self.assertEqual((answer.status, answer.type), (status, "application/problem+json"), path)
            self.assertIn(hint, answer.json["detail"])
        self.assertEqual(self.get("/frame", accept="image/png").status, 406)
        self.assertEqual(self.get("/frame", method="DELETE").status, 405)

    def test_garbage_does_it_no_harm(self):
        for garbage in (b"\x16\x03\x01\x02\x00\x01\x00", b"GET\r\n\r\n", b"GET /frame HTTP/1.1\r\n\r\n",
                        b"GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n", b"\x00" * 5000,
                        b"GET /" + b"a" * 20000 + b" HTTP/1.1\r\nHost: a\r\n\r\n",
                        b"GET /frames/%00%ff HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n",
                        b"GET /skeletons/..%2f..%2fetc HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n",
                        b"POST /frame HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n\r\nZZ\r\n"):
            with self.subTest(garbage=garbage[:40]), socket.create_connection(
                    ("127.0.0.1", self.sensor.port), timeout=10) as connection:
                connection.sendall(garbage)
                connection.shutdown(socket.SHUT_WR)
                answer = connection.recv(65536)
                self.assertFalse(answer.startswith(b"HTTP/1.1 2"), answer[:100])
                self.assertFalse(answer.startswith(b"HTTP/1.1 5"), answer[:100])
        self.assertEqual(self.get("/frame").status, 200)

    def test_event_stream_carries_frames(self):
        with socket.create_connection(("127.0.0.1", self.sensor.port), timeout=10) as connection:
            connection.sendall(b"GET /frame HTTP/1.1\r\nHost: 127.0.0.1\r\nAccept: text/event-stream\r\n\r\n")
            received = b""
            while received.count(b"\ndata: ") < 3:
                received += connection.recv(65536)
        texts = [line[6:] for line in received.split(b"\n") if line.startswith(b"data: ")]
        first, second = (json.loads(text)["sequence"] for text in texts[:2])
        self.assertGreater(second, first)


if __name__ == "__main__":
    unittest.main()
