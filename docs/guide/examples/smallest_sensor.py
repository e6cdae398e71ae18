#!/usr/bin/env python3
"""The smallest sensor: Python's standard library and nothing else.  A fusion server takes it for hardware.

usage: smallest_sensor.py [port] [id]

A made-up person walks a small circle before it.  Replace see() by your camera, and FLOOR by its floor; the rest is what a
fusion server asks for: /frame, each frame once (long poll), and /floor-plane.  On another host than the fusion server's its clock
has to be right (NTP), and 127.0.0.1 below becomes 0.0.0.0.
"""
import json
import math
import sys
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

PORT = int(sys.argv[1]) if len(sys.argv) > 1 else 8081
ID = sys.argv[2] if len(sys.argv) > 2 else "s1"  # the id that the fusion server knows this sensor by
RATE_HZ = 30
# The plane n.x + d = 0 in sensor space: here the sensor looks level, 1.2 m above the floor.
FLOOR = {"@type": "FloorPlane", "normalX": 0.0, "normalY": 1.0, "normalZ": 0.0, "offset": 1.2}
# Height above the floor and distance to the person's left [m] of some Kinect joints; all 25 are better.
BODY = {"SpineBase": (0.95, 0), "SpineMid": (1.20, 0), "SpineShoulder": (1.43, 0), "Neck": (1.50, 0), "Head": (1.65, 0),
        "ShoulderLeft": (1.42, 0.18), "ShoulderRight": (1.42, -0.18), "HipLeft": (0.92, 0.10), "HipRight": (0.92, -0.10),
        "KneeLeft": (0.50, 0.11), "KneeRight": (0.50, -0.11), "AnkleLeft": (0.08, 0.11), "AnkleRight": (0.08, -0.11)}


def see(t):
    """Joints in sensor space [m]: +x to the sensor's left, +y up, +z away from it.  The person faces the sensor."""
    x, z = 0.5 * math.cos(t), 2.5 + 0.5 * math.sin(t)
    return {name: {"x": x - left, "y": up - 1.2, "z": z, "state": "Tracked"} for name, (up, left) in BODY.items()}


newest = {"etag": "", "body": b""}
news = threading.Condition()


def capture():
    for sequence in range(1, sys.maxsize):
        now = time.time_ns()
        stamp = {"capturedNanoseconds": str(now)}  # UTC of capture; a string, because JSON readers round large numbers
        frame = {"@type": "Frame", "sequence": sequence, **stamp, "source": ID, "space": "SensorSpace",
                 "bodies": [{"bodyId": 1, **stamp, "joints": see(now / 1e9)}]}
        with news:
            newest.update(etag=f'"{sequence}"', body=json.dumps(frame).encode())
            news.notify_all()
        time.sleep(1 / RATE_HZ)


class Sensor(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"     # one connection for all requests
    disable_nagle_algorithm = True    # else every other frame waits 40 ms for an acknowledgement
    wbufsize = -1                     # head and body leave together

    def do_GET(self):
        if self.path == "/frame":
            return self.frame()
        if self.path == "/floor-plane":
            return self.answer(200, json.dumps(FLOOR).encode())
        return self.answer(404, b'{"title":"there is no such resource"}')

    def frame(self):
        seen = self.headers.get("If-None-Match")
        with news:
            if seen and "wait" in self.headers.get("Prefer", ""):
                news.wait_for(lambda: newest["etag"] != seen, timeout=5)
            etag, body = newest["etag"], newest["body"]
        if not body:
            return self.answer(503, b'{"title":"no frame yet"}')
        return self.answer(304 if etag == seen else 200, b"" if etag == seen else body, etag)

    def answer(self, status, body, etag=None):
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Cache-Control", "no-cache")
        if etag:
            self.send_header("ETag", etag)
        if status != 304:
            self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)
        self.wfile.flush()

    def log_message(self, *_):
        pass


if __name__ == "__main__":
    threading.Thread(target=capture, daemon=True).start()
    print(f"sensor {ID} at http://127.0.0.1:{PORT}/frame", flush=True)
    ThreadingHTTPServer(("127.0.0.1", PORT), Sensor).serve_forever()
