"""Every curl line and every example in our documents works against a running demo: each runs as printed, with other ports, in a folder that
contains the documents and receives the files that a line writes."""

import json
import os
import re
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
from ports import free_ports, is_listening  # noqa: E402

BIN = Path(os.environ["CHORUS_BIN"])
DOCUMENTED_FUSION_PORT = 8080
SENSORS = 6
START_WITHIN_S = 60
FIRST_BODY_WITHIN_S = 60
BLOCK = re.compile(r"^```sh\n(.*?)^```", re.DOTALL | re.MULTILINE)
SKIPPED = {"node_modules", "build", "var", ".git"}
# These pages need sensors of their own: bridge_guide_test.py, cameras_guide_test.py and inertial_guide_test.py run their lines.
TESTED_ALONE = {"docs/guide/bridge.md", "docs/guide/cameras.md", "docs/guide/inertial.md",
                "docs/guide/hall.md"}  # a hall has more than one fusion server: tests/system/site


def curl_lines():
    """(document, line) for every line of a shell block that calls curl or one of our examples."""
    for file in sorted(ROOT.rglob("*.md")):
        name = file.relative_to(ROOT)
        if SKIPPED & set(name.parts) or name.as_posix() in TESTED_ALONE:
            continue
        for block in BLOCK.findall(file.read_text(encoding="utf-8")):
            for line in block.replace("\\\n", " ").splitlines():
                if re.match(r"\s*(curl|python3 docs/guide/examples/\S+)\s", line):
                    yield name.as_posix(), line.strip()


def moved(line, first):
    """The line changed for a demo whose fusion server listens on `first`; it fails on HTTP errors."""
    for i in range(SENSORS + 1):
        line = line.replace(f"127.0.0.1:{DOCUMENTED_FUSION_PORT + i}", f"127.0.0.1:{first + i}")
    return re.sub(r"^curl\s", "curl --fail --max-time 20 ", line)


class CurlLines(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        (cls.folder / "docs").symlink_to(ROOT / "docs")
        cls.port = free_ports(SENSORS + 1)
        # What the demo keeps is kept for this test alone: an earlier run with this port has left a recording "walk", and a name is taken once.
        kept = [word for key, name in (("recording.folder", "recordings"), ("state_dir", "state"))
                for word in ("--set", f"{key}={cls.folder / name}")]
        cls.demo = subprocess.Popen(["deploy/demo.sh", "--bin", str(BIN), "--port", str(cls.port), *kept], cwd=ROOT,
                                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        cls.addClassCleanup(cls.stop)
        deadline = time.monotonic() + START_WITHIN_S
        while not is_listening(cls.port) and time.monotonic() < deadline:
            time.sleep(0.1)
        deadline = time.monotonic() + FIRST_BODY_WITHIN_S
        while not cls.has_body() and time.monotonic() < deadline:
            time.sleep(0.2)
        if not cls.has_body():
            raise RuntimeError(f"the demo shows no body; its logs are in var/demo/{cls.port}")

    @classmethod
    def stop(cls):
        cls.demo.terminate()
        cls.demo.wait(START_WITHIN_S)

    @classmethod
    def has_body(cls):
        try:
            request = urllib.request.Request(f"http://127.0.0.1:{cls.port}/frame", headers={"Accept": "application/json"})
            with urllib.request.urlopen(request, timeout=5) as answer:
                return bool(json.load(answer)["bodies"])
        except OSError:
            return False

    def test_every_documented_line_answers(self):
        lines = list(curl_lines())
        self.assertGreaterEqual(len(lines), 3, "the README has three")
        for document, line in lines:
            with self.subTest(document=document, line=line):
                result = subprocess.run(["bash", "-o", "pipefail", "-c", moved(line, self.port)],
                                        capture_output=True, text=True, timeout=60, cwd=self.folder)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertNotEqual(result.stdout.strip(), "")
                self.assertNotRegex(result.stdout, r"(?m)^null\b", "jq prints null for what is not there")


if __name__ == "__main__":
    unittest.main()
