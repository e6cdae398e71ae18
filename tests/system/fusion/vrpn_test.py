"""VRPN from a real chorus-fusion with simulated sensors: every pose equals that of GET /frame at the same instant."""
import math
import shutil
import subprocess
import unittest

from rig import Rig, free_port, get, get_json, wait_for
from vrpn_client import VrpnClient

JOINTS = ("SpineBase SpineMid Neck Head ShoulderLeft ElbowLeft WristLeft HandLeft ShoulderRight ElbowRight WristRight "
          "HandRight HipLeft KneeLeft AnkleLeft FootLeft HipRight KneeRight AnkleRight FootRight SpineShoulder "
          "HandTipLeft ThumbLeft HandTipRight ThumbRight").split()


def turn_between(a, b):
    """Angle between two nearly equal quaternions x y z w; computed from their difference, because /frame rounds."""
    return 2 * min(math.dist(a, b), math.dist(a, [-x for x in b]))


class Vrpn(Rig):
    def setUp(self):
        super().setUp()
        sensors = [self.sensor(i, 3) for i in range(3)]
        self.port = free_port()
        self.server = self.fusion({f"s{i + 1}": s.url for i, s in enumerate(sensors)},
                                  **{"registration.file": self.given_ring(3), "outputs.vrpn.enabled": "true",
                                     "outputs.vrpn.port": self.port})
        wait_for("a fused body", lambda: get_json(self.server.url + "frame")["bodies"])

    def frame_at(self, us):
        """The published frame of that instant, from the ring of recent ones."""
        newest = get_json(self.server.url + "frame")["sequence"]
        for sequence in range(newest, newest - 60, -1):
            frame = get_json(self.server.url + f"frames/{sequence}")
            if int(frame["capturedNanoseconds"]) // 1000 == us:
                return frame
        self.fail(f"no frame at {us}")

    def one_frame(self, client):
        """Pose by (tracker, sensor) for one whole frame, its time, and whether it came by datagram."""
        poses, time_us, way = {}, None, set()
        for tracker, sensor, us, position, turn, datagram in client.poses():
            if time_us is not None and us != time_us:
                if len(poses) >= 20:
                    return poses, time_us, way
                poses, way = {}, set()
            time_us = us
            way.add(datagram)
            poses[tracker, sensor] = position, turn

    def check(self, client, trackers, by_datagram):
        for _ in range(20):  # at first a UDP client may still get frames by TCP
            poses, us, way = self.one_frame(client)
            if way == {by_datagram}:
                break
        self.assertEqual(way, {by_datagram})
        joints = self.frame_at(us)["bodies"][0]["joints"]
        seen = {name for name, joint in joints.items() if joint["state"] != "NotTracked"}
        for tracker in trackers:
            for number, name in enumerate(JOINTS):
                key = (tracker, number) if "_" not in tracker else (tracker, 0)
                if "_" in tracker and not tracker.endswith("_" + name):
                    continue
                self.assertEqual(key in poses, name in seen, key)
                if key not in poses:
                    continue
                position, turn = poses[key]
                joint = joints[name]
                for axis, value in zip("xyz", position):
                    self.assertAlmostEqual(value, joint[axis], delta=6e-5, msg=key)  # /frame has 0.1 mm
                if "qw" in joint:
                    self.assertLess(turn_between(turn, [joint[k] for k in ("qx", "qy", "qz", "qw")]), 1e-3, key)
        self.assertEqual({tracker for tracker, _ in poses}, {t for t in trackers if "_" not in t or t.split("_")[1] in seen})

    def test_poses_are_those_of_the_frame(self):
        head = "Body0_" + "Head"
        for udp in (True, False):
            client = VrpnClient(["Body0", head], self.port, udp=udp)
            self.addCleanup(client.close)
            self.check(client, ["Body0", head], by_datagram=udp)
            client.ping()
            pong = next(m for m in client.messages() if m[1] == "vrpn_Base pong_message")
            self.assertIn(pong[0], ("Body0", head))
            self.assertIn('chorus_output_clients{output="vrpn"} 1', get(self.server.url + "metrics", accept="*/*")[2].decode())
            client.close()
            wait_for("the client is forgotten", lambda: 'chorus_output_clients{output="vrpn"} 0'
                     in get(self.server.url + "metrics", accept="*/*")[2].decode())
        self.assertEqual(self.server.stop(), 0)

    @unittest.skipUnless(shutil.which("vrpn_print_devices"), "runs where vrpn_print_devices is installed; see docs/guide/verify.md")
    def test_vrpn_reads_it_without_a_warning(self):
        for name in (f"Body0@127.0.0.1:{self.port}", f"Body0@tcp://127.0.0.1:{self.port}",
                     f"Body0_Head@127.0.0.1:{self.port}"):
            seen = subprocess.run(["timeout", "-s", "INT", "5", "stdbuf", "-oL", "vrpn_print_devices", name],
                                  capture_output=True, text=True)
            self.assertEqual(seen.stderr, "", name)
            joints = 1 if "_" in name else 25
            poses = sum(" pos (" in line for line in seen.stdout.splitlines())
            self.assertGreater(poses, 30 * joints, name)  # a few seconds at 30 Hz, including the start
            for what in ("sensor 0:" if joints == 1 else "sensor 24:", " vel ("):
                self.assertIn(what, seen.stdout)

    def test_a_port_in_use_ends_the_program_with_its_name(self):
        second = self.fusion({}, wait=False, **{"outputs.vrpn.enabled": "true", "outputs.vrpn.port": self.port})
        self.assertEqual(second.child.wait(timeout=20), 2)
        self.assertIn("outputs.vrpn", second.text())
        self.assertIn(str(self.port), second.text())


if __name__ == "__main__":
    unittest.main(verbosity=2)
