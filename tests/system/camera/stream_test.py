"""A stream that starts, stops and starts again: Motion JPEG over HTTP replaces an IP camera, with the stand-in runner."""

import http.server
import json
import sys
import threading
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/system/sensor"))
from sensor_process import Sensor  # noqa: E402

VIDEO = ROOT / "tests/data/pose2sim_videos/cam01.mp4"
STAND_IN = json.dumps(["python3", "-B", str(ROOT / "tests/support/stand_in_runner.py")])
RATE_HZ = 15


class Camera:
    """Serves the same picture repeatedly, as IP cameras do; `stop` ends all connections."""

    def __init__(self, jpeg, port=0):
        camera = self
        self.over = threading.Event()

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                self.send_response(200)
                self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=picture")
                self.end_headers()
                try:
                    while not camera.over.wait(1 / RATE_HZ):
                        head = f"--picture\r\nContent-Type: image/jpeg\r\nContent-Length: {len(jpeg)}\r\n\r\n"
                        self.wfile.write(head.encode() + jpeg + b"\r\n")
                except OSError:
                    pass  # the sensor has disconnected

            def log_message(self, *_):
                pass

        http.server.ThreadingHTTPServer.allow_reuse_address = True
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", port), Handler)
        self.server.daemon_threads = True
        self.port = self.server.server_address[1]
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def stop(self):
        self.over.set()
        self.server.shutdown()
        self.server.server_close()


class Stream(unittest.TestCase):
    def looking(self, source, *more):
        sensor = Sensor("--camera", source, "--set", "device.camera.runner=" + STAND_IN, *more)
        self.addCleanup(sensor.stop)
        return sensor

    def picture(self):
        sensor = self.looking(str(VIDEO), "--set", "images=true")
        jpeg = sensor.wait_for("/images/color", 200).bytes
        sensor.stop()
        return jpeg

    def stamps(self, sensor, seconds):
        found = set()
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            found.add(int(sensor.get("/frame").json["capturedNanoseconds"]))
            time.sleep(0.01)
        return sorted(found)

    def test_goes_and_comes_back(self):
        jpeg = self.picture()
        camera = Camera(jpeg)
        sensor = self.looking(f"http://me:secret@127.0.0.1:{camera.port}/video.mjpg")
        sensor.wait_for("/camera", 200, '"state": "live"')
        sensor.wait_for("/frame", 200)
        self.assertNotIn("secret", sensor.get("/camera").text + sensor.get("/").text)
        self.assertGreater(len(self.stamps(sensor, 2.0)), RATE_HZ / 2)
        camera.stop()
        sensor.wait_for("/healthz", 503, "the stream")
        sensor.wait_for("/camera", 200, '"state": "no pictures"')
        again = Camera(jpeg, camera.port)
        self.addCleanup(again.stop)
        sensor.wait_for("/healthz", 200)
        status = sensor.wait_for("/camera", 200, '"state": "live"').json
        self.assertGreaterEqual(status["opened"], 2)
        self.assertEqual(status["runner"]["started"], 1, "the runner has nothing to do with it")


if __name__ == "__main__":
    unittest.main()
