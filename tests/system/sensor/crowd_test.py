"""With few descriptors and many idle connections, others are still served, and monitoring shows it."""

import contextlib
import re
import resource
import socket
import unittest

import sensor_process
from sensor_process import Sensor

SOFT, HARD = 64, 512
IDLE = 700


class Crowd(unittest.TestCase):
    def setUp(self):
        before = resource.getrlimit(resource.RLIMIT_NOFILE)
        resource.setrlimit(resource.RLIMIT_NOFILE, (SOFT, before[1]))
        try:
            self.sensor = Sensor("--set", "device.simulated.scene.people=1", preexec_fn=lambda: resource.setrlimit(
                resource.RLIMIT_NOFILE, (SOFT, HARD)))
        finally:
            resource.setrlimit(resource.RLIMIT_NOFILE, (min(4096, before[1]), before[1]))
        self.addCleanup(self.sensor.stop)

    def test_idle_connections_give_way(self):
        with open(f"/proc/{self.sensor.process.pid}/limits", encoding="ascii") as limits:
            soft = re.search(r"Max open files\s+(\d+)", limits.read()).group(1)
        self.assertEqual(int(soft), HARD, "raised at start")
        self.sensor.wait_for("/frame", 200)
        with contextlib.ExitStack() as idle:
            for _ in range(IDLE):
                idle.enter_context(socket.create_connection(("127.0.0.1", self.sensor.port), timeout=10))
            for _ in range(20):
                for path in ("/frame", "/healthz"):
                    self.assertEqual(self.sensor.get(path, accept="*/*", timeout=10).status, 200, path)
            metrics = self.sensor.get("/metrics", accept="*/*").text
        number = lambda name: int(re.search(rf"^{name} (\d+)$", metrics, re.MULTILINE).group(1))
        self.assertLess(number("chorus_http_connections_limit"), HARD)
        self.assertGreater(number("chorus_http_closed_for_room_total"), IDLE - HARD)
        self.assertLessEqual(number("chorus_http_connections"), number("chorus_http_connections_limit") + 32)


if __name__ == "__main__":
    assert sensor_process.SENSOR
    unittest.main()
