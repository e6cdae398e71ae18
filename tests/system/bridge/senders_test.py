"""The senders of the guide work: Python by WebSocket, POST and local socket, and C++; wrong clocks are corrected for each."""
import json
import os
import subprocess
import sys
import threading
import time
import unittest
import unittest.mock

from bridge_rig import EXAMPLES, BridgeRig, get, get_json, wait_for

import chorus_push
import synthetic_walk

sys.path.insert(0, str(EXAMPLES / "adapters"))
import depth_landmarks  # noqa: E402

TOKEN = "a token/with (every) sign%"


class Senders(BridgeRig):
    def walk(self, url, *more):
        process = subprocess.Popen([sys.executable, "-B", EXAMPLES / "synthetic_walk.py", url, *more], stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)
        return process

    def check(self, sensor, via, off, uncertainty_ms=20):
        def taken():
            state = self.push_state(sensor)
            return state["pusher"]["via"] == via and state["pusher"]["frames"] > 20 and state

        state = wait_for("frames are taken", taken)
        self.assertEqual(state["state"], "live")
        self.assertAlmostEqual(state["pusher"]["clockOffsetMilliseconds"], off * 1e3, delta=uncertainty_ms)
        self.assertEqual(self.health(sensor), (200, ""))
        frame = get_json(sensor.url + "frame")
        age = time.time() - int(frame["capturedNanoseconds"]) / 1e9
        self.assertTrue(-0.02 < age < 1, f"the frame is {age} s old by our clock")
        self.assertEqual(len(frame["bodies"]), 1)
        return frame

    def test_python_by_each_way_whatever_its_clock(self):
        sensor = self.bridge()
        for via, url, off in (("WebSocket", sensor.ws, 3600), ("HTTP POST", sensor.url + "push", -250), ("local socket", sensor.path, 0.7)):
            with self.subTest(via):
                process = self.walk(url, "--clock-off", str(off), "--camera", "1/3")
                frame = self.check(sensor, via, off)
                captured = int(frame["capturedNanoseconds"]) / 1e9
                camera = synthetic_walk.Camera(1, 3)
                there = synthetic_walk.person(captured % 86400)["Neck"]
                expected = camera.turned(*(a - b for a, b in zip(there, camera.at)))
                neck = frame["bodies"][0]["joints"]["Neck"]
                for value, axis in zip(expected, "xyz"):
                    self.assertAlmostEqual(neck[axis], value, delta=0.08)
                process.terminate()
                process.wait()
        floor = get_json(sensor.url + "floor-plane")
        self.assertAlmostEqual(floor["offset"], synthetic_walk.HEIGHT, delta=1e-3)

    def test_the_c_plus_plus_sender_by_both_its_ways(self):
        sensor = self.bridge(**{"http.bearer_token": TOKEN})
        for where, via in ((f"127.0.0.1:{sensor.port}", "WebSocket"), (sensor.path, "local socket")):
            with self.subTest(via):
                process = subprocess.Popen([os.environ["CHORUS_PUSH_CIRCLE"], where, "60", TOKEN])
                frame = self.check(sensor, via, 0)
                self.assertEqual(frame["bodies"][0]["joints"]["KneeLeft"]["state"], "Tracked")
                self.assertLess(frame["bodies"][0]["joints"]["ShoulderLeft"]["x"] - frame["bodies"][0]["joints"]["ShoulderRight"]["x"], -0.3,
                                "its left is the image's right, and our x grows to the sensor's left")
                process.terminate()
                process.wait()
        refused = subprocess.run([os.environ["CHORUS_PUSH_CIRCLE"], f"127.0.0.1:{sensor.port}", "0.1", "wrong"], capture_output=True, text=True,
                                 check=False)
        self.assertIn("401", refused.stderr)

    def test_python_sends_the_token_and_tells_when_it_is_wrong(self):
        sensor = self.bridge(**{"http.bearer_token": TOKEN})
        for url in (sensor.ws, sensor.url + "push"):
            told = []
            pusher = chorus_push.Pusher(url, {"name": "right", "layout": "coco_17"}, TOKEN, tell=told.append)
            self.assertTrue(pusher.push([]), told)
            pusher.close()
            wait_for("its end is noticed", lambda: self.push_state(sensor)["state"] != "live")
            wrong = chorus_push.Pusher(url, {"name": "wrong", "layout": "coco_17"}, "wrong", tell=told.append)
            self.assertFalse(wrong.push([]))
            self.assertIn("401", told[-1])
            self.assertIn("the token that was sent is none of this service", told[-1])
            time.sleep(2.1)  # a pusher by POST holds the sensor for this long

    def test_a_pusher_comes_back_when_the_sensor_does(self):
        sensor = self.bridge()
        told = []
        pusher = chorus_push.Pusher(sensor.ws, {"name": "patient", "layout": "coco_17"}, tell=told.append)
        self.assertTrue(pusher.push([]))
        sensor.stop()
        wait_for("it is noticed", lambda: not pusher.push([]) and told)
        self.assertFalse(pusher.push([]), "dropped, and no exception")
        again = self.bridge(port=sensor.port)
        wait_for("it is back", lambda: pusher.push([]) and self.push_state(again)["state"] == "live")
        pusher.close()

    def test_an_address_without_its_path_is_understood_and_a_wrong_one_told(self):
        sensor = self.bridge()
        for url in (sensor.ws, sensor.url + "push"):
            told = []
            pusher = chorus_push.Pusher(url[:-len("push")], {"name": "short", "layout": "coco_17"}, tell=told.append)
            self.assertTrue(pusher.push([]), told)
            pusher.close()
            wait_for("its end is noticed", lambda: self.push_state(sensor)["state"] != "live")
            wrong = chorus_push.Pusher(url[:-len("push")] + "nothing", {"name": "wrong", "layout": "coco_17"}, tell=told.append)
            self.assertFalse(wrong.push([]), told)
            self.assertEqual(wrong.dropped, 1)
            self.assertLess(len(told[0]), 200, "not the whole page")
            self.assertIn("40", told[0])

    def test_a_stream_that_is_no_bridge_is_told_and_nothing_is_thrown(self):
        sensor = self.bridge()
        for url, advice in ((sensor.ws[:-len("push")] + "frame", "ends in /push"), (sensor.ws.replace("ws://", "wss://"), "write ws://")):
            told = []
            pusher = chorus_push.Pusher(url, {"name": "astray", "layout": "coco_17"}, tell=told.append)
            self.assertFalse(pusher.push([]))
            self.assertIn(advice, told[0])

    def test_a_message_that_is_too_long_is_told_by_each_way(self):
        sensor = self.bridge()
        crowd = [{"id": i, "points": [[0.001 * i, 0.8 - 0.1 * j, 2.123456789] for j in range(17)], "remark": "x" * 5000} for i in range(60)]
        for url in (sensor.ws, sensor.path):
            told = []
            pusher = chorus_push.Pusher(url, {"name": "long", "layout": "coco_17"}, tell=told.append)
            self.assertTrue(pusher.push([]), told)
            pusher.push(crowd)
            wait_for("it is told why", lambda: any("max_message_kb" in text for text in told))
            wait_for("so does the sensor", lambda: "max_message_kb" in self.push_state(sensor)["reason"])
            pusher.close()

    def test_an_unknown_layout_is_told_the_known_ones(self):
        sensor = self.bridge()
        told = []
        chorus_push.Pusher(sensor.ws, {"name": "odd", "layout": "centaur_30"}, tell=told.append).push([])
        self.assertIn("azure_kinect_32", told[0])

    def test_mistakes_reach_the_sender_by_each_way(self):
        sensor = self.bridge()
        for url in (sensor.path, sensor.url + "push"):
            told = []
            pusher = chorus_push.Pusher(url, {"name": "clumsy", "layout": "coco_17"}, tell=told.append)
            pusher.push([{"id": 1, "points": [[0, 0]]}])
            wait_for("it is told", lambda: told)
            self.assertIn("bodies[0].points", told[0])
            self.assertIn("17 landmarks", told[0])
            pusher.close()
            wait_for("room for the next", lambda: get(sensor.url + "push")[0] == 200 and
                     self.push_state(sensor)["state"] != "live")
            time.sleep(2.1)


