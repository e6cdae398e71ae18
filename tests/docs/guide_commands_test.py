"""Every `chorus` line of docs/guide/research.md runs as printed, and every message that docs/guide/troubleshooting.md explains exists in
the code."""

import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
GUIDE = ROOT / "docs/guide"
BIN = Path(os.environ["CHORUS_BIN"])
BLOCK = re.compile(r"^```sh\n(.*?)^```", re.DOTALL | re.MULTILINE)
ROW = re.compile(r"^\| `([^`]+)` \|", re.MULTILINE)
JOINED_LITERALS = re.compile(r'"\s*\n\s*"')


def chorus_lines(page):
    blocks = BLOCK.findall((GUIDE / page).read_text(encoding="utf-8"))
    return [line for block in blocks for line in block.splitlines() if line.startswith("chorus ")]


def said_by_the_code():
    texts = []
    for room in ("common", "fusion-server", "services"):
        texts += [path.read_text(encoding="utf-8") for path in sorted((ROOT / room).rglob("*.cpp"))]
    return JOINED_LITERALS.sub("", "\n".join(texts))


class GuideCommands(unittest.TestCase):
    def test_every_line_for_researchers_does_what_it_says(self):
        lines = chorus_lines("research.md")
        self.assertGreaterEqual(len(lines), 8)
        paths = {**os.environ, "PATH": f"{BIN.resolve()}:{os.environ['PATH']}"}
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(ROOT / "tests", Path(folder) / "tests")
            for line in lines:
                with self.subTest(line=line):
                    done = subprocess.run(["bash", "-o", "pipefail", "-c", line], cwd=folder, env=paths,
                                          capture_output=True, text=True, timeout=60)
                    self.assertEqual(done.returncode, 0, done.stderr)
                    out = Path(folder) / line.rsplit("--out ", 1)[1].split()[0]
                    self.assertTrue(out.is_dir() or out.stat().st_size > 1000, f"{out.name} is empty")

    def test_every_explained_message_is_one_of_ours(self):
        messages = ROW.findall((GUIDE / "troubleshooting.md").read_text(encoding="utf-8"))
        self.assertGreaterEqual(len(messages), 15)
        said = said_by_the_code()
        self.assertEqual([message for message in messages if message not in said], [])


if __name__ == "__main__":
    unittest.main()
