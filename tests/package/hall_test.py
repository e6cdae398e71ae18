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
  "cat /etc/chorus/fusion.json") case $1 in
    *joined*) printf '{ "sensors": [], /* of a hall */ "site": {"name": "hall"} }' ;;
    *broken*) echo '{ "sensors": [' ;;
    *bare*) exit 1 ;;
    *) printf '// "site": none\\n{ "title": "no // comment", /* "site": {}, */ "sensors": [] }\\n' ;;
  esac ;;
  "cat /etc/chorus/tls/ca.crt"*) echo AUTHORITY ;;
  "cat > /etc/chorus/site-ca.crt.new && "*"mv /etc/chorus/site-ca.crt.new /etc/chorus/site-ca.crt"*) cat > "$NOTES/ca.$1" ;;
  *"is-active"*) runs="[[ $1 != *deaf* ]]"  # or only now and then
    bash -c "looks=0; sleep() { :; }; systemctl() { looks=\\$((looks + 1)); $runs || [[ \\$looks != 2 ]]; }; $2" ;;
  "test -e /etc/chorus/site/a.json") [[ "$1" != *older* ]] ;;
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
        self.assertEqual(made[0], "admin@fusion-b | test -e /etc/chorus/site/nats-server.conf || { chorus init site --name hall --cell b --cell a --address 10.0.1.1 >/dev/null "
                                  "&& systemctl restart chorus-site; }")
        self.assertLess(commands.index(made[0]), commands.index("admin@fusion-b | systemctl enable --now chorus-site"))
        installed = [line for line in commands if "apt-get" in line]
        self.assertEqual(len(installed), 1)
        self.assertTrue(installed[0].endswith("|| DEBIAN_FRONTEND=noninteractive apt-get -q -y install nats-server"), installed[0])
        for host in ("root@10.0.0.1", "admin@fusion-b"):
            section = json.loads(self.noted(f"joined.{host}"))["site"]
            self.assertEqual(section, {"name": "hall", "password": PASSWORD, "ca": "/etc/chorus/site-ca.crt", "places": "/etc/chorus/places.json"})
            self.assertEqual(self.noted(f"ca.{host}"), "AUTHORITY\n", "the cells have authorities of their own")
            joined = [line for line in commands if line.startswith(host) and "init site --join" in line]
            self.assertEqual(len(joined), 1)
            self.assertTrue(joined[0].endswith(">/dev/null && systemctl restart chorus-fusion"), "a break leaves no cell that has joined and does not know it")
        self.assertNotIn(PASSWORD, self.noted("commands") + done.stdout + done.stderr)
        self.assertIn("chorus site register", done.stdout)

    def test_stops_debians_own_server_unless_somebody_has_set_it_up(self):
        self.run_it("join")
        command = next(line for line in self.noted("commands").splitlines() if "dpkg --verify" in line).split(" | ", 1)[1]
        for verify, unit, stopped in (("", True, True), ("??5?????? c /etc/nats-server.conf", True, False), ("", False, False)):
            fakes = (f"dpkg() {{ echo '{verify}'; }}; systemctl() {{ [[ $1 != cat ]] && {{ echo stopped; return; }}; {'true' if unit else 'false'}; }}; ")
            done = subprocess.run(["bash", "-c", fakes + command], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual("stopped" in done.stdout, stopped, (verify, unit))

    def test_keeps_a_cell_that_has_joined(self):
        self.cell("a", {"address": "10.0.0.1", "ssh": "root@joined"})
        done = self.run_it("join")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.noted("joined.root@joined"), "")
        self.assertNotRegex(self.noted("commands"), r"root@joined \| .*restart")
        self.assertEqual(self.noted("ca.root@joined"), "AUTHORITY\n", "it may be missing, or be another one by now")

    def test_does_not_join_a_cell_whose_configuration_it_cannot_read(self):
        for host, words in (("root@broken", "root@broken cannot be read"), ("root@bare", "lay it out first")):
            self.cell("a", {"address": "10.0.0.1", "ssh": host})
            done = self.run_it("join")
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(words, done.stderr)
            self.assertEqual(self.noted(f"joined.{host}"), "")

    def test_says_that_the_server_does_not_run(self):
        self.cell("b", {"address": "10.0.1.1", "ssh": "root@deaf"})
        done = self.run_it("join")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("the server does not run on root@deaf: journalctl -u chorus-site", done.stderr)
        self.assertNotIn("--join", self.noted("commands"))

    def test_says_that_the_server_was_made_for_other_cells(self):
        self.cell("b", {"address": "10.0.1.1", "ssh": "root@older"})
        done = self.run_it("join")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("has no account for cell a", done.stderr)
        self.assertEqual(self.noted("joined.root@10.0.0.1"), "")

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
                               ({"name": "my hall"}, "letters"), ({"more": 1}, "unknown key"),
                               ({"name": "-hall"}, "'-hall'"), ({"name": 5}, "the name 5"), ({"server": {}}, "it is one of a, b"), ({"server": None}, "it is one of a, b"),
                               ({"cells": {"-a": "a.json", "b": "b.json"}}, "'-a'"), ({"cells": {"a": 5, "b": "b.json"}}, "the inventory of cell a is 5"),
                               ({"cells": {"a": "-a.json", "b": "b.json"}}, "does not begin with -"), ({"cells": ["a", "b"]}, "two or more"),
                               ({"places": 5}, '"places" is 5'), ({"places": "a\nb"}, '"places" is'), ({"places": "-p.json"}, '"places" is')):
            self.refused(words, **changes)

    def test_says_what_is_wrong_with_an_inventory(self):
        for fusion, words in (({"address": "-oProxyCommand=x"}, "fusion.address is '-oProxyCommand=x'"), ({"address": "-v"}, "does not begin with -"),
                              ({"address": "10.0.0.1", "ssh": "-v"}, "fusion.ssh is '-v'"), ({"address": 5}, "fusion.address is 5"),
                              ({"address": "10.0.0.1", "ssh": ["root"]}, "fusion.ssh is ['root']"), ({}, 'no "address"')):
            (self.folder / "a.json").write_text(json.dumps({"fusion": fusion}))
            self.refused(words)
        for text, words in (("[]", 'needs an object "fusion"'), ('{"fusion": "10.0.0.1"}', 'needs an object "fusion"'), ("{", "a.json")):
            (self.folder / "a.json").write_text(text)
            self.refused(words)

    def refused(self, words, **changes):
        done = self.run_it("join", **changes)
        self.assertNotEqual(done.returncode, 0, changes)
        self.assertIn(words, done.stderr)
        self.assertNotIn("Traceback", done.stderr)
        self.assertEqual(self.noted("commands"), "", "nothing was touched")


if __name__ == "__main__":
    unittest.main()
