"""Every `chorus` line of docs/guide/export.md runs as printed, in order, and writes the files it names."""

import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/system/export"))
from fused_source import BIN, FakeFusion, frames_with_bodies  # noqa: E402

GUIDE = ROOT / "docs/guide/export.md"
BLOCK = re.compile(r"^```sh\n(.*?)^```", re.DOTALL | re.MULTILINE)
SERVER = "http://127.0.0.1:8080/"


def guide_lines():
    blocks = BLOCK.findall(GUIDE.read_text(encoding="utf-8"))
    return [line for block in blocks for line in block.splitlines() if line.startswith("chorus ")]


class ExportGuide(unittest.TestCase):
    def test_every_line_does_what_it_says(self):
        lines = guide_lines()
        self.assertGreaterEqual(len(lines), 10)
        paths = {**os.environ, "PATH": f"{BIN.resolve()}:{os.environ['PATH']}"}
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(ROOT / "tests", Path(folder) / "tests")
            server = None
            for line in lines:
                if SERVER in line:
                    frames = frames_with_bodies((Path(folder) / "fused.ndjson").read_bytes())
                    server = FakeFusion("\n".join(map(json.dumps, frames)).encode())
                    line = line.replace(SERVER, server.url)
                with self.subTest(line=line):
                    done = subprocess.run(["bash", "-o", "pipefail", "-c", line], cwd=folder, env=paths,
                                          capture_output=True, text=True, timeout=60)
                    self.assertEqual(done.returncode, 0, done.stderr)
                    out = Path(folder) / line.rsplit("--out ", 1)[1].split()[0]
                    self.assertTrue(out.is_dir() or out.stat().st_size > 1000, f"{out.name} is empty")
            server.stop()


if __name__ == "__main__":
    unittest.main()
