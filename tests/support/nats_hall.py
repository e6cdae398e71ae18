"""A hall of real processes on loopback: Debian's nats-server with an account for each cell, and what its cells say over HTTP.

Without TLS, so that strangers can speak plainly; deploy/demo.sh --site is the test of TLS.
"""
import json
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import time
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "deploy"))
import demo_hall  # noqa: E402
from ports import free_port  # noqa: E402

SERVER = shutil.which("nats-server", path="/usr/sbin:/usr/bin:/usr/local/bin:/sbin")
PATIENCE_S = 90


def get(url):
    request = urllib.request.Request(url, headers={"Accept": "application/json"})
    with urllib.request.urlopen(request, timeout=5) as answer:
        return json.load(answer)


def wait_for(what, condition, patience=PATIENCE_S):
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
        time.sleep(0.02)


class NatsHall:
    """The server and its accounts.  Whoever inherits this says `bin` (the programs) and `place` (a folder)."""

    server = None
    server_port = 0

    def init_site(self, *words):
        done = subprocess.run([pathlib.Path(self.bin) / "chorus", "init", "site", *map(str, words)], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise AssertionError(done.stderr)

    def write_site(self, *cells, port=None):
        self.server_port = port or free_port()
        self.init_site("--name", demo_hall.SITE, *[word for cell in cells for word in ("--cell", cell)], "--address", "127.0.0.1",
                       "--listen", "127.0.0.1", "--port", self.server_port, "--no-tls", "--store", self.place / "store", "--out", self.place / "site")

    def start_server(self):
        if SERVER is None:
            raise AssertionError("needs nats-server (apt install nats-server)")
        with open(self.place / "nats.log", "a", encoding="utf-8") as log:
            self.server = subprocess.Popen([SERVER, "-c", self.place / "site/nats-server.conf"], stdout=log, stderr=log)
        wait_for("the server answers", lambda: socket.create_connection(("127.0.0.1", self.server_port), 1).close() or True)

    def stop_server(self):
        if self.server is not None:
            self.server.kill()
            self.server.wait()
        self.server = None

    def joined(self, cell):
        """The configuration of a cell with its section "site"."""
        config = self.place / f"{cell}.fusion.json"
        if not config.exists():
            config.write_text("{}\n")
            self.init_site("--join", self.place / f"site/{cell}.json", "--out", config)
        return config

    def password(self, user):
        whole = json.loads((self.place / f"site/{user}.json").read_text())
        return whole.get("password") or whole["site"]["password"]


def cells_of(url):
    return get(url + "site/cells/")


def states_of(url):
    """By the name of the cell."""
    return {name: cell["state"] for name, cell in cells_of(url).get("siteCells", {}).items()}


def people_of(url):
    return get(url + "site/people/").get("sitePeople", {})


def cpu_seconds(pid):
    words = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


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
            raise AssertionError("the event stream ended")
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
