#!/usr/bin/env python3
"""deploy/demo.sh --site: two cells, the NATS server by which they meet, and somebody who walks from one into the other and back.

Prints who is in the hall, under which id, and which cell answers for them, whenever that changes.  With --seconds it ends by itself:
code 0 only if the person kept one id in both cells and both have answered for them.
"""
import argparse
import json
import pathlib
import signal
import subprocess
import sys
import time
import urllib.error
import urllib.request

import demo_hall

START_WITHIN_S = 60


def fail(words):
    sys.exit(f"\ndemo: {words}")


def asked(url):
    request = urllib.request.Request(url, headers={"Accept": "application/json"})
    try:
        with urllib.request.urlopen(request, timeout=2) as answer:
            return json.load(answer)
    except (OSError, ValueError):
        return None


class Hall:
    def __init__(self, bin_folder, port, folder):
        self.bin, self.port, self.folder = pathlib.Path(bin_folder).resolve(), port, pathlib.Path(folder).resolve()
        self.children = {}

    def start(self, name, *command):
        with open(self.folder / f"{name}.log", "w", encoding="utf-8") as log:
            self.children[name] = subprocess.Popen(["setpriv", "--pdeathsig", "TERM", *map(str, command)], stdout=log, stderr=log,
                                                   start_new_session=True)

    def stop(self):
        for child in reversed(list(self.children.values())):
            child.terminate()
        for child in self.children.values():
            try:
                child.wait(timeout=5)
            except subprocess.TimeoutExpired:
                child.kill()

    def made(self, *words):
        done = subprocess.run([self.bin / "chorus", "init", *words], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            fail(f"chorus init {words[0]}: {done.stderr.strip()}")

    def base(self, cell):
        return f"http://127.0.0.1:{self.port + demo_hall.CELLS.index(cell)}/"

    def start_server(self):
        """As docs/guide/hall.md has it, on one host: an authority, a certificate, accounts, the server."""
        tls, site = self.folder / "tls", self.folder / "site"
        self.made("ca", "--out", self.folder / "ca", "--name", "Demo")
        self.made("certificate", "127.0.0.1", "localhost", "--authority", self.folder / "ca", "--out", tls)
        cells = [word for cell in demo_hall.CELLS for word in ("--cell", cell)]
        self.made("site", "--name", demo_hall.SITE, *cells, "--address", "127.0.0.1", "--listen", "127.0.0.1",
                  "--port", str(self.port + 2), "--tls", tls, "--store", self.folder / "store", "--out", site)
        self.start("nats-server", "nats-server", "-c", site / "nats-server.conf")

    def sensor_ports(self, cell):
        first = self.port + 3 + demo_hall.CELLS.index(cell) * demo_hall.SENSORS_PER_CELL
        return {f"{cell}{i + 1}": first + i for i in range(demo_hall.SENSORS_PER_CELL)}

    def start_sensors(self, cell):
        for name, port in self.sensor_ports(cell).items():
            self.start(name, self.bin / "chorus-sensor", *demo_hall.sensor_arguments(name, port, self.folder))

    def start_cell(self, cell):
        config = self.folder / f"{cell}.fusion.json"
        config.write_text("{}\n", encoding="utf-8")
        self.made("site", "--join", self.folder / "site" / f"{cell}.json", "--out", config)
        port = self.port + demo_hall.CELLS.index(cell)
        self.start(f"fusion-{cell}", self.bin / "chorus-fusion", "--config", config,
                   *demo_hall.fusion_arguments(cell, port, self.sensor_ports(cell), self.folder))

    def start_all(self):
        """The sensors last: cells that do not hear one another yet would name the same person twice."""
        demo_hall.write(self.folder)
        self.start_server()
        for cell in demo_hall.CELLS:
            self.start_cell(cell)
        self.wait_until("meet", self.connected)
        for cell in demo_hall.CELLS:
            self.start_sensors(cell)
        self.wait_until("see anybody", self.people)

    def wait_until(self, what, holds):
        """Until it holds in each cell."""
        deadline = time.monotonic() + START_WITHIN_S
        while not all(holds(cell) for cell in demo_hall.CELLS):
            for name, child in self.children.items():
                if child.poll() is not None:
                    fail(f"{name} ended; its log is {self.folder / name}.log\n" + (self.folder / f"{name}.log").read_text()[-1000:])
            if time.monotonic() > deadline:
                fail(f"the cells did not {what} within {START_WITHIN_S} s; logs are in {self.folder}")
            time.sleep(0.2)

    def connected(self, cell):
        cells = asked(self.base(cell) + "site/cells/")
        states = [each["state"] for each in (cells or {}).get("siteCells", {}).values()]
        return cells is not None and cells["connected"] and sorted(states) == ["heard", "own"]

    def people(self, cell):
        """{site id: the cell that answers}, as this cell sees it."""
        told = asked(self.base(cell) + "site/people/")
        return {} if told is None else {name: person["cell"] for name, person in told["sitePeople"].items()}


def watch(hall, seconds):
    """Until the time is over; whether one id was all there was, in both cells, and both answered for it."""
    began = time.monotonic()
    before, ids, answered = None, set(), set()
    while not seconds or time.monotonic() - began < seconds:
        now = {cell: hall.people(cell) for cell in demo_hall.CELLS}
        elapsed = time.monotonic() - began
        if now != before:
            words = "; ".join(f"cell {cell}: " + (", ".join(f"{i} ({owner} answers)" for i, owner in people.items()) or "nobody")
                              for cell, people in now.items())
            print(f"[{elapsed:6.1f} s] {words}", flush=True)
            before = now
        for people in now.values():
            ids |= people.keys()
            answered |= set(people.values())
        time.sleep(0.1)
    print(f"\nids: {', '.join(sorted(ids)) or 'none'}; cells that answered: {', '.join(sorted(answered)) or 'none'}")
    return len(ids) == 1 and answered == set(demo_hall.CELLS)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", required=True)
    parser.add_argument("--port", type=int, default=8080)
    parser.add_argument("--seconds", type=int, default=0)
    parser.add_argument("--folder", required=True)
    options = parser.parse_args()
    for name in (signal.SIGTERM, signal.SIGINT):
        signal.signal(name, lambda number, _: sys.exit(128 + number))
    hall = Hall(options.bin, options.port, options.folder)
    try:
        hall.start_all()
        print(f"cell a: {hall.base('a')}   cell b: {hall.base('b')}\n\n"
              f"  try:     curl -s -H 'Accept: application/json' {hall.base('a')}site/people/\n"
              f"           curl -s -H 'Accept: application/json' {hall.base('b')}site/cells/\n"
              f"           curl -s -H 'Accept: application/json' {hall.base('a')}site/frame\n", flush=True)
        kept = watch(hall, options.seconds)
    finally:
        hall.stop()
    if options.seconds and not kept:
        fail("the person did not stay one person in both cells")
    if options.seconds:
        print("delivered: one id in both cells")


if __name__ == "__main__":
    main()
