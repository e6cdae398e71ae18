"""Real chorus-sensor and chorus-fusion processes on free loopback ports, and fake sensors that lie."""
import http.server
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import urllib.error
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[3]
BIN = pathlib.Path(os.environ.get("CHORUS_BIN", ROOT / "build/dev/bin"))
sys.path.insert(0, str(ROOT / "tests/support"))
from ports import free_port  # noqa: E402

PATIENCE = 90.0  # seconds; generous for loaded machines, nothing should take that long


def get(url, accept="application/json", headers=None, timeout=10.0):
    """(status, headers, body) of a GET; an error status is returned, not raised."""
    request = urllib.request.Request(url, headers={"Accept": accept, **(headers or {})})
    return _open(request, timeout)


def send(method, url, body=b"", headers=None, timeout=10.0):
    return _open(urllib.request.Request(url, data=body or None, headers=headers or {}, method=method), timeout)


def _open(request, timeout):
    try:
        with urllib.request.urlopen(request, timeout=timeout) as answer:
            return answer.status, answer.headers, answer.read()
    except urllib.error.HTTPError as refusal:
        return refusal.code, refusal.headers, refusal.read()


def get_json(url, **more):
    return json.loads(get(url, **more)[2])


def wait_for(what, condition, patience=PATIENCE):
    """Polls until condition() is true and returns its value."""
    deadline = time.monotonic() + patience
    while True:
        try:
            value = condition()
        except (OSError, ValueError, KeyError):
            value = None
        if value:
            return value
        if time.monotonic() > deadline:
            raise AssertionError(f"not within {patience} s: {what}")
        time.sleep(0.05)


class Process:
    """A program with its log in a temporary file; killed when the test ends."""

    def __init__(self, name, *arguments):
        self.log = tempfile.NamedTemporaryFile("w+", suffix=f".{name}.log")
        # Its state is stored where no other run finds it, unless the test says where.
        self.state = tempfile.TemporaryDirectory()
        environment = {k: v for k, v in os.environ.items() if k != "STATE_DIRECTORY"}
        self.child = subprocess.Popen([str(BIN / name), *arguments], cwd=ROOT, stdout=self.log, stderr=self.log,
                                      env={**environment, "XDG_STATE_HOME": self.state.name})

    def text(self):
        return pathlib.Path(self.log.name).read_text()

    def alive(self):
        return self.child.poll() is None

    def stop(self, sig=signal.SIGTERM, patience=PATIENCE):
        if self.alive():
            self.child.send_signal(sig)
        return self.child.wait(timeout=patience)

    def kill(self):
        if self.alive():
            self.child.kill()
        self.child.wait()
        self.log.close()
        self.state.cleanup()


class Rig(unittest.TestCase):
    """setUp/tearDown for processes; subclasses start what they need."""

    def setUp(self):
        self.processes = []
        self.fakes = []
        self.folder = tempfile.TemporaryDirectory()

    def tearDown(self):
        result = self._outcome.result
        failed = any(test is self for test, _ in result.failures + result.errors)
        for process in self.processes:
            if failed:
                print(f"--- {process.child.args[0]}\n{process.text()[-3000:]}")
            process.kill()
        for fake in self.fakes:
            fake.close()
        self.folder.cleanup()

    def sensor(self, index, count=6, port=None, **settings):
        port = port or free_port()
        options = {"id": f"s{index + 1}", "http.port": port, "device.kind": "simulated",
                   "device.simulated.ring.index": index, "device.simulated.ring.count": count, **settings}
        arguments = [a for key, value in options.items() for a in ("--set", f"{key}={value}")]
        process = Process("chorus-sensor", "--config", "deploy/config/sensor.json", *arguments)
        self.processes.append(process)
        process.url = f"http://127.0.0.1:{port}/"
        process.port = port
        wait_for("the sensor answers", lambda: not process.alive() or get(process.url + "frame")[0] == 200)
        self.assertTrue(process.alive(), process.text())
        return process

    def fusion(self, sensors, wait=True, config="deploy/config/fusion.json", **settings):
        """sensors: {"s1": url}."""
        port = free_port()
        polled = json.dumps([{"id": k, "url": v} for k, v in sensors.items()])
        options = {"http.port": port, "sensors": polled, "viewer_dir": "", **settings}
        arguments = [a for key, value in options.items() for a in ("--set", f"{key}={value}")]
        process = Process("chorus-fusion", "--config", str(config), *arguments)
        self.processes.append(process)
        process.url = f"http://127.0.0.1:{port}/"
        process.port = port
        if wait:
            wait_for("the fusion server answers", lambda: not process.alive() or get(process.url + "frame")[0] == 200)
            self.assertTrue(process.alive(), process.text())
        return process

    def fake(self, respond):
        fake = FakeSensor(respond)
        self.fakes.append(fake)
        return fake

    def given_ring(self, count):
        """Extrinsics of the simulated ring, as a file: no walk needed."""
        path = pathlib.Path(self.folder.name) / "ring.json"
        path.write_text(json.dumps({"sensors": {f"s{i + 1}": ring_pose(i, count) for i in range(count)}}))
        return str(path)


def ring_pose(index, count, radius=3.0, height=1.6, pitch_deg=13.0):
    """Place `index` of `count` on a circle, looking at its centre and down; as in deploy/config/sensor.json."""
    import math
    yaw = 2 * math.pi * index / count
    position = (-radius * math.sin(yaw), height, -radius * math.cos(yaw))
    half_yaw, half_pitch = yaw / 2, math.radians(pitch_deg) / 2
    return dict(zip(("x", "y", "z"), position),
                qx=math.cos(half_yaw) * math.sin(half_pitch), qy=math.sin(half_yaw) * math.cos(half_pitch),
                qz=-math.sin(half_yaw) * math.sin(half_pitch), qw=math.cos(half_yaw) * math.cos(half_pitch))


class FakeSensor:
    """An HTTP server whose /frame is written by respond(handler)."""

    def __init__(self, respond):
        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_GET(self):
                if self.path != "/frame":
                    self.send_error(404)
                    return
                fake.requests += 1
                try:
                    respond(self)
                except OSError:
                    pass

            def log_message(self, *_):
                pass

        self.requests = 0
        fake = self
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        self.server.handle_error = lambda *_: None  # ignore clients that disconnect
        self.url = f"http://127.0.0.1:{self.server.server_port}/"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def close(self):
        self.server.shutdown()
        self.server.server_close()


def reply(handler, body, content_type="application/json", status=200):
    body = body.encode() if isinstance(body, str) else body
    handler.send_response(status)
    handler.send_header("Content-Type", content_type)
    handler.send_header("Content-Length", str(len(body)))
    handler.end_headers()
    handler.wfile.write(body)


def frame_json(source, captured_ns=None, bodies=(), sequence=1):
    ns = captured_ns if captured_ns is not None else time.time_ns()
    seconds, rest = divmod(ns, 10**9)
    iso = time.strftime("%Y-%m-%dT%H:%M:%S", time.gmtime(seconds)) + f".{rest:09d}Z"
    times = {"captured": iso, "capturedNanoseconds": str(ns)}
    return {"@id": "frame", "@type": "Frame", "sequence": sequence, **times, "source": source, "space": "SensorSpace",
            "bodies": [{"@id": f"skeletons/{i}", "@type": "Skeleton", "bodyId": i, **times, "joints": joints}
                       for i, joints in bodies]}


def joint(x, y, z, name="Neck"):
    return {name: {"@id": f"skeletons/1#{name}", "@type": "Joint", "x": x, "y": y, "z": z, "state": "Tracked"}}