class Plain(unittest.TestCase):
    """What becomes of a frame before it is sent."""

    class Number:  # as numpy has them
        def __init__(self, value):
            self.value = value

        def tolist(self):
            return self.value

    def sent(self, bodies, captured=1):
        pusher = chorus_push.Pusher("nowhere", {"name": "x", "layout": "coco_17"}, tell=self.told.append)
        talk = unittest.mock.Mock()
        pusher._talk = talk
        taken = pusher.push(bodies, captured)
        self.assertEqual((taken, pusher.dropped), (talk.push.called, 0 if talk.push.called else 1))
        return json.loads(talk.push.call_args[0][0]) if taken else None

    def setUp(self):
        self.told = []

    def test_landmarks_with_a_nan_are_not_seen(self):
        nan = float("nan")
        points = [[0, 1, 2], [nan, nan, nan], [0, 1, 2, nan], {"at": [nan, 0, 1], "confidence": 1},
                  {"at": [0, 1, 2], "covariance": [nan] * 6, "confidence": nan}, None]
        expected = [[0, 1, 2], None, None, None, {"at": [0, 1, 2]}, None]
        self.assertEqual(self.sent([{"id": 1, "points": points}])["bodies"][0]["points"], expected)
        self.assertEqual(self.sent([{"id": 1, "points": {"nose": [nan, 0, 0], "left_eye": [1, 2, 3]}}])["bodies"][0]["points"],
                         {"nose": None, "left_eye": [1, 2, 3]})
        self.assertEqual(self.told, [])

    def test_numbers_of_numpy_will_do(self):
        points = self.Number([[0.5, 1.0, 2.0], [float("nan")] * 3])
        frame = self.sent([{"id": self.Number(7), "points": points}], captured=1.79e18)
        self.assertEqual(frame["bodies"], [{"id": 7, "points": [[0.5, 1.0, 2.0], None]}])
        self.assertEqual(frame["captured"], "1790000000000000000")

    def test_what_is_no_frame_is_told_and_nothing_is_thrown(self):
        self.assertIsNone(self.sent([{"id": 1, "points": object()}]))
        self.assertIn("frame 1 cannot be sent", self.told[0])


