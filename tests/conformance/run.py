"""Starts the demo on free ports, waits until it tracks a person, and runs a command that uses it as a client.

usage: run.py COMMAND...   CHORUS_BIN is the folder of the programs. The command finds the services in CHORUS_FUSION_URL and
CHORUS_SENSOR_URL; run.py exits with its exit code.
"""

import json
import os
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
from ports import free_ports  # noqa: E402

SENSORS = 6
TRACKS_WITHIN_S = 120  # on a loaded machine
STOPS_WITHIN_S = 15
COMMAND_TIMEOUT_S = 300


def tracks_somebody(base):
    try:
        request = urllib.request.Request(base + "/frame", headers={"Accept": "application/json"})
        with urllib.request.urlopen(request, timeout=5) as answer:
            return bool(json.load(answer)["bodies"])
    except (OSError, ValueError):
        return False


def main(command):
    port = free_ports(SENSORS + 1)
    base = f"http://127.0.0.1:{port}"
    demo = subprocess.Popen(["deploy/demo.sh", "--bin", os.environ["CHORUS_BIN"], "--port", str(port),
                             "--set", 'http.allowed_origin="null"'], cwd=ROOT,  # for pages opened as files
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    try:
        deadline = time.monotonic() + TRACKS_WITHIN_S
        while not tracks_somebody(base):
            if time.monotonic() > deadline or demo.poll() is not None:
                sys.exit(f"the demo did not track anybody within {TRACKS_WITHIN_S} s; its logs are in var/demo/{port}/")
            time.sleep(0.2)
        environment = os.environ | {"CHORUS_FUSION_URL": base, "CHORUS_SENSOR_URL": f"http://127.0.0.1:{port + 1}"}
        return subprocess.run(command, cwd=ROOT, env=environment, timeout=COMMAND_TIMEOUT_S).returncode
    finally:
        demo.terminate()
        demo.wait(STOPS_WITHIN_S)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
