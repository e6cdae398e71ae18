"""Starts chorus-sensor on a free port and sends requests to it."""

import http.client
import json
import os
import signal
import subprocess
import tempfile
import time

SENSOR = os.environ["CHORUS_SENSOR"]
MAKE_RECORDING = os.environ["CHORUS_MAKE_RECORDING"]
START_S = 30  # generous: the machine may be busy


def make_recording(folder, name="walk", frames=100, first_ms=0):
    path = os.path.join(folder, name + ".mcap")
    subprocess.run([MAKE_RECORDING, path, str(frames), str(first_ms)], check=True)
    return path


def temporary_folder():
    return tempfile.TemporaryDirectory(prefix="chorus-sensor-")


class Answer:
    def __init__(self, response):
        self.status = response.status
        self.headers = response.headers
        self.bytes = response.read()
        self.type = (response.headers.get("Content-Type") or "").split(";")[0]

    @property
    def text(self):
        return self.bytes.decode()

    @property
    def json(self):
        return json.loads(self.bytes)


class Sensor:
    """A running chorus-sensor; it is made when the log line `sensor serving` has come."""

    def __init__(self, *options, before=(), **popen):
        command = [*before, SENSOR, "--port", "0", "--log-format", "json", *options]
        self.process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, **popen)
        self.port = int(self.wait_for_event("sensor serving")["url"].split(":")[2].rstrip("/"))

    def wait_for_event(self, name):
        """The next log line with this event; the process must not end before it."""
        for line in self.process.stderr:
            fields = json.loads(line)
            if name in fields.values():
                return fields
        raise AssertionError(f"chorus-sensor ended with {self.process.wait()} before '{name}'")

    def get(self, path, accept="application/json", headers=None, method="GET", timeout=30):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=timeout)
        try:
            connection.request(method, path, headers={"Accept": accept, **(headers or {})})
            return Answer(connection.getresponse())
        finally:
            connection.close()

    def wait_for(self, path, status, containing=""):
        end = time.monotonic() + START_S
        while True:
            answer = self.get(path, accept="application/json, */*;q=0.1")
            if answer.status == status and containing.encode() in answer.bytes:
                return answer
            assert time.monotonic() < end, f"{path} stays {answer.status}, not {status}"
            time.sleep(0.02)

    def signal(self, number):
        self.process.send_signal(number)

    def stop(self):
        """Stops the sensor; returns its exit code and the seconds it took."""
        start = time.monotonic()
        if self.process.poll() is None:
            self.signal(signal.SIGTERM)
        try:
            code = self.process.wait(timeout=START_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise
        self.process.stderr.close()
        return code, time.monotonic() - start
