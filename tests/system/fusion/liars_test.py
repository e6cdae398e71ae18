"""Sensors that send nonsense: each is refused with a reason, and a good one next to them keeps its rate."""
import json
import math
import sys
import time
import unittest

from rig import Rig, frame_json, get_json, joint, reply, wait_for


def endless(handler):
    handler.send_response(200)
    handler.send_header("Content-Type", "text/turtle")
    handler.end_headers()
    while True:
        handler.wfile.write(b"# all work and no play\n" * 1000)


def huge_length(handler):
    handler.send_response(200)
    handler.send_header("Content-Type", "text/turtle")
    handler.send_header("Content-Length", str(10**15))
    handler.end_headers()
    handler.wfile.write(b"@prefix")


def silent(_):
    time.sleep(600)


def cut_off(handler):
    body = json.dumps(frame_json("x"))
    handler.send_response(200)
    handler.send_header("Content-Type", "application/json")
    handler.send_header("Content-Length", str(len(body)))
    handler.end_headers()
    handler.wfile.write(body[:50].encode())
    handler.close_connection = True


def not_http(handler):
    handler.wfile.write(b"\x00\xff" * 5000)
    handler.close_connection = True


def json_frame(**more):
    return lambda handler: reply(handler, json.dumps(frame_json(**more)))


LIARS = {
    "nonsense": lambda h: reply(h, "hello, world", "text/turtle"),
    "page": lambda h: reply(h, "<html></html>", "text/html"),
    "deep": lambda h: reply(h, "[" * 20000, "text/turtle"),
    "deepjson": lambda h: reply(h, "[" * 20000),
    "big": lambda h: reply(h, "#" * (8 << 20), "text/turtle"),
    "endless": endless,
    "hugelength": huge_length,
    "silent": silent,
    "cutoff": cut_off,
    "nothttp": not_http,
    "stranger": json_frame(source="somebody-else"),
    "nan": lambda h: reply(h, json.dumps(frame_json("nan", bodies=[(1, joint(math.nan, 1, 2))]))),
    "absurd": json_frame(source="absurd", bodies=[(1, joint(1e30, 1, 2))]),
    "twins": json_frame(source="twins", bodies=[(1, joint(0, 1, 2)), (1, joint(0, 1, 2))]),
    "error": lambda h: reply(h, "{}", status=500),
    "loop": lambda h: reply(h, "", status=302),
    "empty": lambda h: reply(h, "", "text/turtle"),
}


class Liars(Rig):
    def rate_of(self, fusion, name):
        return get_json(fusion.url + "sensors/")["sensors"][name]["rateHz"]

    def test_liars_are_refused_by_name_and_stall_nobody(self):
        good = self.sensor(0, 2)
        second = self.sensor(1, 2)
        fakes = {name: self.fake(respond) for name, respond in LIARS.items()}
        polled = {"s1": good.url, "s2": second.url, **{name: fake.url for name, fake in fakes.items()}}
        started = time.monotonic()
        fusion = self.fusion(polled, **{"registration.file": self.given_ring(2), "poll.max_backoff_ms": 500})
        shown = lambda: get_json(fusion.url + "sensors/")["sensors"]
        for name in LIARS:
            state = wait_for(f"an error of {name}", lambda: shown()[name].get("lastError") and shown()[name])
            self.assertNotEqual(state["state"], "live", name)
            self.assertEqual(state["framesReceived"], 0, name)
            self.assertLess(len(state["lastError"]), 1000, name)
            if "-v" in sys.argv:
                print(f"{name:11} {state['state']:11} {state['lastError']}")
        before = shown()
        begun = time.monotonic()
        wait_for("three seconds of frames", lambda: shown()["s1"]["framesReceived"] > before["s1"]["framesReceived"] + 90)
        rate = 90 / (time.monotonic() - begun)
        # A poller that waited for a liar would get a few frames per second; a busy machine loses some, too.
        self.assertGreater(rate, 8.0)
        self.assertLess(shown()["s1"]["framesMissed"], shown()["s1"]["framesReceived"])
        wait_for("a body is fused all the while", lambda: get_json(fusion.url + "frame")["bodies"])
        # Back-off: after seconds of failures no sensor is asked more than a few times per second.
        for name, fake in fakes.items():
            self.assertLess(fake.requests, 100 + 8 * (time.monotonic() - started), name)
        self.assertTrue(fusion.alive())
        self.assertEqual(fusion.stop(), 0)

    def test_time_going_backwards_standing_still_and_far_ahead(self):
        start = time.time_ns()
        count = {"back": 0, "still": 0, "ahead": 0, "spin": 0}

        def frame(name, ns):
            def respond(handler):
                count[name] += 1
                reply(handler, json.dumps(frame_json(name, ns(count[name]), [(1, joint(0, 1, 2))], count[name])))
            return respond

        fakes = {
            "back": self.fake(frame("back", lambda n: start - n * 10**7)),
            "still": self.fake(frame("still", lambda n: start)),
            "ahead": self.fake(frame("ahead", lambda n: start + 3600 * 10**9 + n * 10**7)),
            "spin": self.fake(frame("spin", lambda n: time.time_ns())),
        }
        fusion = self.fusion({name: fake.url for name, fake in fakes.items()})
        shown = lambda: get_json(fusion.url + "sensors/")["sensors"]
        wait_for("frames refused", lambda: shown()["back"]["framesRefused"] > 10 and shown()["ahead"]["framesRefused"] > 10)
        self.assertEqual(shown()["still"]["framesReceived"], 1)
        begun, before = time.monotonic(), fakes["spin"].requests
        time.sleep(1.0)
        per_second = (fakes["spin"].requests - before) / (time.monotonic() - begun)
        self.assertLess(per_second, 260)  # 4 ms between requests, even if each frame claims to be new
        self.assertEqual(fusion.stop(), 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
