"""deploy/demo.sh with the newly built programs: it delivers, reports what is wrong, and leaves nothing behind."""

import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
from ports import free_ports, is_listening  # noqa: E402

ROOT = Path(__file__).resolve().parents[3]
BIN = Path(os.environ["CHORUS_BIN"])
PORTS = 8            # the fusion server and up to seven sensors
RUN_S = 20           # first provisional registration after about 7 s
CAMERAS_S = 180      # four pose runners start at once; it ends as soon as they deliver
START_WITHIN_S = 120  # loaded machines are slow


def demo(port, *arguments, cwd=ROOT):
    return subprocess.Popen([str(ROOT / "deploy/demo.sh"), "--bin", str(BIN), "--port", str(port), *arguments], cwd=cwd,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True,
                            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))  # tests may run in the background


class Demo(unittest.TestCase):
    def setUp(self):
        self.port = free_ports(PORTS)

    def left_by(self, process):
        """The processes of the demo's session that still run, and its ports that still answer."""
        lines = subprocess.run(["ps", "-o", "stat=,args=", "-s", str(process.pid)], capture_output=True,
                               text=True).stdout.splitlines()
        running = [line for line in lines if not line.startswith("Z")]  # Z: dead, only not yet reaped
        return running + [port for port in range(self.port, self.port + PORTS) if is_listening(port)]

    def assert_nothing_left(self, process):
        self.assertEqual(self.left_by(process), [])

    def run_to_its_end(self, *arguments, seconds=RUN_S):
        process = demo(self.port, "--seconds", str(seconds), *arguments)
        output, _ = process.communicate(timeout=seconds + START_WITHIN_S)
        self.assertEqual(process.returncode, 0, output)
        self.assertIn("delivered", output)
        self.assert_nothing_left(process)
        return output

    def test_six_simulated_sensors_become_one_tracker(self):
        output = self.run_to_its_end()
        self.assertIn("6 sensors", output)
        self.assertIn(f"http://127.0.0.1:{self.port}/viewer/", output)

    def test_a_killed_sensor_costs_only_itself(self):
        process = demo(self.port, "--seconds", str(RUN_S))
        deadline = time.monotonic() + START_WITHIN_S
        while not is_listening(self.port) and time.monotonic() < deadline:
            time.sleep(0.1)
        killed = subprocess.run(["pkill", "-KILL", "-f", f"http.port={self.port + 2}"])
        self.assertEqual(killed.returncode, 0, "there was a sensor to kill")
        output, _ = process.communicate(timeout=RUN_S + START_WITHIN_S)
        self.assertEqual(process.returncode, 0, output)
        self.assertIn("goes on without it", output)
        self.assert_nothing_left(process)

    def test_the_real_cameras_become_one_tracker(self):
        output = self.run_to_its_end("--recording", seconds=10)
        self.assertIn("4 sensors", output)

    def test_videos_of_four_cameras_become_one_tracker(self):
        output = self.run_to_its_end("--cameras", "--until-good", seconds=CAMERAS_S)
        self.assertIn("4 sensors", output)
        self.assertIn("registration: good, 4 sensors", output)

    def test_two_demos_at_once_are_refused(self):
        done = subprocess.run(["deploy/demo.sh", "--cameras", "--recording"], cwd=ROOT, capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("choose one", done.stderr)

    def test_plays_what_chorus_record_wrote_in_its_place(self):
        """One file of six sensors, including the registration it was recorded with."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        process = demo(self.port)
        base = f"http://127.0.0.1:{self.port}/"
        deadline = time.monotonic() + START_WITHIN_S
        while self.sensors_placed(base) < 2 and time.monotonic() < deadline:
            time.sleep(0.5)
        recorded = subprocess.run([BIN / "chorus", "record", base, "--out", Path(folder.name) / "walk.mcap",
                                   "--seconds", "4"], capture_output=True, text=True)
        os.killpg(process.pid, signal.SIGTERM)
        process.communicate(timeout=START_WITHIN_S)
        self.assertEqual(recorded.returncode, 0, recorded.stderr)
        output = self.run_to_its_end("--recording", folder.name, seconds=10)
        self.assertIn("6 sensors", output)
        self.assertIn("[  0.0 s] registration:", output)

    @staticmethod
    def sensors_placed(base):
        request = urllib.request.Request(base + "registration", headers={"Accept": "application/json"})
        try:
            with urllib.request.urlopen(request, timeout=5) as answer:
                return len(json.load(answer).get("sensors", {}))
        except OSError:
            return 0

    def test_the_port_is_looked_at_before_anything_is_built(self):
        with socket.socket() as occupant:
            occupant.bind(("127.0.0.1", self.port))
            occupant.listen()
            process = subprocess.Popen(["deploy/demo.sh", "--port", str(self.port)], cwd=ROOT, text=True,
                                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
            output, _ = process.communicate(timeout=START_WITHIN_S)
        self.assertEqual(process.returncode, 1)
        self.assertIn(f"port {self.port} is in use", output)
        self.assertNotIn("== packages", output)

    def test_a_port_in_use_is_named(self):
        with socket.socket() as occupant:
            occupant.bind(("127.0.0.1", self.port + 3))
            occupant.listen()
            process = demo(self.port, "--seconds", "5")
            output, _ = process.communicate(timeout=START_WITHIN_S)
        self.assertEqual(process.returncode, 1)
        self.assertIn(f"port {self.port + 3} is in use", output)
        self.assert_nothing_left(process)

    def test_a_stop_by_signal_leaves_nothing_behind(self):
        for stop in (signal.SIGINT, signal.SIGTERM):
            process = demo(self.port)
            deadline = time.monotonic() + START_WITHIN_S
            while not is_listening(self.port) and time.monotonic() < deadline:
                time.sleep(0.1)
            self.assertTrue(is_listening(self.port), "the demo did not come up")
            os.killpg(process.pid, stop)  # as a terminal does on Ctrl-C
            output, _ = process.communicate(timeout=START_WITHIN_S)
            self.assertNotEqual(process.returncode, 0, output)
            self.assert_nothing_left(process)

    def test_a_killed_demo_takes_its_programs_along(self):
        process = demo(self.port)
        deadline = time.monotonic() + START_WITHIN_S
        while not is_listening(self.port) and time.monotonic() < deadline:
            time.sleep(0.1)
        process.kill()
        process.wait()
        process.stdout.close()
        deadline = time.monotonic() + START_WITHIN_S
        while self.left_by(process) and time.monotonic() < deadline:
            time.sleep(0.1)
        self.assert_nothing_left(process)

    def test_wrong_arguments_are_refused_before_anything_starts(self):
        for arguments in (["--bogus"], ["--seconds", "soon"], ["--recording", "/nonexistent"], ["--port", "x"]):
            process = demo(self.port, *arguments)
            output, _ = process.communicate(timeout=START_WITHIN_S)
            self.assertEqual(process.returncode, 1, arguments)
            self.assertIn("demo:", output)

    def test_a_relative_path_is_that_of_the_caller(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "rec").mkdir()
            (Path(folder) / "walk.mcap").write_bytes(b"")
            for name, complaint in (("rec", f"no *.mcap in {folder}/rec"), ("walk.mcap", "is a file")):
                process = demo(self.port, "--recording", name, cwd=folder)
                output, _ = process.communicate(timeout=START_WITHIN_S)
                self.assertEqual(process.returncode, 1, name)
                self.assertIn(complaint, output)


if __name__ == "__main__":
    unittest.main()
