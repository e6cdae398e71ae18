"""tests/golden/outputs read by independent readers: the poses are those of proto/golden/perfect/fused.json."""
import json
import struct
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
import mxtp_reader as mxtp  # noqa: E402
import natnet_reader as natnet  # noqa: E402
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
                    self.assert_near(a, b, 5e-5, name)  # the JSON file has five digits

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

    def test_mxtp(self):
        found = [mxtp.read(datagram) for datagram in datagrams("fused.mxtp")]
        self.assertEqual([body.character for body in found], [0, 1])
        for body, joints in zip(found, BODIES):
            self.assertEqual(body.sample, FRAME["sequence"])
            self.assertEqual(body.time_ms, int(FRAME["capturedNanoseconds"]) // 10**6 % 2**32)
            compared = 0
            for name, joint in mxtp.JOINT_OF_SEGMENT.items():
                if "x" in joints[joint]:
                    self.assert_near(body.segments[name].place, mxtp.place(joints[joint]), 1e-5, name)
            if mxtp.head(joints):
                self.assert_near(body.segments["Head"].place, mxtp.head(joints), 1e-5, "Head")
            for what, got, expected in mxtp.directions(body.segments, joints):
                self.assert_near(got, expected, 1e-5, what)
                compared += 1
            self.assertGreaterEqual(compared, 15)
        # Untracked parts are placed at their parent and rotate with it; here the joint ShoulderLeft is not tracked.
        left = found[0].segments
        self.assertEqual(left["LeftUpperArm"].turned, left["LeftShoulder"].turned)
        self.assertEqual(left["LeftShoulder"].turned, left["T12"].turned)
        self.assert_near(left["LeftUpperArm"].place, mxtp.place(BODIES[0]["SpineShoulder"]), 1e-5, "LeftUpperArm")

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

    def test_natnet(self):
        (server, told, behind), (kind, described, _), (message, data, _) = map(natnet.read, datagrams("fused.natnet"))
        self.assertEqual((server, kind, message, behind), (natnet.SERVER_INFO, natnet.MODELS, natnet.FRAME, b""))
        self.assertEqual(natnet.server_info(told), ("Chorus", (0, 1, 0, 0), (3, 1, 0, 0), 10**9, 1511, 0, (239, 255, 42, 99)))
        models, frame = natnet.models(described), natnet.frame(data)
        captured = int(FRAME["capturedNanoseconds"])
        self.assertEqual((frame.number, frame.seconds, frame.exposure), (FRAME["sequence"] % 2**31, 12.5, captured))
        self.assertEqual((frame.received - captured, frame.sent - captured), (2_345_000, 2_412_000))
        self.assertEqual((len(models), len(frame.rigid_bodies)), (52, 50))
        names = {model.id: model.name for model in models if model.kind == "rigid body"}
        for body in frame.rigid_bodies:
            slot, name = names[body.id].removeprefix("Body").split("_")
            joints = BODIES[int(slot)]
            self.assertEqual(body.params, 1 if "x" in joints[name] else 0, names[body.id])
            if body.params:
                self.assert_near(body.place, place(joints[name]), 1e-5, name)
                for a, b in zip(matrix_of(*body.turned), matrix_of(*orientation(joints, name))):
                    self.assert_near(a, b, 5e-5, name)
        skeletons = {model.id: model for model in models if model.kind == "skeleton"}
        self.assertEqual([s.id for s in frame.skeletons], [1, 2])
        for skeleton in frame.skeletons:
            tracked = {bone.id & 0xFFFF for bone in skeleton.bones if bone.params}
            model = skeletons[skeleton.id]
            for described, (name, (got, _)) in zip(model.bones, natnet.bones_in_world(skeleton, model).items()):
                if described.id in tracked and name in natnet.JOINT_OF_BONE:
                    self.assert_near(got, place(BODIES[skeleton.id - 1][natnet.JOINT_OF_BONE[name]]), 1e-4, name)
            self.assertGreaterEqual(len(tracked), 10)


if __name__ == "__main__":
    unittest.main()
