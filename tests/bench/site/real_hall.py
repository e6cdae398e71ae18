"""A hall of real processes on loopback for chorus-bench site: nats-server, cells of simulated sensors, somebody who walks round."""
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/support"))
from nats_hall import (SERVER, NatsHall, NatsReader, Stream, cpu_seconds, demo_hall, free_port, get, people_of, states_of,  # noqa: E402, F401
                       wait_for)

LAP_S = 2 * math.pi * demo_hall.SCENE["reach_m"] / demo_hall.SCENE["speed_m_per_s"]


def percentile(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))] if ordered else math.nan


class RealHall(NatsHall):
    """Cells stand round the circle on which somebody walks; neighbours see a part of it in common.  Their worlds are the site's space."""

    def __init__(self, bin_folder, cells, sensors):
        self.bin = pathlib.Path(bin_folder).resolve()
        self.folder_object = tempfile.TemporaryDirectory()
        self.place = pathlib.Path(self.folder_object.name)
        self.cells, self.sensors = cells, sensors
        self.names = [chr(ord("a") + i) for i in range(cells)]
        self.children, self.urls = {}, {}
        places = {name: demo_hall.keys_of(((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))) for name in self.names}
        (self.place / "places.json").write_text(json.dumps({"cells": places}))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop_server()
        for child in reversed(list(self.children.values())):
            child.kill()
            child.wait()
        self.folder_object.cleanup()

    def spawn(self, name, *command):
        with open(self.place / f"{name}.log", "a", encoding="utf-8") as log:
            self.children[name] = subprocess.Popen(["setpriv", "--pdeathsig", "KILL", *map(str, command)], cwd=ROOT, stdout=log, stderr=log)
        return self.children[name]

    def kill(self, name):
        child = self.children.pop(name)
        child.kill()
        child.wait()

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
            file = self.place / f"{sensor}.json"
            file.write_text(json.dumps({"id": sensor, "http": {"port": port}, "device": device}))
            self.spawn(sensor, self.bin / "chorus-sensor", "--config", file)
            ports[sensor], registration[sensor] = port, demo_hall.keys_of(pose)
        (self.place / f"{name}.registration.json").write_text(json.dumps({"sensors": registration}))
        return ports

    def start_twin(self, index, sensor_ports):
        """A cell of the same sensors that is in no site; its name."""
        twin = f"{self.names[index]}-twin"
        shutil.copy(self.place / f"{self.names[index]}.registration.json", self.place / f"{twin}.registration.json")
        self.start_cell(index, sensor_ports, in_site=False, name=twin)
        return twin

    def start_cell(self, index, sensor_ports, in_site=True, server_port=None, more=(), name=None):
        name, port = name or self.names[index], free_port()
        words = demo_hall.fusion_arguments(name, port, sensor_ports, self.place)
        if in_site:
            config = self.joined(name)
            words += ["--set", f'site.servers=["nats://127.0.0.1:{server_port or self.server_port}"]']
        else:
            config = self.place / f"{name}.alone.json"
            config.write_text("{}\n")
            words = [each for pair in zip(words[::2], words[1::2]) if not pair[1].startswith("site.") for each in pair]
        words += [each for setting in more for each in ("--set", setting)]
        self.urls[name] = f"http://127.0.0.1:{port}/"
        self.spawn(f"fusion-{name}", self.bin / "chorus-fusion", "--config", config, *words)

    def start_all(self, to_server=lambda name: None):
        """The cells meet before anybody comes, so that nobody is named twice.  `to_server`: the port by which a cell gets there."""
        self.write_site(*self.names)
        self.start_server()
        ports = []
        for index in range(self.cells):
            ports.append(self.start_sensors(index))
            for sensor in ports[-1]:
                self.children[sensor].send_signal(19)  # SIGSTOP: nobody is seen yet
            self.start_cell(index, ports[-1], server_port=to_server(self.names[index]))
        for name in self.names:
            wait_for(f"{name} hears all", lambda name=name: self.states(name).count("heard") == self.cells - 1)
        for sensor in [each for some in ports for each in some]:
            self.children[sensor].send_signal(18)  # SIGCONT
        wait_for("somebody is named", lambda: self.people(self.names[0]))
        return ports

    def states(self, name):
        return list(states_of(self.urls[name]).values())

    def people(self, name):
        return people_of(self.urls[name])

    def fusion_pid(self, name):
        """Of the program itself; setpriv becomes it."""
        return self.children[f"fusion-{name}"].pid
