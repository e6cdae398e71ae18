"""tests/golden/outputs through readers of their own: the poses are those of the twin, proto/golden/perfect/fused.json."""
import json
import struct
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
from output_readers import (JOINT_OF_BONE, JOINTS, dtrack_bodies, dtrack_lines, matrix_of, orientation, osc_messages,  # noqa: E402
                            trackd_matrix, trackd_sensors, vmc_bone_places)

GOLDEN = ROOT / "tests/golden/outputs"
FRAME = json.loads((ROOT / "proto/golden/perfect/fused.json").read_text())
BODIES = [body["joints"] for body in FRAME["bodies"]]


def datagrams(name):
    data, found = (GOLDEN / name).read_bytes(), []
    while data:
        size = struct.unpack(">I", data[:4])[0]
        found.append(data[4:4 + size])
        data = data[4 + size:]
    return found


def place(joint):
    return joint["x"], joint["y"], joint["z"]


class Golden(unittest.TestCase):
    def assert_near(self, got, expected, tolerance, what):
        self.assertEqual(len(got), len(expected))
        for a, b in zip(got, expected):
            self.assertLessEqual(abs(a - b), tolerance, f"{what}: {got} is not {expected}")

    def test_dtrack(self):
        data = (GOLDEN / "fused.dtrack").read_bytes()
        lines, bodies = dtrack_lines(data), dtrack_bodies(data)
        self.assertEqual(lines["fr"], str(FRAME["sequence"]))
        self.assertEqual(lines["ts2"], "1795246604 101847 2345")
        self.assertEqual((lines["6dcal"], lines["3d"]), ("150", "0"))
        for slot, joints in enumerate(BODIES):
            for i, name in enumerate(JOINTS):
                self.assertEqual(25 * slot + i in bodies, "x" in joints[name], name)
                if "x" not in joints[name]:
                    continue
                got, rotation = bodies[25 * slot + i]
                x, y, z = place(joints[name])
                self.assert_near(got, (1000 * x, -1000 * z, 1000 * y), 1e-3, name)
                (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = matrix_of(*orientation(joints, name))
                expected = ((xx, -xz, xy), (-zx, zz, -zy), (yx, -yz, yy))
                for a, b in zip(rotation, expected):
                    self.assert_near(a, b, 5e-5, name)  # the twin has five digits

    def test_vmc(self):
        messages = [m for datagram in datagrams("fused.vmc") for m in osc_messages(datagram)]
        self.assertEqual(messages[:2], [("/VMC/Ext/OK", [1, 3, 0, 1]), ("/VMC/Ext/T", [12.5])])
        places = vmc_bone_places(messages)
        self.assertIn("RightFoot", places)
        for bone, got in places.items():
            if bone in JOINT_OF_BONE:
                self.assert_near(got, place(BODIES[0][JOINT_OF_BONE[bone]]), 1e-4, bone)
        self.assertNotIn("LeftUpperArm", places)  # its shoulder is not tracked

    def test_vrchat(self):
        messages = dict(m for datagram in datagrams("fused.vrchat") for m in osc_messages(datagram))
        for number, joint in (("1", "SpineBase"), ("6", "SpineMid"), ("head", "Neck"), ("4", "KneeLeft")):
            x, y, z = place(BODIES[1][joint])
            self.assert_near(messages[f"/tracking/trackers/{number}/position"], (x, y, -z), 1e-5, number)
            for angle in messages[f"/tracking/trackers/{number}/rotation"]:
                self.assertLessEqual(abs(angle), 180)
        self.assertNotIn("/tracking/trackers/8/position", messages)  # the right elbow is not tracked

    def test_trackd(self):
        sensors = trackd_sensors((GOLDEN / "fused.trackd").read_bytes())
        first = ["Head", "HandRight", "HandLeft"]
        order = first + [name for name in JOINTS if name not in first]
        for slot, joints in enumerate(BODIES):
            for i, name in enumerate(order):
                got, azimuth, elevation, roll, calibrated = sensors[25 * slot + i]
                self.assertEqual(calibrated, 1 if "x" in joints[name] else 0, name)
                if calibrated:
                    self.assert_near(got, [c / 0.3048 for c in place(joints[name])], 1e-5, name)
                    rows = zip(trackd_matrix(azimuth, elevation, roll), matrix_of(*orientation(joints, name)))
                    for a, b in rows:
                        self.assert_near(a, b, 5e-5, name)


if __name__ == "__main__":
    unittest.main()