class DepthLandmarks(unittest.TestCase):
    CAMERA = {"fx": 10.0, "fy": 10.0, "cx": 5.0, "cy": 5.0}

    def lifted(self, depth, at=(5, 5)):
        landmarks = [(5, 5, 1.0)] * 33
        landmarks[0] = (*at, 0.5)
        return depth_landmarks.lift(landmarks, depth, 0.001, self.CAMERA)

    def test_puts_landmarks_where_the_depth_is(self):
        point = self.lifted([[2000] * 11 for _ in range(11)], at=(9, 3))[0]
        self.assertEqual([round(value, 6) for value in point], [0.8, -0.4, 2.0, 0.5])

    def test_leaves_out_what_has_no_depth_or_anothers(self):
        depth = [[2000] * 11 for _ in range(11)]
        for row in range(3):
            for column in range(3):
                depth[row][column] = 0
        self.assertIsNone(self.lifted(depth, at=(0, 0))[0])
        for row in range(3):
            for column in range(3):
                depth[row][column] = 900  # a person in front of it
        self.assertIsNone(self.lifted(depth, at=(0, 0))[0])
        self.assertEqual(self.lifted([[0] * 11] * 11), [None] * 33)
        self.assertIsNone(self.lifted([[2000] * 11] * 11, at=(40, 5))[0], "outside the image")


if __name__ == "__main__":
    threading.excepthook = lambda *_: None
    unittest.main()
