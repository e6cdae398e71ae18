"""A log that nobody reads only loses lines."""
import fcntl
import json
import os
import re
import subprocess
import time
import unittest

from rig import BIN, ROOT, Rig, free_port, get, get_json, wait_for

F_SETPIPE_SZ = 1031
RATE_HZ = 30
WATCHED_S = 3.0


class Piped:
    """chorus-fusion whose standard error is a pipe of one page that is full from the start."""

    def __init__(self, *arguments):
        self.read_end, write_end = os.pipe()
        fcntl.fcntl(write_end, F_SETPIPE_SZ, 4096)
        # An open file description of our own: making the child's non-blocking would invalidate the test.
        filler = os.open(f"/proc/self/fd/{write_end}", os.O_WRONLY | os.O_NONBLOCK)
        try:
            while True:
                os.write(filler, b"x" * 63 + b"\n")
        except BlockingIOError:
            pass
        os.close(filler)
        self.child = subprocess.Popen([str(BIN / "chorus-fusion"), *arguments], cwd=ROOT, stderr=write_end)
        os.close(write_end)

    def text(self):
        return ""

    def alive(self):
        return self.child.poll() is None

    def kill(self):
        if self.alive():
            self.child.kill()
        self.child.wait()
        os.close(self.read_end)

    def read_to_end(self):
        with os.fdopen(os.dup(self.read_end), "rb") as stream:
            return stream.read().decode()


class StuckLog(Rig):
    def tracker(self, sensors):
        port = free_port()
        polled = json.dumps([{"id": sensor, "url": url} for sensor, url in sensors.items()])
        options = {"http.port": port, "sensors": polled, "viewer_dir": "", "output.rate_hz": RATE_HZ,
                   "registration.file": self.given_ring(6)}
        arguments = [a for key, value in options.items() for a in ("--set", f"{key}={value}")]
        fusion = Piped("--config", "deploy/config/fusion.json", "--log-level", "debug", *arguments)
        self.processes.append(fusion)
        fusion.url = f"http://127.0.0.1:{port}/"
        wait_for("the tracker answers", lambda: get(fusion.url + "frame")[0] == 200)
        return fusion

    def published(self, fusion):
        metrics = get(fusion.url + "metrics", accept="*/*")[2].decode()
        return int(re.search(r"^chorus_fused_frames_total (\d+)$", metrics, re.MULTILINE).group(1))

    def watch(self, fusion):
        """Frames per second, and the fraction of the frames seen that contain a person."""
        begin, first = time.monotonic(), self.published(fusion)
        seen = []
        while time.monotonic() - begin < WATCHED_S:
            seen.append(bool(get_json(fusion.url + "frame")["bodies"]))
            time.sleep(0.03)
        return (self.published(fusion) - first) / (time.monotonic() - begin), sum(seen) / len(seen)

    def test_a_sensor_that_dies_does_not_blind_the_tracker(self):
        staying, dying = self.sensor(0), self.sensor(1)
        fusion = self.tracker({"s1": staying.url, "s2": dying.url})
        wait_for("somebody is seen", lambda: get_json(fusion.url + "frame")["bodies"])
        dying.kill()
        self.processes.remove(dying)
        wait_for("it is missed", lambda: get_json(fusion.url + "sensors/s2")["state"] != "live")
        rate, with_people = self.watch(fusion)
        # A tracker that waited for its log would publish nothing; a loaded machine publishes less.
        self.assertGreater(rate, 0.4 * RATE_HZ)
        self.assertGreater(with_people, 0.5)
        fusion.child.terminate()
        log = fusion.read_to_end()
        self.assertEqual(fusion.child.wait(timeout=40), 0)
        self.assertIn("s2", log, "what waited is written out at the end")

    def test_it_ends_even_if_nobody_ever_reads(self):
        fusion = self.tracker({"gone": "http://127.0.0.1:1/"})
        fusion.child.terminate()
        self.assertEqual(fusion.child.wait(timeout=40), 0)

    def test_dropped_lines_are_counted_in_metrics(self):
        fusion = self.tracker({"gone": "http://127.0.0.1:1/"})
        self.assertIn("chorus_log_dropped_lines_total 0", get(fusion.url + "metrics", accept="*/*")[2].decode())


if __name__ == "__main__":
    assert BIN.exists(), f"build chorus-fusion first ({BIN})"
    unittest.main(verbosity=2)
