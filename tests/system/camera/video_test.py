"""A real video through a real chorus-sensor and the runner included in Chorus: rays of the person in it, at the times of the pictures,
close to where MediaPipe saw the same landmarks (tests/data/pose2sim_mediapipe)."""

import json
import os
import signal
import statistics
import subprocess
import sys
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/system/sensor"))
from sensor_process import SENSOR, Sensor  # noqa: E402

VIDEO = ROOT / "tests/data/pose2sim_videos/cam01.mp4"
TRUTH = ROOT / "tests/data/pose2sim_mediapipe"
RATE_HZ = 60
PICTURES = 100
LENGTH_NS = round(1e9 * PICTURES / RATE_HZ)
# Joints that both layouts compute from a single landmark, and its number in MediaPipe.
JOINTS = {"ShoulderLeft": 11, "ShoulderRight": 12, "ElbowLeft": 13, "ElbowRight": 14, "WristLeft": 15, "WristRight": 16, "HipLeft": 23,
          "HipRight": 24, "KneeLeft": 25, "KneeRight": 26, "AnkleLeft": 27, "AnkleRight": 28}
FARTHEST_PX = 35  # median, in pictures of 1080 x 1920 in which the person is about 1300 high; measured 15 to 20
PATIENCE_S = 90


def camera():
    stated = json.loads((TRUTH / "cameras.json").read_text(encoding="utf-8"))[0]
    matrix = stated["K"]
    return {"width": stated["width"], "height": stated["height"], "fx": matrix[0][0], "fy": matrix[1][1],
            "cx": matrix[0][2], "cy": matrix[1][2], "distortion": stated["distortion_k1k2p1p2k3"]}


def pixel_of(joint, lens):
    """Where a ray meets the picture; the ray's axes are left, up, forward."""
    x, y = -joint["rayX"] / joint["rayZ"], -joint["rayY"] / joint["rayZ"]
    k1, k2, p1, p2, k3 = lens["distortion"]
    r2 = x * x + y * y
    radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    return (lens["cx"] + lens["fx"] * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)),
            lens["cy"] + lens["fy"] * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y))


def picture_of(frame):
    """Number of the video's picture captured at that time: rounds begin at whole multiples of its length."""
    return round(int(frame["capturedNanoseconds"]) % LENGTH_NS * 1e-9 * RATE_HZ) % PICTURES


class Video(unittest.TestCase):
    def looking(self, model, *more):
        settings = ["--camera", str(VIDEO), "--set", f"device.camera.model={model}",
                    "--set", "device.camera.intrinsics=" + json.dumps(camera()), *more]
        sensor = Sensor(*settings)
        self.addCleanup(sensor.stop)
        return sensor

    def frames(self, sensor, count):
        """Collects `count` different frames that contain a person."""
        found = {}
        end = time.monotonic() + PATIENCE_S
        while len(found) < count and time.monotonic() < end:
            answer = sensor.get("/frame")
            if answer.status == 200 and answer.json["bodies"]:
                found[answer.json["sequence"]] = answer.json
            time.sleep(0.02)
        self.assertEqual(len(found), count, sensor.get("/camera").text)
        return [found[key] for key in sorted(found)]

    def distances(self, frames):
        lens = camera()
        landmarks = json.loads((TRUTH / "cam01.json").read_text(encoding="utf-8"))["frames"]
        distances = []
        for frame in frames:
            seen = landmarks[picture_of(frame)]["image"]
            body = max(frame["bodies"], key=lambda each: len(each["joints"]))
            for name, index in JOINTS.items():
                joint = body["joints"].get(name)
                if joint and "rayX" in joint and joint["state"] == "Tracked":
                    u, v = pixel_of(joint, lens)
                    distances.append(((u - seen[index][0]) ** 2 + (v - seen[index][1]) ** 2) ** 0.5)
        return distances

    def close_to_mediapipe(self, model, joints):
        frames = self.frames(self.looking(model), 4)
        distances = self.distances(frames)
        self.assertGreater(len(distances), 4 * 6)
        self.assertLess(statistics.median(distances), FARTHEST_PX)
        body = frames[-1]["bodies"][0]["joints"]
        self.assertLessEqual(joints, {name for name, joint in body.items() if "rayX" in joint})
        self.assertIn("cxx", body["HipLeft"])

    def test_movenet_sees_the_person_where_mediapipe_does(self):
        self.close_to_mediapipe("movenet", {"Head", "HipLeft", "AnkleRight"})

    def test_blazepose_does_and_gives_hands_and_feet(self):
        self.close_to_mediapipe("blazepose-lite", {"Head", "HipLeft", "HandTipLeft", "FootRight"})

    def test_depth_from_size_is_that_of_the_triangulation_within_what_it_says(self):
        stated = json.loads((TRUTH / "cameras.json").read_text(encoding="utf-8"))[0]["camera_from_world"]
        world = json.loads((TRUTH / "triangulated.json").read_text(encoding="utf-8"))["frames"]
        ratios = {}  # by frame, picture and joint: error of the depth over its stated standard deviation
        # The size is learned from the first pictures; a busy runner sees few of them.
        for frame in self.frames(self.looking("blazepose-lite", "--set", "device.camera.depth_from_size=true"), 20)[12:]:
            seen = world[picture_of(frame)]
            for name, joint in frame["bodies"][0]["joints"].items():
                place = seen[JOINTS[name]] if name in JOINTS else None
                if place is None or "z" not in joint:
                    continue
                depth = sum(r * p for r, p in zip(stated["R"][2], place)) + stated["t_m"][2]
                ratios[frame["sequence"], picture_of(frame), name] = round((joint["z"] - depth) / joint["czz"] ** 0.5, 3)
        self.assertGreater(len(ratios), 4 * 6)
        # The size of the person is one error for all joints and pictures: this is one draw of it.
        self.assertLess(abs(statistics.median(ratios.values())), 2.5, ratios)
        self.assertLess(statistics.pstdev(ratios.values()), 1.5, ratios)

    def test_a_runner_that_is_killed_comes_back(self):
        sensor = self.looking("blazepose-lite", "--set", "images=true")
        self.frames(sensor, 1)
        runner = subprocess.run(["pgrep", "-P", str(sensor.process.pid), "node"], capture_output=True, text=True, check=True)
        os.kill(int(runner.stdout.split()[0]), signal.SIGKILL)
        sensor.wait_for("/camera", 200, '"started": 2')
        self.frames(sensor, 2)
        picture = sensor.wait_for("/images/color", 200)
        self.assertEqual(picture.type, "image/jpeg")
        code, _ = sensor.stop()
        self.assertEqual(code, 0)

    def test_what_cannot_work_is_said_before_the_start(self):
        for options, words in ((["--camera", "no-such.mp4"], "there is no such file"),
                               (["--camera", str(VIDEO), "--set", "device.camera.model=guess"], "there is no model"),
                               (["--camera", ""], "source")):
            with self.subTest(options):
                done = subprocess.run([SENSOR, *options, "--check"], capture_output=True, text=True, timeout=60, check=False)
                self.assertEqual(done.returncode, 2)
                self.assertIn(words, done.stderr)


if __name__ == "__main__":
    unittest.main()
