"""A hall for tests: Debian's nats-server, cells of simulated sensors, and a raw NATS connection of a stranger."""
import json
import pathlib
import socket
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "tests/system/fusion")]
from nats_hall import NatsHall, cells_of, demo_hall, people_of, states_of  # noqa: E402
from rig import BIN, Process, Rig, free_port, get_json, send, wait_for  # noqa: E402, F401


class Hall(NatsHall, Rig):
    bin = BIN

    def setUp(self):
        super().setUp()
        self.place = pathlib.Path(self.folder.name)
        demo_hall.write(self.place)
        self.addCleanup(self.stop_server)

    def start_sensors(self, cell):
        ports = {}
        for i in range(demo_hall.SENSORS_PER_CELL):
            name, port = f"{cell}{i + 1}", free_port()
            process = Process("chorus-sensor", *demo_hall.sensor_arguments(name, port, self.place))
            self.processes.append(process)
            ports[name] = port
        return ports

    def start_cell(self, cell, sensors, **more):
        port = free_port()
        arguments = demo_hall.fusion_arguments(cell, port, sensors, self.place)
        extra = [word for key, value in more.items() for word in ("--set", f"{key}={value}")]
        process = Process("chorus-fusion", "--config", str(self.joined(cell)), *arguments, *extra)
        process.url = f"http://127.0.0.1:{port}/"
        self.processes.append(process)
        return process

    def cells(self, of):
        return cells_of(of.url)

    def states(self, of):
        return states_of(of.url)

    def people(self, of):
        return people_of(of.url)

    def frames_in(self, of, seconds):
        """How many frames the cell makes in a second."""
        first, began = get_json(of.url + "frame"), time.monotonic()
        time.sleep(seconds)
        last = get_json(of.url + "frame")
        return (last["sequence"] - first["sequence"]) / (time.monotonic() - began)


class Stranger:
    """A client that speaks NATS by hand: it may say anything."""

    def __init__(self, port, user, password):
        self.socket = socket.create_connection(("127.0.0.1", port), 10)
        self.socket.settimeout(10)
        self.file = self.socket.makefile("rb")
        self.file.readline()  # INFO
        connect = {"verbose": False, "pedantic": False, "user": user, "pass": password, "lang": "by hand", "version": "1"}
        self.send(f"CONNECT {json.dumps(connect)}\r\nPING\r\n".encode())
        self.answer = self.line()

    def send(self, data):
        self.socket.sendall(data)

    def line(self):
        """The next one that is for us: the server asks now and then whether we are there."""
        while (line := self.file.readline().decode().strip()) == "PING":
            self.send(b"PONG\r\n")
        return line

    def publish(self, subject, data):
        """What the server says of it: PONG, or an error."""
        self.send(f"PUB {subject} {len(data)}\r\n".encode() + data + b"\r\nPING\r\n")
        return self.line()

    def subscribe(self, subject):
        self.send(f"SUB {subject} 1\r\n".encode())

    def message(self):
        """(subject, bytes) of the next message."""
        while True:
            words = self.line().split()
            if words and words[0] == "MSG":
                data = self.file.read(int(words[-1]) + 2)[:-2]
                return words[1], data
            if not words:
                raise ConnectionError("the server closed the connection")

    def close(self):
        self.file.close()
        self.socket.close()
