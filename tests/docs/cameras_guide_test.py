"""Every line of docs/guide/cameras.md after the installation runs as printed, on free ports; the installation equals that of tests/run.sh;
the table of models is the runner's; and every message that the page explains exists in the code."""

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
RUNNER = ROOT / "services/pose-runner"
PAGE = (ROOT / "docs/guide/cameras.md").read_text(encoding="utf-8")
BLOCKS = [block.splitlines() for block in re.findall(r"^```sh\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)]
INSTALLATION, *USE = BLOCKS
FUSED = next(block for block in USE if any(line.endswith("8080/frame") for line in block))
MOST_COMMANDS = 6  # from a clone to one camera's landmarks; and to a fused body of two cameras, not counting the curl lines that show it
PATIENCE_S = 120
# The output to wait for, by how a line ends; the fusion server is at 8080.
READY = {"/camera": '"state": "live"', "/capture/": "<title>Chorus camera</title>", "8080/frame": '"Skeleton"', "/frame": '"rayX"'}
PORTS = range(8080, 8087)


class CamerasGuide(unittest.TestCase):
    def setUp(self):
        first = free_ports(len(PORTS))
        self.ports = {str(port): str(first + i) for i, port in enumerate(PORTS)}
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.paths = {**os.environ, "PATH": f"{BIN.resolve()}:{os.environ['PATH']}", "XDG_STATE_HOME": folder.name}

    def run_line(self, line):
        return subprocess.run(["bash", "-o", "pipefail", "-c", line], cwd=ROOT, env=self.paths, capture_output=True, text=True,
                              timeout=PATIENCE_S, check=False)

    def shown(self, line, printed):
        wanted = next((text for path, text in READY.items() if printed.endswith(path)), "")
        end = time.monotonic() + PATIENCE_S
        while True:
            done = self.run_line(line)
            if (done.returncode == 0 and wanted in done.stdout) or time.monotonic() > end:
                return done
            time.sleep(0.2)

    def start(self, line):
        process = subprocess.Popen(["bash", "-c", "exec " + line.removesuffix("&")], cwd=ROOT, env=self.paths,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)
        return process

    def test_every_line_does_what_the_page_says(self):
        self.assertLessEqual(len(INSTALLATION) + len(USE[0]), MOST_COMMANDS)
        self.assertLessEqual(len(INSTALLATION) + len([line for line in FUSED if not line.startswith("curl")]), MOST_COMMANDS)
        outputs, started = {}, []
        for printed in [line for block in USE for line in block]:
            line = re.sub(r"\b808[0-6]\b", lambda port: self.ports[port.group(0)], printed.replace("phone-tls", self.folder))
            with self.subTest(printed):
                if printed.endswith("&"):
                    started.append(self.start(line))
                    continue
                done = self.shown(line, printed)
                self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
                outputs[printed.split()[-1]] = done.stdout
                if printed.endswith("8081/frame"):  # one camera is enough for that; the others need the processor
                    started.pop().terminate()
        camera = next(text for line, text in outputs.items() if line.endswith("/camera"))
        self.assertEqual(json.loads(camera)["state"], "live")
        self.assertIn('"rayX"', next(text for line, text in outputs.items() if line.endswith("8081/frame")))
        fused = json.loads(next(text for line, text in outputs.items() if line.endswith("8080/frame")))
        self.assertEqual(fused["space"], "WorldSpace")
        self.assertEqual(len(fused["bodies"]), 1)
        self.assertEqual([process.poll() for process in started], [None] * len(started), "all others still run")

    def test_the_installation_is_that_of_the_tests(self):
        script = (ROOT / "tests/run.sh").read_text(encoding="utf-8")
        self.assertTrue((ROOT / INSTALLATION[0].split()[0]).exists())
        self.assertRegex(script, r"modules=\(.*services/pose-runner.*\)\n\(for folder in .*npm_packages")
        self.assertEqual(INSTALLATION[1], "npm ci --prefix services/pose-runner")
        presets = json.loads((ROOT / "CMakePresets.json").read_text(encoding="utf-8"))
        self.assertIn("release", [preset["name"] for preset in presets["configurePresets"]])
        self.assertIn("cmake --preset release && cmake --build build/release", INSTALLATION[2])

    def test_the_table_of_models_is_that_of_the_runner(self):
        known = json.loads((RUNNER / "models.json").read_text(encoding="utf-8"))
        rows = re.findall(r"^\| `(\S+)` \| (\d+) \| `([0-9a-f]{64})` \|$", PAGE, re.MULTILINE)
        self.assertEqual({name: {"bytes": int(size), "sha256": sha} for name, size, sha in rows}, known)
        for model in ("movenet", "blazepose-lite", "blazepose-full"):
            done = subprocess.run(["node", RUNNER / "runner.mjs", "--model", model, "--check"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_the_lock_file_names_no_registry(self):
        lock = json.loads((RUNNER / "package-lock.json").read_text(encoding="utf-8"))
        resolved = [package["resolved"] for package in lock["packages"].values() if "resolved" in package]
        self.assertEqual(set(resolved), {"none"})

    def test_every_explained_message_is_one_of_ours(self):
        said = said_by_the_code() + "\n".join(path.read_text(encoding="utf-8") for path in [*sorted(RUNNER.glob("*.js")), *sorted((ROOT / "services/capture").glob("*.js"))])
        messages = ROW.findall(PAGE)
        explained = [message for message in messages if " " in message]
        self.assertGreaterEqual(len(explained), 10)
        self.assertEqual([message for message in explained if message not in said], [])


if __name__ == "__main__":
    unittest.main()
