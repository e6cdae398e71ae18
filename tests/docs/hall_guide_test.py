"""docs/guide/hall.md: at most six commands, those of ours run as printed, and the file of places is one that the server takes."""
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BIN = Path(os.environ["CHORUS_BIN"])
PAGE = (ROOT / "docs/guide/hall.md").read_text(encoding="utf-8")
SERVER = shutil.which("nats-server", path="/usr/sbin:/usr/bin:/usr/local/bin:/sbin")


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)


def commands():
    section = PAGE.split("## Six commands")[1].split("\n## ")[0]
    return [line for block in re.findall(r"^```sh\n(.*?)^```", section, re.DOTALL | re.MULTILINE) for line in block.splitlines()]


class HallGuide(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_ours(self, *words):
        done = subprocess.run([BIN / words[0], *map(str, words[1:])], cwd=self.folder, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def ours(self, start):
        line = next(line for line in commands() if line.startswith("sudo chorus init site " + start))
        return line.split()[1:]

    def test_there_are_at_most_six(self):
        self.assertEqual(len(commands()), 6)

    def test_they_make_a_site_and_a_cell_of_it(self):
        self.run_ours(*self.ours("--name"), "--no-tls", "--store", self.folder / "store", "--out", self.folder / "site")
        if SERVER:
            config = (self.folder / "site/nats-server.conf")
            checked = subprocess.run([SERVER, "-t", "-c", config], capture_output=True, text=True)
            self.assertEqual(checked.returncode, 0, checked.stderr)
        shutil.copy(self.folder / "site/a.json", self.folder / "a.json")
        fusion = self.folder / "fusion.json"
        fusion.write_text('{\n  // ours\n  "http": { "port": 0 }, "state_dir": ""\n}\n')
        self.run_ours(*self.ours("--join"), "--out", fusion)
        self.assertIn("// ours", fusion.read_text())
        places = self.folder / "places.json"
        places.write_text(blocks("json")[0])
        self.run_ours("chorus-fusion", "--check", "--config", fusion, "--set", f"site.places={places}")
        self.assertEqual(set(json.loads(blocks("json")[0])["cells"]), {"a", "b"})


if __name__ == "__main__":
    unittest.main()
