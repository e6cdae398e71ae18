"""Tests what the demo counts as "delivered" with artificial trackers: a good one, and each kind of bad one."""

import json
import subprocess
import sys
import threading
import time
import unittest
from contextlib import ExitStack
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

WATCHER = Path(__file__).resolve().parents[3] / "deploy/watch_tracker.py"
RUN_S = 3


class FakeTracker:
    """Answers /frame and /registration; `rate` frames per second, each with `bodies` bodies."""

    def __init__(self, rate, bodies, verdict="Provisional"):
        started = time.monotonic()

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self):
                frame = {"sequence": int(rate * (time.monotonic() - started)), "bodies": [{}] * bodies}
                registration = {"verdict": verdict, "reasons": ["keep walking"],
                                "sensors": {"s1": {"error": 0.080, "presentRadius": 0.012}},
                                "session": {"state": "collecting", "elapsedSeconds": 3, "targetSeconds": 30}}
                body = json.dumps(frame if self.path == "/frame" else registration).encode()
                self.send_response(200)
                self.send_header("Content-Length", str(len(body)))
                self.end_headers()
                self.wfile.write(body)

            def log_message(self, *_):
                pass

        self.server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def __enter__(self):
        return f"http://127.0.0.1:{self.server.server_address[1]}"

    def __exit__(self, *_):
        self.server.shutdown()
        self.server.server_close()


def start_watching(base, *more, seconds=RUN_S):
    return subprocess.Popen([sys.executable, "-B", WATCHER, "--base", base, "--seconds", str(seconds), *more],
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def watch(base):
    process = start_watching(base)
    process.output, process.errors = process.communicate(timeout=60)
    return process


class Verdict(unittest.TestCase):
    def test_a_tracker_at_30_hz_with_a_body_delivered(self):
        with FakeTracker(rate=30, bodies=1) as base:
            result = watch(base)
        self.assertEqual(result.returncode, 0, result.output)
        self.assertIn("first fused body", result.output)
        self.assertIn("keep walking", result.output)
        self.assertIn("known to within 12 mm (95 %)", result.output, "the radius, not the error of the chain")

    def test_bad_trackers_did_not(self):
        bad = {"stuck": (0, 1), "half the rate": (15, 1), "doubled frames": (60, 1), "nobody": (30, 0)}
        with ExitStack() as trackers:
            watchers = {what: start_watching(trackers.enter_context(FakeTracker(*how))) for what, how in bad.items()}
            for what, watcher in watchers.items():
                output, _ = watcher.communicate(timeout=60)
                with self.subTest(what):
                    self.assertEqual(watcher.returncode, 1, output)
                    self.assertIn("FAILED", output)

    def test_until_good_ends_early_and_only_when_good(self):
        with FakeTracker(30, 1, verdict="Good") as base:
            begun = time.monotonic()
            output, _ = start_watching(base, "--until-good", seconds=10).communicate(timeout=60)
            self.assertIn("delivered", output)
            self.assertLess(time.monotonic() - begun, 10.0)
        with FakeTracker(30, 1) as base:
            begun = time.monotonic()
            output, _ = start_watching(base, "--until-good").communicate(timeout=60)
            self.assertGreaterEqual(time.monotonic() - begun, RUN_S)

    def test_nobody_listening_is_a_failure_not_a_crash(self):
        with FakeTracker(30, 1) as base:
            pass
        result = watch(base)
        self.assertEqual(result.returncode, 1)
        self.assertIn("did not answer", result.output)
        self.assertEqual(result.errors, "")


if __name__ == "__main__":
    unittest.main()
