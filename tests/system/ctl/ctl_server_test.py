"""chorus register, status and replay against servers: a stand-in for the fusion server, and real chorus-sensor
processes."""

import json
import signal
import socket
import subprocess
import tempfile
import threading
import time
import unittest
import urllib.request
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from chorus_program import BIN, CAMERAS, chorus
from ports import free_ports

PLACE = {"x": 1.0, "y": 1.5, "z": 0.0, "qx": 0, "qy": 0, "qz": 0, "qw": 1, "error": 0.012, "chain": ["s1", "s2"]}


class FusionStandIn:
    """Answers according to proto/README.md. `old` is the verdict on the registration in use before; `verdict`, `reasons` and `adopted` are
    the result of a session, which ends after it was polled three times."""

    SESSION = "/registration/sessions/41"

    def __init__(self, verdict="Good", reasons=(), adopted=True, old="Good", others=None):
        self.calls = []
        self.looks = 0
        self.state = "idle" if others is None else "collecting"
        self.mine = False
        self.old = {"@type": "Registration", "verdict": old, "reasons": [], "master": "s1", "sensors": {"s2": PLACE}, "edges": []}
        self.outcome = {"verdict": verdict, "reasons": list(reasons), "adopted": adopted}
        self.others = others  # None, "automatic" or "client": who started the running session
        stand_in = self

        class Handler(BaseHTTPRequestHandler):
            def answer(self, status, body):
                content = json.dumps(body).encode()
                self.send_response(status)
                self.send_header("Content-Type", "application/json")
                self.send_header("Content-Length", str(len(content)))
                self.end_headers()
                self.wfile.write(content)

            def do_GET(self):
                self.answer(*stand_in.get(self.path))

            def do_POST(self):
                body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
                stand_in.calls.append(("POST", self.path, body))
                self.answer(*stand_in.post())

            def do_DELETE(self):
                stand_in.calls.append(("DELETE", self.path))
                self.answer(*stand_in.delete())

            def log_message(self, *_):
                pass

        self.server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.url = f"http://127.0.0.1:{self.server.server_port}/"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def post(self):
        if self.others == "client":
            return 409, {"title": "Conflict", "detail": "a session is running already"}
        self.state = "collecting"
        return 202, self.registration()

    def delete(self):
        self.state = "idle"
        return 200, {}

    def registration(self):
        in_use = self.state == "idle" and self.mine and self.outcome["adopted"]
        return {**self.old, "verdict": self.outcome["verdict"] if in_use else self.old["verdict"],
                "session": {"sessionId": 41, "progress": self.SESSION, "state": self.state, "elapsedSeconds": self.looks,
                            "targetSeconds": 5, "reasons": []}}

    def session(self):
        self.looks += 1
        common = {"@type": "RegistrationSession", "sessionId": 41, "elapsedSeconds": self.looks, "targetSeconds": 5}
        if self.looks <= 3:
            return {**common, "state": "collecting", "verdict": "None", "adopted": False, "reasons": [],
                    "awaits": ["nobody is in sight" if self.looks == 1 else f"keep walking: {5 - self.looks} s more"]}
        if self.state == "collecting":
            self.state, self.mine = "idle", True
        return {**common, "state": "done", **self.outcome}

    def get(self, path):
        if path == "/sensors/":
            return 200, {"sensors": {"s1": {"state": "live", "ageMilliseconds": 12.5, "rateHz": 29.97, "bodies": 1,
                                            "weight": 0.5, "share": 0.75, "clockOffsetMilliseconds": -0.25,
                                            "url": "http://127.0.0.1:8081/"},
                                     "s2": {"state": "lost", "lastError": "connection refused"}}}
        if path == "/frame":
            return 200, {"captured": "2026-11-21T07:30:00Z",
                         "bodies": [{"bodyId": 7, "joints": {"Head": {"x": 0.1, "y": 1.6, "z": 2.5}}}]}
        return 200, self.session() if path == self.SESSION else self.registration()

    def close(self):
        self.server.shutdown()
        self.server.server_close()


