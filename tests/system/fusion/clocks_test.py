"""A sensor that does not answer with its time, its clock 200 ms behind: told by a walk, added to its frames, kept over a restart."""
import datetime
import http.server
import json
import os
import pathlib
import threading
import unittest
import urllib.error
import urllib.request

from rig import ROOT, Rig, get, get_json, wait_for
from session_test import QUICK

COUNT = 3
OFF_NS = 200_000_000
PLAIN = ("Content-Type", "ETag")


def shifted(node):
    """The document with every capture time OFF_NS earlier."""
    if isinstance(node, list):
        return [shifted(item) for item in node]
    if not isinstance(node, dict):
        return node
    node = {key: shifted(value) for key, value in node.items()}
    if "capturedNanoseconds" in node:
        ns = int(node["capturedNanoseconds"]) - OFF_NS
        moment = datetime.datetime.fromtimestamp(ns // 10**9, datetime.timezone.utc)
        node["capturedNanoseconds"] = str(ns)
        node["captured"] = f"{moment:%Y-%m-%dT%H:%M:%S}.{ns % 10**9:09d}Z"
    return node


class PlainSensor:
    """Shows a sensor's /frame and /floor-plane as the least that docs/guide/sensor.md asks for, by a clock that is behind."""

    def __init__(self, upstream):
        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"
            disable_nagle_algorithm = True

            def do_GET(self):
                if self.path not in ("/frame", "/floor-plane"):
                    return self.answer(404, {}, b"")
                headers = {k: self.headers[k] for k in ("If-None-Match", "Prefer") if self.headers[k]}
                request = urllib.request.Request(upstream + self.path[1:], headers={**headers, "Accept": "application/json"})
                try:
                    with urllib.request.urlopen(request, timeout=15) as answer:
                        status, head, body = answer.status, answer.headers, answer.read()
                except urllib.error.HTTPError as refusal:
                    status, head, body = refusal.code, refusal.headers, refusal.read()
                if self.path == "/frame" and status == 200:
                    body = json.dumps(shifted(json.loads(body))).encode()
                self.answer(status, {k: head[k] for k in PLAIN if head[k]}, body)

            def answer(self, status, headers, body):
                head = [f"HTTP/1.1 {status} x", f"Content-Length: {len(body)}", *(f"{k}: {v}" for k, v in headers.items())]
                self.wfile.write("\r\n".join(head).encode() + b"\r\n\r\n" + (b"" if status == 304 else body))

            def log_message(self, *_):
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        self.server.handle_error = lambda *_: None  # clients may leave
        self.url = f"http://127.0.0.1:{self.server.server_port}/"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def close(self):
        self.server.shutdown()
        self.server.server_close()


class Clocks(Rig):
    def in_step(self, fusion):
        """Waits until the plain sensor's frames take part like the others'; returns what is shown of it."""
        wait_for("its bodies are fused", lambda: get_json(fusion.url + "sensors/s2")["share"] > 0.5)
        wait_for("one body", lambda: len(get_json(fusion.url + "frame")["bodies"]) == 1)
        return get_json(fusion.url + "sensors/s2")

    def test_a_clock_told_by_a_walk_is_added_to_live_frames(self):
        sensors = [self.sensor(i, COUNT) for i in range(COUNT)]
        plain = PlainSensor(sensors[1].url)
        self.fakes.append(plain)
        polled = {f"s{i + 1}": sensor.url for i, sensor in enumerate(sensors)}
        polled["s2"] = plain.url
        state = pathlib.Path(self.folder.name) / "state"
        fusion = self.fusion(polled, state_dir=state, **QUICK)
        shown = wait_for("registered", lambda: (r := get_json(fusion.url + "registration"))["verdict"] == "Good"
                         and r["session"]["state"] == "idle" and r, patience=90)
        self.assertAlmostEqual(shown["sensors"]["s2"]["clockOffsetMilliseconds"], OFF_NS / 1e6, delta=40)
        sensor = self.in_step(fusion)
        self.assertTrue(sensor["clockCorrected"])
        self.assertAlmostEqual(sensor["clockFromWalkMilliseconds"], OFF_NS / 1e6, delta=40)
        self.assertEqual(sensor["clockFromWalkMilliseconds"], sensor["clockOffsetMilliseconds"])
        wait_for("its age is by the common clock", lambda: get_json(fusion.url + "sensors/s2")["ageMilliseconds"] < 190)
        self.assertNotIn("clockFromWalkMilliseconds", get_json(fusion.url + "sensors/s1"))
        self.assertIn("hostSynchronised", get_json(fusion.url + "sensors/s1"))
        self.assertIn('chorus_clock_offset_seconds{sensor="s2"} 0.', get(fusion.url + "metrics", accept="*/*")[2].decode())
        wait_for("stored", lambda: "clockLeastAgeMilliseconds" in (state / "registration.json").read_text())
        fusion.stop()
        again = self.fusion(polled, state_dir=state, **QUICK)
        self.assertAlmostEqual(self.in_step(again)["clockFromWalkMilliseconds"], OFF_NS / 1e6, delta=40)


if __name__ == "__main__":
    os.chdir(ROOT)
    unittest.main(verbosity=2)
