"""Fused frames for export tests: the real four-camera recording, and a stand-in for a fusion server that serves them."""

import http.server
import json
import os
import subprocess
import threading
import time
from pathlib import Path

BIN = Path(os.environ.get("CHORUS_BIN", "build/dev/bin"))
CAMERAS = "tests/data/pose2sim_mediapipe"


def chorus(*arguments, feed=None):
    """Runs chorus; returns its exit code, standard output (bytes) and standard error (text)."""
    done = subprocess.run([BIN / "chorus", *map(str, arguments)], capture_output=True, input=feed, timeout=60)
    return done.returncode, done.stdout, done.stderr.decode()


def fused_lines(folder):
    """The bytes of `chorus fuse`: one frame a line."""
    assert chorus("import", "pose2sim", CAMERAS, "--out", folder / "rec")[0] == 0
    code, out, error = chorus("fuse", folder / "rec", "--config", f"{CAMERAS}/fusion.json", "--registration",
                              folder / "rec" / "registration.json", "--out", "-")
    assert code == 0, error
    return out


def frames_with_bodies(lines):
    return [frame for frame in map(json.loads, lines.splitlines()) if frame["bodies"]]


class FakeFusion:
    """GET /frame with ETag and If-None-Match: each frame for 1/30 s, 503 before the first."""

    def __init__(self, lines):
        lines = [line for line in lines.splitlines() if line]
        began = time.monotonic() + 0.2
        self.served = 0  # frames
        fake = self

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                index = int((time.monotonic() - began) * 30)
                tag = f'"{min(index, len(lines) - 1)}"'
                status = 404 if self.path != "/frame" else 503 if index < 0 else 200
                if status == 200 and self.headers["If-None-Match"] == tag:
                    time.sleep(0.005)
                    status = 304
                body = lines[min(index, len(lines) - 1)] if status == 200 else b""
                fake.served += status == 200
                self.send_response(status)
                self.send_header("ETag", tag)
                if status != 304:
                    self.send_header("Content-Length", str(len(body)))
                self.end_headers()
                self.wfile.write(body)

            def log_message(self, *_):
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.url = f"http://127.0.0.1:{self.server.server_port}/"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def stop(self):
        self.server.shutdown()
        self.server.server_close()
