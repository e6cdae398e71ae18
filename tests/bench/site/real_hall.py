"""A hall of real processes on loopback for chorus-bench site: nats-server, cells of simulated sensors, somebody who walks round."""
import json
import math
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "deploy"), str(ROOT / "tests/support")]
import demo_hall  # noqa: E402
from ports import free_port  # noqa: E402

SERVER = shutil.which("nats-server", path="/usr/sbin:/usr/bin:/usr/local/bin:/sbin")
PATIENCE_S = 90
LAP_S = 2 * math.pi * demo_hall.SCENE["reach_m"] / demo_hall.SCENE["speed_m_per_s"]


def get(url):
    request = urllib.request.Request(url, headers={"Accept": "application/json"})
    with urllib.request.urlopen(request, timeout=5) as answer:
        return json.load(answer)


def wait_for(what, condition, patience=PATIENCE_S):
    deadline = time.monotonic() + patience
    while time.monotonic() < deadline:
        try:
            value = condition()
        except (OSError, ValueError, KeyError):
            value = None
        if value:
            return value
        time.sleep(0.02)
    raise SystemExit(f"not within {patience} s: {what}")


def percentile(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))] if ordered else math.nan


def cpu_seconds(pid):
    words = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


class RealHall:
    """Cells stand round the circle on which somebody walks; neighbours see a part of it in common.  Their worlds are the site's space."""

    def __init__(self, bin_folder, cells, sensors):
        self.bin = pathlib.Path(bin_folder).resolve()
        self.folder_object = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.folder_object.name)
        self.cells, self.sensors = cells, sensors
        self.names = [chr(ord("a") + i) for i in range(cells)]
        self.children, self.urls, self.server = {}, {}, None
        self.server_port = free_port()
        places = {name: demo_hall.keys_of(((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))) for name in self.names}
        (self.folder / "places.json").write_text(json.dumps({"cells": places}))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop_server()
        for child in reversed(list(self.children.values())):
            child.kill()
            child.wait()
        self.folder_object.cleanup()

    def spawn(self, name, *command):
        with open(self.folder / f"{name}.log", "a", encoding="utf-8") as log:
            self.children[name] = subprocess.Popen(["setpriv", "--pdeathsig", "KILL", *map(str, command)], cwd=ROOT, stdout=log, stderr=log)
        return self.children[name]

    def kill(self, name):
        child = self.children.pop(name)
        child.kill()
        child.wait()

    def init(self, *words):
        done = subprocess.run([self.bin / "chorus", "init", "site", *map(str, words)], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise SystemExit(done.stderr)

    def write_site(self):
        cells = [word for name in self.names for word in ("--cell", name)]
        self.init("--name", "hall", *cells, "--address", "127.0.0.1", "--listen", "127.0.0.1", "--port", self.server_port, "--no-tls",
                  "--store", self.folder / "store", "--out", self.folder / "site")

    def start_server(self):
        if SERVER is None:
            raise SystemExit("needs nats-server (apt install nats-server)")
        with open(self.folder / "nats.log", "a", encoding="utf-8") as log:
            self.server = subprocess.Popen([SERVER, "-c", self.folder / "site/nats-server.conf"], stdout=log, stderr=log)
        wait_for("the server answers", lambda: socket.create_connection(("127.0.0.1", self.server_port), 1).close() or True)

    def stop_server(self):
        if self.server is not None:
            self.server.kill()
            self.server.wait()
        self.server = None

    def sensor_poses(self, index):
        """(settings, pose in the world) of a cell's sensors, side by side on its side of the hall."""
        about = 360.0 * index / self.cells
        for i in range(self.sensors):
            aside = 1.2 * (i - (self.sensors - 1) / 2)
            place = demo_hall.rotated(demo_hall.turned(about, (0, 1, 0)), (aside, demo_hall.HEIGHT_M, -demo_hall.ASIDE_M))
            settings = {"x_m": place[0], "y_m": place[1], "z_m": place[2], "yaw_deg": (about + 180) % 360 - 180, "pitch_deg": demo_hall.PITCH_DEG}
            turn = demo_hall.multiplied(demo_hall.turned(about, (0, 1, 0)), demo_hall.turned(demo_hall.PITCH_DEG, (1, 0, 0)))
            yield settings, (place, turn)

    def start_sensors(self, index):
        name, ports, registration = self.names[index], {}, {}
        for i, (settings, pose) in enumerate(self.sensor_poses(index)):
            sensor, port = f"{name}{i + 1}", free_port()
            device = {"kind": "simulated", "simulated": {"scene": demo_hall.SCENE, "pose": settings}}
            file = self.folder / f"{sensor}.json"
            file.write_text(json.dumps({"id": sensor, "http": {"port": port}, "device": device}))
            self.spawn(sensor, self.bin / "chorus-sensor", "--config", file)
            ports[sensor], registration[sensor] = port, demo_hall.keys_of(pose)
        (self.folder / f"{name}.registration.json").write_text(json.dumps({"sensors": registration}))
        return ports

    def start_cell(self, index, sensor_ports, in_site=True):
        name, port = self.names[index], free_port()
        config = self.folder / f"{name}.fusion.json"
        if in_site and not config.exists():
            config.write_text("{}\n")
            self.init("--join", self.folder / f"site/{name}.json", "--out", config)
        words = demo_hall.fusion_arguments(name, port, sensor_ports, self.folder)
        if not in_site:
            config = self.folder / f"{name}.alone.json"
            config.write_text("{}\n")
            words = [each for pair in zip(words[::2], words[1::2]) if not pair[1].startswith("site.") for each in pair]
        self.urls[name] = f"http://127.0.0.1:{port}/"
        self.spawn(f"fusion-{name}", self.bin / "chorus-fusion", "--config", config, *words)

    def start_all(self):
        """The cells meet before anybody comes, so that nobody is named twice."""
        self.write_site()
        self.start_server()
        ports = []
        for index in range(self.cells):
            ports.append(self.start_sensors(index))
            for sensor in ports[-1]:
                self.children[sensor].send_signal(19)  # SIGSTOP: nobody is seen yet
            self.start_cell(index, ports[-1])
        for name in self.names:
            wait_for(f"{name} hears all", lambda name=name: self.states(name).count("heard") == self.cells - 1)
        for sensor in [each for some in ports for each in some]:
            self.children[sensor].send_signal(18)  # SIGCONT
        wait_for("somebody is named", lambda: self.people(self.names[0]))
        return ports

    def states(self, name):
        return [cell["state"] for cell in get(self.urls[name] + "site/cells/").get("siteCells", {}).values()]

    def people(self, name):
        return get(self.urls[name] + "site/people/").get("sitePeople", {})

    def fusion_pid(self, name):
        """Of the program itself; setpriv becomes it."""
        return self.children[f"fusion-{name}"].pid

    def password(self, user):
        whole = json.loads((self.folder / f"site/{user}.json").read_text())
        return whole.get("password") or whole["site"]["password"]


class Stream:
    """The messages of an event stream, as they come; non-blocking."""

    def __init__(self, url, path):
        host, port = re.fullmatch(r"http://([^:]+):(\d+)/", url).groups()
        self.socket = socket.create_connection((host, int(port)), 10)
        self.socket.sendall(f"GET /{path} HTTP/1.1\r\nHost: {host}\r\nAccept: text/event-stream\r\n\r\n".encode())
        self.socket.setblocking(False)
        self.bytes = b""

    def fileno(self):
        return self.socket.fileno()

    def documents(self):
        """(time of arrival, document) of each that is complete."""
        try:
            piece = self.socket.recv(1 << 20)
        except BlockingIOError:
            return
        if not piece:
            raise SystemExit("the event stream ended")
        now = time.time_ns()
        *whole, self.bytes = (self.bytes + piece).split(b"\n")
        for line in whole:
            if line.startswith(b"data:"):
                try:
                    yield now, json.loads(line[5:])
                except ValueError:
                    continue


class NatsReader:
    """Listens to a subject by hand."""

    def __init__(self, port, user, password, subject):
        self.socket = socket.create_connection(("127.0.0.1", port), 10)
        words = {"verbose": False, "pedantic": False, "user": user, "pass": password}
        self.socket.sendall(f"CONNECT {json.dumps(words)}\r\nSUB {subject} 1\r\n".encode())
        self.socket.setblocking(False)
        self.bytes = b""

    def fileno(self):
        return self.socket.fileno()

    def documents(self):
        try:
            self.bytes += self.socket.recv(1 << 20)
        except BlockingIOError:
            return
        now = time.time_ns()
        while (end := self.bytes.find(b"\r\n")) >= 0:
            line = self.bytes[:end]
            if not line.startswith(b"MSG "):
                if line.startswith(b"PING"):
                    self.socket.sendall(b"PONG\r\n")
                self.bytes = self.bytes[end + 2:]
                continue
            size = int(line.split()[-1])
            if len(self.bytes) < end + 2 + size + 2:
                return
            yield now, json.loads(self.bytes[end + 2:end + 2 + size])
            self.bytes = self.bytes[end + 4 + size:]