class Server(unittest.TestCase):
    def stand_in(self, *arguments, **settings):
        server = FusionStandIn(*arguments, **settings)
        self.addCleanup(server.close)
        return server

    def test_register_follows_the_session_to_its_verdict(self):
        server = self.stand_in(old="None")
        code, out, error = chorus("register", "--url", server.url, "--seconds", "8", "--fresh")
        self.assertEqual(code, 0, error)
        self.assertEqual(server.calls, [("DELETE", "/registration"), ("POST", "/registration", {"seconds": 8.0})])
        self.assertEqual(server.looks, 4, "to its end and no further")
        self.assertIn("registration: Good, master s1", out)
        self.assertIn("s1 > s2", out)
        self.assertIn("walk through the room: 20% None\n", error)
        self.assertEqual(error.count("nobody is in sight"), 1, error)
        self.assertNotIn("\r", error, "plain lines where there is no terminal")

    def test_register_never_takes_an_old_verdict_for_its_own(self):
        server = self.stand_in("Refused", ["sensors s3 and s4 never saw the person together"], adopted=False, old="Good")
        code, out, error = chorus("register", "--url", server.url)
        self.assertEqual(code, 1)
        self.assertIn("sensors s3 and s4 never saw the person together", error)
        self.assertIn("registration: Good", out, "what is in use all the same")
        server = self.stand_in("Good", ["the registration in use places sensor s3, this walk does not"], adopted=False)
        self.assertEqual(chorus("register", "--url", server.url)[0], 1, "good, but not in use")
        server = self.stand_in("Refused", ["why"], adopted=False)
        code, out, _ = chorus("register", "--url", server.url, "--json")
        self.assertEqual((code, json.loads(out)["verdict"]), (1, "Refused"))
        self.assertEqual(json.loads(out)["registration"]["verdict"], "Good")

    def test_register_joins_the_session_that_runs(self):
        server = self.stand_in(others="automatic")
        self.assertEqual(chorus("register", "--url", server.url)[0], 0)
        server = self.stand_in("Refused", ["too narrow"], adopted=False, others="client")
        code, _, error = chorus("register", "--url", server.url)
        self.assertEqual(code, 1)
        self.assertIn("running already", error)
        self.assertIn("too narrow", error)

    def test_register_cancels(self):
        server = self.stand_in(others="client")
        code, out, _ = chorus("register", "--url", server.url, "--cancel")
        self.assertEqual((code, server.calls), (0, [("DELETE", server.SESSION)]))
        self.assertIn("cancelled", out)
        code, _, error = chorus("register", "--url", self.stand_in().url, "--cancel")
        self.assertEqual(code, 1)
        self.assertIn("no registration session runs", error)
        self.assertEqual(chorus("register", "--cancel", "--fresh")[0], 2)

    def test_register_passes_on_why_the_server_refuses(self):
        server = self.stand_in()
        server.post = lambda: (401, {"title": "Unauthorized", "detail": "a bearer token is needed"})
        code, _, error = chorus("register", "--url", server.url)
        self.assertEqual(code, 1)
        self.assertIn("a bearer token is needed", error)

    def test_register_and_status_speak_json(self):
        code, out, _ = chorus("register", "--url", self.stand_in().url, "--json")
        self.assertEqual((code, json.loads(out)["verdict"]), (0, "Good"))
        code, out, _ = chorus("status", "--url", self.stand_in().url, "--json")
        status = json.loads(out)
        self.assertEqual((code, status["sensors"]["s2"]["state"]), (0, "lost"))
        self.assertEqual(status["registration"]["verdict"], "Good")
        self.assertEqual(status["frame"]["bodies"][0]["bodyId"], 7)

    def test_status_shows_sensors_registration_and_bodies(self):
        server = self.stand_in()
        server.old |= {"reasons": ["a coat stand"], "awaits": ["sensor s5 has no place yet"], "storeProblem": "disk full",
                       "unplaced": {"s5": {"verdict": "Refused", "reasons": ["a coat stand"]}}}
        code, out, _ = chorus("status", "--url", server.url)
        self.assertEqual(code, 0)
        for text in ("live", "12.5", "30.0", "-0.250", "0.75", "s2: connection refused", "registration: Good",
                     "fused bodies: 1", "body 7: head at 0.100 1.600 2.500", "  a coat stand\n",
                     "next: sensor s5 has no place yet", "not stored: disk full"):
            self.assertIn(text, out)
        self.assertRegex(out, "s5 +Refused")

    def test_status_fails_when_no_sensor_is_live(self):
        server = self.stand_in()
        answers = server.get
        server.get = lambda path: (200, {"sensors": {"s1": {"state": "lost"}}}) if path == "/sensors/" else answers(path)
        code, out, error = chorus("status", "--url", server.url)
        self.assertEqual((code, error), (1, "no sensor is live\n"))
        self.assertIn("lost", out)
        self.assertEqual(chorus("status", "--url", server.url, "--json")[0], 1)

    def test_what_a_server_says_cannot_drive_the_terminal(self):
        evil = "\x1b[2J\x1b]0;owned\x07\x9b31m\nregistration: Good"
        server = self.stand_in("Refused", [evil], adopted=False)
        server.old |= {"verdict": evil, "reasons": [evil], "master": evil, "awaits": [evil], "storeProblem": evil}
        answers = server.get
        server.get = lambda path: (200, {"sensors": {"s1": {"state": "live", "lastError": evil, "url": evil}, evil: {}}}) \
            if path == "/sensors/" else answers(path)
        outputs = [chorus("status", "--url", server.url), chorus("status", "--url", server.url, "--json"),
                   chorus("register", "--url", server.url)]
        server.post = lambda: (401, {"title": evil, "detail": evil})
        outputs.append(chorus("register", "--url", server.url))
        for _, out, error in outputs:
            for text in (out, error):
                self.assertFalse([c for c in text if (ord(c) < 32 and c != "\n") or 127 <= ord(c) < 160], repr(text))
        self.assertFalse([line for line in outputs[0][1].splitlines() if line == "registration: Good"])

    def test_status_before_the_first_frame_and_without_a_server(self):
        server = self.stand_in()
        answers = server.get
        server.get = lambda path: (503, {"title": "no frame yet"}) if path == "/frame" else answers(path)
        code, out, _ = chorus("status", "--url", server.url)
        self.assertEqual(code, 0)
        self.assertIn("no fused frame yet", out)
        with socket.socket() as unused:
            unused.bind(("127.0.0.1", 0))
            port = unused.getsockname()[1]
        for command in ("status", "register"):
            code, _, error = chorus(command, "--url", f"http://127.0.0.1:{port}/")
            self.assertEqual(code, 1)
            self.assertIn("is chorus-fusion running there?", error)


