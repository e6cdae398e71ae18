"""Every `chorus` line of docs/guide/ergonomics.md runs as printed, in order, and writes the files it names; wrong inputs are refused."""

import csv
import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BIN = Path(os.environ["CHORUS_BIN"])
GUIDE = ROOT / "docs/guide/ergonomics.md"
BLOCK = re.compile(r"^```sh\n(.*?)^```", re.DOTALL | re.MULTILINE)


def guide_lines():
    blocks = BLOCK.findall(GUIDE.read_text(encoding="utf-8"))
    return [line for block in blocks for line in block.splitlines() if line.startswith("chorus ")]


class ErgonomicsGuide(unittest.TestCase):
    def run_in(self, folder, line):
        paths = {**os.environ, "PATH": f"{BIN.resolve()}:{os.environ['PATH']}"}
        return subprocess.run(["bash", "-c", line], cwd=folder, env=paths, capture_output=True, text=True, timeout=60)

    def test_every_line_does_what_it_says(self):
        lines = guide_lines()
        self.assertGreaterEqual(len(lines), 6)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            os.symlink(ROOT / "tests", folder / "tests")
            for line in lines:
                with self.subTest(line=line):
                    done = self.run_in(folder, line)
                    self.assertEqual(done.returncode, 0, done.stderr)
            self.check_summary(json.loads((folder / "summary.json").read_text()))
            with open(folder / "scores.csv", newline="") as file:
                rows = list(csv.DictReader(file))
            self.assertEqual({row["method"] for row in rows}, {"reba", "owas"})
            self.assertTrue(any(row["set_from"] for row in rows))
            sheet = (folder / "sheet.html").read_text()
            self.assertIn("keine zertifizierte Bewertung", sheet)
            self.assertNotIn("http://", sheet)
            self.assertGreater((folder / "scores.mcap").stat().st_size, 1000)
            self.check_refusals(folder)

    def check_summary(self, summary):
        person = summary["persons"][0]
        reba = person["methods"]["reba"]
        self.assertGreater(reba["scoredShare"], 0.5)
        self.assertAlmostEqual(sum(level["share"] for level in reba["levels"]), 1.0, places=2)
        self.assertEqual(person["phases"][0]["name"], "with a crate")

    def check_refusals(self, folder):
        newtons = folder / "newtons.json"
        newtons.write_text('{"loadKg": 981}')
        beyond = folder / "beyond.json"
        beyond.write_text('{"phases": [{"name": "p", "fromSeconds": 1, "toSeconds": 9999, "loadKg": 3}]}')
        for line, says in [("chorus score fused.ndjson --method rebba", "did you mean reba?"),
                           (f"chorus score fused.ndjson --task {newtons}", "newtons"),
                           (f"chorus score fused.ndjson --task {beyond}", "recording lasts"),
                           ("chorus score fused.ndjson --person 999", "there are:")]:
            with self.subTest(line=line):
                done = self.run_in(folder, line)
                self.assertEqual(done.returncode, 1, done.stdout)
                self.assertIn(says, done.stderr)


if __name__ == "__main__":
    unittest.main()
