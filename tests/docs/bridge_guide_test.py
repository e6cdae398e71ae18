"""Every line of docs/guide/bridge.md runs as printed, on free ports; its output appears, and every message that the page explains exists in
the code."""

import json
import os
import re
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
sys.path.insert(0, str(Path(__file__).resolve().parent))
from guide_commands_test import ROW, said_by_the_code  # noqa: E402
from ports import free_ports  # noqa: E402

BIN = Path(os.environ["CHORUS_BIN"])
PAGE = (ROOT / "docs/guide/bridge.md").read_text(encoding="utf-8")
LINES = [line for block in re.findall(r"^```sh\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE) for line in block.splitlines() if line]
PRINTED_PORTS = range(8080, 8085)
PATIENCE_S = 90
READY = {"/push": '"frames"', "/frame": '"Skeleton"'}  # the output to wait for, by what a line requests


class BridgeGuide(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        first = free_ports(len(PRINTED_PORTS))
        self.ports = {str(port): str(first + port - PRINTED_PORTS[0]) for port in PRINTED_PORTS}
        self.paths = {**os.environ, "PATH": f"{BIN.resolve()}:{os.environ['PATH']}", "XDG_STATE_HOME": self.folder.name}

    def adapted(self, line):
        line = re.sub(r"\b80(8\d)\b", lambda port: self.ports[port.group(0)], line)
        return line.replace("/tmp/", self.folder.name + "/")

    def start(self, line):
        process = subprocess.Popen(["bash", "-c", "exec " + line.removesuffix("&")], cwd=ROOT, env=self.paths,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)
        time.sleep(1)  # the time a person would need to type the next line

    def run_line(self, line):
        return subprocess.run(["bash", "-o", "pipefail", "-c", line], cwd=ROOT, env=self.paths, capture_output=True, text=True,
                              timeout=PATIENCE_S, check=False)

    def shown(self, line):
        """The output, once the wanted text appears in it."""
        wanted = next((text for path, text in READY.items() if line.endswith(path) and "data-binary" not in line), "")
        end = time.monotonic() + PATIENCE_S
        while True:
            done = self.run_line(line)
            if (done.returncode == 0 and wanted in done.stdout) or time.monotonic() > end:
                return done
            time.sleep(0.2)

    def test_every_line_does_what_the_page_says(self):
        outputs = {}
        for printed in LINES:
            line = self.adapted(printed)
            with self.subTest(printed):
                if printed.endswith("&"):
                    self.start(line)
                    continue
                done = self.shown(line)
                self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
                outputs[printed] = done.stdout
        pushes = [text for line, text in outputs.items() if line.endswith("/push") and "data-binary" not in line]
        self.assertEqual(json.loads(pushes[0])["state"], "live")
        by_hand = next(json.loads(text) for line, text in outputs.items() if "data-binary" in line)
        self.assertEqual((by_hand["taken"], by_hand["refused"]), (1, 0))
        status = next(text for line, text in outputs.items() if line.startswith("chorus status"))
        self.assertEqual(len(re.findall(r"^s\d +live", status, re.MULTILINE)), 3, status)

    def test_every_explained_message_is_one_of_ours(self):
        said = said_by_the_code()
        messages = [re.sub(r"\b\d[\d.]* s", "{", message).removesuffix(" in the future") for message in ROW.findall(PAGE)]
        self.assertGreaterEqual(len(messages), 6)
        for message in messages:
            parts = [part.strip() for part in re.split(r"\{|captured: ", message) if len(part.strip()) > 2]
            for part in parts:
                self.assertIn(part, said)


if __name__ == "__main__":
    unittest.main()
