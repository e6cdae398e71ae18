"""deploy/hall.sh lays out each cell as workshop.sh does, and lets the cells meet; no password is on a command line or left in a file."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PASSWORD = "correct-horse"
FAKE_SSH = """#!/bin/bash
echo "$1 | $2" >> "$NOTES/commands"
case $2 in
  "grep -q"*) [[ "$1" == *joined* ]] ;;
  "cat /etc/chorus/tls/ca.crt"*) echo AUTHORITY ;;
  "cat > /etc/chorus/site-ca.crt") cat > "$NOTES/ca.$1" ;;
  "cat /etc/chorus/site/"*) printf '{"site": {"name": "hall", "password": "%s", "ca": "/etc/chorus/tls/ca.crt"}}' '""" + PASSWORD + """' ;;
  *"chorus init site --join"*) cat > "$NOTES/joined.$1" ;;
  "cat > /etc/chorus/places.json.new"*) cat > "$NOTES/places.$1" ;;
  "chorus doctor") [[ "$1" != *ill* ]] ;;
esac
"""


class ManyCells(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "ssh").write_text(FAKE_SSH)
        (self.folder / "ssh").chmod(0o755)
        self.cell("a", {"address": "10.0.0.1"})
        self.cell("b", {"address": "10.0.1.1", "ssh": "admin@fusion-b"})

    def cell(self, name, fusion):
        sensors = [{"id": "s1", "address": f"{fusion['address']}1"}]
        (self.folder / f"{name}.json").write_text(json.dumps({"fusion": fusion, "sensors": sensors}))

    def run_it(self, task, **changes):
        file = self.folder / "hall.json"
        file.write_text(json.dumps({"name": "hall", "server": "b", "cells": {"a": "a.json", "b": "b.json"}, **changes}))
        environment = {**os.environ, "CHORUS_SSH": str(self.folder / "ssh"), "NOTES": str(self.folder)}
        return subprocess.run(["deploy/hall.sh", str(file), task], cwd=ROOT, env=environment, capture_output=True, text=True, check=False)

    def noted(self, name):
        file = self.folder / name
        return file.read_text() if file.exists() else ""

    def test_starts_the_server_and_joins_every_cell(self):
        done = self.run_it("join")
        self.assertEqual(done.returncode, 0, done.stderr)
        commands = self.noted("commands").splitlines()
        made = [line for line in commands if "init site --name" in line]
        self.assertEqual(len(made), 1)
        self.assertIn("admin@fusion-b | test -e /etc/chorus/site/nats-server.conf || chorus init site --name hall --cell b --cell a --address 10.0.1.1", made[0])
        self.assertIn("admin@fusion-b | systemctl enable --now chorus-site", commands)
        for host in ("root@10.0.0.1", "admin@fusion-b"):
            section = json.loads(self.noted(f"joined.{host}"))["site"]
            self.assertEqual(section, {"name": "hall", "password": PASSWORD, "ca": "/etc/chorus/site-ca.crt", "places": "/etc/chorus/places.json"})
            self.assertEqual(self.noted(f"ca.{host}"), "AUTHORITY\n", "the cells have authorities of their own")
            self.assertIn(f"{host} | systemctl restart chorus-fusion", commands)
        self.assertNotIn(PASSWORD, self.noted("commands") + done.stdout + done.stderr)
        self.assertIn("chorus site register", done.stdout)

    def test_keeps_a_cell_that_has_joined(self):
        self.cell("a", {"address": "10.0.0.1", "ssh": "root@joined"})
        done = self.run_it("join")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.noted("joined.root@joined"), "")
        self.assertNotIn("root@joined | systemctl restart", self.noted("commands"))

    def test_gives_every_cell_the_places(self):
        self.assertIn("there is no file", self.run_it("places").stderr)
        (self.folder / "where.json").write_text('{"cells": {}}')
        done = self.run_it("places", places="where.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        for host in ("root@10.0.0.1", "admin@fusion-b"):
            self.assertEqual(self.noted(f"places.{host}"), '{"cells": {}}')
        self.assertIn("systemctl reload chorus-fusion", self.noted("commands"))

    def test_checks_every_cell_though_one_is_ill(self):
        self.assertEqual(self.run_it("check").returncode, 0)
        self.cell("b", {"address": "10.0.1.1", "ssh": "root@ill"})
        done = self.run_it("check")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("1 of 2 cells are not well", done.stderr)
        self.assertGreaterEqual(self.noted("commands").count("root@10.0.0.1 | chorus doctor"), 2)

    def test_says_what_is_wrong_with_the_file(self):
        for changes, words in (({"server": "c"}, "it is one of a, b"), ({"cells": {"a": "a.json"}}, "two or more"),
                               ({"cells": {"a": "a.json", "b": "none.json"}}, "none.json"), ({"cells": {"a": "a.json", "b": "a.json"}}, "the same host"),
                               ({"name": "my hall"}, "letters"), ({"more": 1}, "unknown key")):
            done = self.run_it("join", **changes)
            self.assertNotEqual(done.returncode, 0, changes)
            self.assertIn(words, done.stderr)
        self.assertEqual(self.noted("commands"), "", "nothing was touched")


if __name__ == "__main__":
    unittest.main()
