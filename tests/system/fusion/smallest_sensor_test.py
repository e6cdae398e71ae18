"""docs/guide/examples/smallest_sensor.py with a real fusion server: its person is tracked, and no frame is missed."""

import json
import os
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.error
import urllib.request
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from ports import free_ports  # noqa: E402

ROOT = Path(__file__).resolve().parents[3]
FUSION = Path(os.environ["CHORUS_BIN"]) / "chorus-fusion"
SEEN_WITHIN_S = 90
WATCHED_S = 3
PLACE = {"x": 0, "y": 1.2, "z": 0, "qx": 0, "qy": 0, "qz": 0, "qw": 1}  # according to its floor plane


def asked(url):
    request = urllib.request.Request(url, headers={"Accept": "application/json"})
    try:
        with urllib.request.urlopen(request, timeout=5) as answer:
            return json.load(answer)
    except (urllib.error.URLError, ConnectionError, TimeoutError):
        return {}


class SmallestSensor(unittest.TestCase):
    def start(self, *command):
        process = subprocess.Popen([str(word) for word in command], cwd=ROOT, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)

    def test_its_person_is_tracked(self):
        port = free_ports(2)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        places = Path(folder.name) / "registration.json"
        places.write_text(json.dumps({"sensors": {"s1": PLACE}}))
        self.start(sys.executable, "-B", "docs/guide/examples/smallest_sensor.py", port + 1, "s1")
        sensors = json.dumps([{"id": "s1", "url": f"http://127.0.0.1:{port + 1}/"}])
        self.start(FUSION, "--set", f"http.port={port}", "--set", f"sensors={sensors}", "--set", "viewer_dir=",
                   "--set", f"registration.file={places}", "--set", "registration.auto=false")
        base = f"http://127.0.0.1:{port}"
        deadline = time.monotonic() + SEEN_WITHIN_S
        bodies = []
        while not bodies and time.monotonic() < deadline:
            time.sleep(0.1)
            bodies = asked(f"{base}/frame").get("bodies", [])
        self.assertEqual(len(bodies), 1, asked(f"{base}/sensors/"))
        head = bodies[0]["joints"]["Head"]
        self.assertAlmostEqual(head["y"], 1.65, delta=0.05)

        def counts():
            return asked(f"{base}/sensors/")["sensors"]["s1"], asked(f"http://127.0.0.1:{port + 1}/frame")["sequence"]

        before, first = counts()
        time.sleep(WATCHED_S)
        sensor, last = counts()
        self.assertEqual(sensor["state"], "live", sensor)
        came = sensor["framesReceived"] - before["framesReceived"]
        # A poller that waits for nothing gets each frame; 10 are allowed for between the two questions and for a busy machine.
        self.assertGreater(came, 0.7 * (last - first) - 10, "every frame comes, and at once")


if __name__ == "__main__":
    unittest.main()
