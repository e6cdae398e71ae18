"""Three sensors fed by Python senders, each in another way, one with a clock that is minutes off: registered from the walk and fused."""
import math
import subprocess
import sys
import unittest

from bridge_rig import BIN, EXAMPLES, BridgeRig, get_json, wait_for

import synthetic_walk

COUNT = 3
REGISTERED_WITHIN_S = 100
PLACES = ("x", "y", "z")


def place_of(thing):
    return [thing[axis] for axis in PLACES]


class Cell(BridgeRig):
    def status(self, fusion):
        done = subprocess.run([BIN / "chorus", "status", "--url", fusion.url], capture_output=True, text=True, check=False)
        return done.stdout

    def sender(self, sensor, url, camera, *more):
        process = subprocess.Popen([sys.executable, "-B", EXAMPLES / "synthetic_walk.py", url, "--camera", f"{camera}/{COUNT}", *more])
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)
        return process

    def test_pushed_frames_become_one_tracker(self):
        sensors = [self.bridge(f"s{i + 1}") for i in range(COUNT)]
        self.sender(sensors[0], sensors[0].ws, 0, "--clock-off", "240")
        self.sender(sensors[1], sensors[1].url + "push", 1, "--layout", "coco_17", "--clock-off", "-3")
        last = self.sender(sensors[2], sensors[2].path, 2)
        fusion = self.fusion({f"s{i + 1}": sensor.url for i, sensor in enumerate(sensors)}, wait=False)

        def placed():
            found = get_json(fusion.url + "registration")["sensors"]
            return len(found) == COUNT and all(one["verdict"] == "Good" for one in found.values()) and found

        found = wait_for("all are registered well", placed, patience=REGISTERED_WITHIN_S)
        side = 2 * synthetic_walk.RADIUS * math.sin(math.pi / COUNT)
        for one, other in (("s1", "s2"), ("s2", "s3"), ("s3", "s1")):
            self.assertAlmostEqual(math.dist(place_of(found[one]), place_of(found[other])), side, delta=0.06)

        def fused_by_all():
            frame = get_json(fusion.url + "frame")
            joints = frame["bodies"][0]["joints"]
            return len(frame["bodies"]) == 1 and len(joints["Head"].get("contributors", [])) == COUNT and frame

        frame = wait_for("one body of three sensors", fused_by_all)
        at = int(frame["capturedNanoseconds"]) / 1e9 % 86400
        truth = synthetic_walk.person(at)
        for name in ("Head", "SpineBase", "KneeLeft", "ElbowRight"):
            fused = place_of(frame["bodies"][0]["joints"][name])
            for i in range(COUNT):
                expected = math.dist(truth[name], synthetic_walk.Camera(i, COUNT).at)
                self.assertAlmostEqual(math.dist(fused, place_of(found[f"s{i + 1}"])), expected, delta=0.1, msg=f"{name} from s{i + 1}")

        last.terminate()
        wait_for("chorus status says who is missing and why", lambda: (text := self.status(fusion)) and "no new frame" in text and
                 '"synthetic walk 2" (local socket) left' in text)
        wait_for("the others go on", lambda: get_json(fusion.url + "frame")["bodies"])


if __name__ == "__main__":
    unittest.main()