def frame_at(url):
    request = urllib.request.Request(url + "frame", headers={"Accept": "application/json"})
    with urllib.request.urlopen(request, timeout=2) as answer:
        return json.load(answer)


def eventually(look, seconds=20):
    """Calls look() until its result is true, and returns that; an error counts as false."""
    deadline = time.monotonic() + seconds
    while True:
        try:
            if found := look():
                return found
        except OSError:
            pass
        if time.monotonic() > deadline:
            return None
        time.sleep(0.1)


@unittest.skipUnless((BIN / "chorus-sensor").exists(), "runs in builds with chorus-sensor")
class Replay(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.recordings = Path(folder.name)
        self.assertEqual(chorus("import", "pose2sim", CAMERAS, "--out", self.recordings)[0], 0)

    def start(self, *options):
        process = subprocess.Popen([BIN / "chorus", "replay", self.recordings, *options], text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def test_one_sensor_per_recording_in_step_until_told_to_stop(self):
        port = free_ports(4)
        process = self.start("--port", str(port), "--loop")
        lines = [process.stdout.readline().split() for _ in range(4)]
        self.assertEqual([line[:3] for line in lines],
                         [[f"cam0{i + 1}", "at", f"http://127.0.0.1:{port + i}/"] for i in range(4)])
        for i in range(4):
            frame = eventually(lambda i=i: frame_at(f"http://127.0.0.1:{port + i}/"))
            self.assertIsNotNone(frame, f"no frame of cam0{i + 1}")
            self.assertEqual(frame["source"], f"cam0{i + 1}")
        # In step: captures of all four lie on one 60 Hz grid.
        phases = [int(frame_at(f"http://127.0.0.1:{port + i}/")["capturedNanoseconds"]) % 16_666_667 for i in range(4)]
        spread = max(phases) - min(phases)
        self.assertLess(min(spread, 16_666_667 - spread), 1_000_000, phases)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=20), 0)
        for i in range(4):
            with self.assertRaises(OSError):
                frame_at(f"http://127.0.0.1:{port + i}/")

    def test_a_port_in_use_ends_all_of_them(self):
        port = free_ports(4)
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", port + 2))
            taken.listen()
            process = self.start("--port", str(port))
            self.assertEqual(process.wait(timeout=30), 1)
        self.assertIsNone(eventually(lambda: frame_at(f"http://127.0.0.1:{port}/"), seconds=1))


if __name__ == "__main__":
    unittest.main()
