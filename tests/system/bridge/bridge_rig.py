"""A chorus-sensor whose device is `bridge`, and the senders of docs/guide/examples/bridge."""
import json
import pathlib
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
EXAMPLES = ROOT / "docs/guide/examples/bridge"
sys.path[:0] = [str(ROOT / "tests/system/fusion"), str(EXAMPLES)]
from rig import BIN, Process, Rig, get, get_json, send, wait_for  # noqa: E402, F401
from ports import free_port  # noqa: E402

HELLO = {"name": "test", "layout": "coco_17"}


def hello_line(**more):
    return json.dumps({"type": "hello", **HELLO, **more})


def frame_line(captured=None, x=0.0):
    points = [[x, 0.8 - 0.1 * i, 2.5] for i in range(17)]
    captured = time.time_ns() if captured is None else captured
    return json.dumps({"type": "frame", "captured": str(captured), "bodies": [{"id": 1, "points": points}]})


class BridgeRig(Rig):
    def bridge(self, name="s1", port=None, **settings):
        """A sensor with the URLs and the path of its local socket."""
        port = port or free_port()
        path = pathlib.Path(self.folder.name) / f"{name}.sock"
        options = {"id": name, "http.port": port, "device.kind": "bridge", "device.bridge.socket": path, **settings}
        arguments = [part for key, value in options.items() for part in ("--set", f"{key}={value}")]
        sensor = Process("chorus-sensor", "--config", "deploy/config/sensor.json", *arguments)
        self.processes.append(sensor)
        sensor.url, sensor.ws, sensor.path, sensor.port = f"http://127.0.0.1:{port}/", f"ws://127.0.0.1:{port}/push", str(path), port
        wait_for("the sensor answers", lambda: not sensor.alive() or get(sensor.url + "push")[0] == 200)
        self.assertTrue(sensor.alive(), sensor.text())
        wait_for("the local socket is there", lambda: path.exists() or "device.bridge.socket" in settings)
        return sensor

    def push_state(self, sensor):
        return get_json(sensor.url + "push")

    def health(self, sensor):
        status, _, body = get(sensor.url + "healthz")
        return status, json.loads(body).get("detail", "")
