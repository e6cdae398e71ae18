"""Simulated sensors, a real chorus-fusion, and its outputs: DTrack, MXTP02, VMC, VRChat and trackd carry the poses of GET /frame."""
import ctypes
import json
import shutil
import socket
import subprocess
import sys
import time
import unittest
import uuid

from rig import ROOT, Rig, free_port, get, get_json, wait_for

sys.path.insert(0, str(ROOT / "tests/support"))
import mxtp_reader as mxtp  # noqa: E402
from output_readers import (JOINT_OF_BONE, JOINTS, dtrack_bodies, dtrack_lines, matrix_of, orientation, osc_messages,  # noqa: E402
                            trackd_matrix, trackd_sensors, vmc_bone_places)

SENSORS = 3
PRINTED = 1e-4  # metres; /frame has four decimals
ENOUGH = 20     # number of frames compared
MOST = 1000     # most datagrams read to get them


def receiver(test):
    s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    test.addCleanup(s.close)
    s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
    s.bind(("127.0.0.1", 0))
    s.settimeout(20)
    return s


def target(s):
    return json.dumps([f"127.0.0.1:{s.getsockname()[1]}"])


class Outputs(Rig):
    def assert_near(self, got, expected, tolerance, what):
        self.assertEqual(len(got), len(expected))
        for a, b in zip(got, expected):
            self.assertLessEqual(abs(a - b), tolerance, f"{what}: {got} is not {expected}")

    def tracker(self, **settings):
        sensors = {f"s{i + 1}": self.sensor(i, SENSORS).url for i in range(SENSORS)}
        return self.fusion(sensors, **{"registration.file": self.given_ring(SENSORS), **settings})

    def full_sequence(self, fusion, low, bits):
        """The newest sequence with these lowest bits: the protocols send only these bits."""
        now = get_json(fusion.url + "frame")["sequence"] + 30
        return now - (now - low) % 2**bits

    def joints_of(self, fusion, sequence):
        """Joints of the only body in that frame, by name."""
        status, _, body = get(fusion.url + f"frames/{sequence}")
        self.assertEqual(status, 200, body)
        bodies = json.loads(body)["bodies"]
        return bodies[0]["joints"] if bodies else {}

    def test_dtrack_and_vmc_carry_the_poses_of_frame(self):
        dtrack, vmc = receiver(self), receiver(self)
        fusion = self.tracker(**{
            "outputs.dtrack.enabled": "true", "outputs.dtrack.targets": target(dtrack), "outputs.dtrack.source_port": 0,
            "outputs.vmc.enabled": "true", "outputs.vmc.targets": target(vmc)})
        wait_for("somebody", lambda: get_json(fusion.url + "frame")["bodies"])
        first = None
        checked = 0
        for _ in range(MOST):
            datagram = dtrack.recv(65536)
            sequence = self.full_sequence(fusion, int(dtrack_lines(datagram)["fr"]), 32)
            bodies = dtrack_bodies(datagram)
            first = sequence if first is None else first
            if bodies and get(fusion.url + f"frames/{sequence}")[0] == 200:
                self.check_dtrack(self.joints_of(fusion, sequence), bodies)
                checked += 1
                if checked == ENOUGH:
                    break
        self.assertEqual(checked, ENOUGH)
        self.check_vmc(fusion, vmc, first)
        metrics = get(fusion.url + "metrics", accept="text/plain")[2].decode()
        for line in metrics.splitlines():
            if line.startswith(("chorus_output_dropped_total", "chorus_output_failed_total")):
                self.assertTrue(line.endswith(" 0"), line)

    def check_dtrack(self, joints, bodies):
        for i, name in enumerate(JOINTS):
            self.assertEqual(i in bodies, "x" in joints[name], name)
            if i not in bodies:
                continue
            (x, y, z), turned = (joints[name][key] for key in "xyz"), orientation(joints, name)
            self.assert_near(bodies[i][0], (1000 * x, -1000 * z, 1000 * y), 1000 * PRINTED, name)
            (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = matrix_of(*turned)
            for a, b in zip(bodies[i][1], ((xx, -xz, xy), (-zx, zz, -zy), (yx, -yz, yy))):
                self.assert_near(a, b, 1e-4, name)

    def check_vmc(self, fusion, vmc, first):
        """Frame k of VMC is frame first + k, because both outputs got the same frames, beginning with the same one."""
        messages, sequence, checked = [], first - 1, 0
        for _ in range(MOST):
            found = osc_messages(vmc.recv(65536))
            if found[0][0] == "/VMC/Ext/OK":  # this message begins a frame
                checked += 1 if messages and self.matches_vmc(fusion, sequence, messages) else 0
                if checked == ENOUGH:
                    return
                messages, sequence = [], sequence + 1
            messages += found
        self.fail(f"only {checked} frames of VMC to compare")

    def matches_vmc(self, fusion, sequence, messages):
        places = vmc_bone_places(messages)
        if not places or get(fusion.url + f"frames/{sequence}")[0] != 200:
            return False
        joints = self.joints_of(fusion, sequence)
        self.assertGreaterEqual(len(places), 15)
        for bone, place in places.items():
            if bone in JOINT_OF_BONE:
                joint = joints[JOINT_OF_BONE[bone]]
                self.assert_near(place, [joint[key] for key in "xyz"], PRINTED, bone)
        return True

    def test_mxtp_carries_the_poses_of_frame(self):
        receiving = receiver(self)
        fusion = self.tracker(**{"outputs.mxtp.enabled": "true", "outputs.mxtp.targets": target(receiving)})
        checked = 0
        for _ in range(MOST):
            body = mxtp.read(receiving.recv(65536))
            sequence = self.full_sequence(fusion, body.sample, 32)
            if get(fusion.url + f"frames/{sequence}")[0] != 200:
                continue  # no longer kept
            self.check_mxtp(self.joints_of(fusion, sequence), body)
            checked += 1
            if checked == ENOUGH:
                return
        self.fail(f"only {checked} frames of MXTP02 to compare")

    def check_mxtp(self, joints, body):
        self.assertEqual(body.character, 0)
        for name, joint in mxtp.JOINT_OF_SEGMENT.items():
            if "x" in joints[joint]:
                self.assert_near(body.segments[name].place, mxtp.place(joints[joint]), PRINTED, name)
        if mxtp.head(joints):
            self.assert_near(body.segments["Head"].place, mxtp.head(joints), 3 * PRINTED, "Head")
        for what, got, expected in mxtp.directions(body.segments, joints):
            # Four decimals for short bones: a hand of 15 cm is exact to a thousandth; a plane of two bones is less exact.
            self.assert_near(got, expected, 1e-2, what)

    def test_trackd_is_there_while_the_server_runs(self):
        key = 0x44000000 + (uuid.uuid4().int & 0xFFFFF) * 2
        fusion = self.tracker(**{"outputs.trackd.enabled": "true", "outputs.trackd.tracker_key": key,
                                 "outputs.trackd.controller_key": key + 1, "outputs.trackd.sensors": 50})
        wait_for("somebody", lambda: get_json(fusion.url + "frame")["bodies"])
        libc = ctypes.CDLL(None, use_errno=True)
        libc.shmat.restype = ctypes.c_void_p
        segment = libc.shmget(key, 0, 0)
        self.assertGreaterEqual(segment, 0)
        place = libc.shmat(segment, None, 0)

        def read():
            """A block that did not change while it was read, and the lowest bits of its sequence."""
            while True:
                before, after = (ctypes.string_at(place, 28 + 50 * 40) for _ in range(2))
                sensors = trackd_sensors(before)
                if before == after and sensors[0][4]:
                    return sensors, int.from_bytes(before[28 + 36:28 + 40], "little", signed=True)
                time.sleep(0.002)

        for _ in range(10):
            sensors, low = read()
            self.check_trackd(self.joints_of(fusion, self.full_sequence(fusion, low, 31)), sensors)
            time.sleep(0.05)
        fusion.stop()
        self.addCleanup(libc.shmctl, segment, 0, None)  # IPC_RMID
        self.assertEqual(libc.shmget(key + 1, 0, 0), -1, "nobody is attached to the controller's")
        sensors = trackd_sensors(ctypes.string_at(place, 28 + 50 * 40))
        self.assertEqual({sensor[4] for sensor in sensors}, {0}, "who stays attached sees nobody")
        self.assertEqual(libc.shmget(key, 0, 0), segment, "and is found again by the next run")
        libc.shmdt(ctypes.c_void_p(place))

    def check_trackd(self, joints, sensors):
        for sensor, name in enumerate(("Head", "HandRight", "HandLeft", "SpineBase")):
            place, azimuth, elevation, roll, calibrated = sensors[sensor]
            self.assertEqual(calibrated, 1 if "x" in joints[name] else 0)
            if calibrated:
                self.assert_near([c * 0.3048 for c in place], [joints[name][key] for key in "xyz"], PRINTED, name)
                rows = zip(trackd_matrix(azimuth, elevation, roll), matrix_of(*orientation(joints, name)))
                for a, b in rows:
                    self.assert_near(a, b, 1e-4, name)

    @unittest.skipUnless(shutil.which("oscdump"), "runs where oscdump is installed (Debian: liblo-tools)")
    def test_oscdump_reads_vmc_and_vrchat(self):
        ports = {"vmc": free_port(), "vrchat": free_port()}
        logs = {name: open(f"{self.folder.name}/{name}.txt", "w+") for name in ports}
        dumps = [subprocess.Popen(["oscdump", "-L", str(port)], stdout=logs[name], stderr=subprocess.STDOUT)
                 for name, port in ports.items()]
        try:
            settings = {f"outputs.{name}.enabled": "true" for name in ports}
            settings |= {f"outputs.{name}.targets": json.dumps([f"127.0.0.1:{port}"]) for name, port in ports.items()}
            fusion = self.tracker(**settings)
            wait_for("somebody", lambda: get_json(fusion.url + "frame")["bodies"])

            def said(name):
                logs[name].seek(0)
                return logs[name].read()

            wait_for("all of VMC", lambda: all(text in said("vmc") for text in (
                "/VMC/Ext/OK iiii 1 3 0 1", "/VMC/Ext/Root/Pos sfffffff \"root\"", "/VMC/Ext/Bone/Pos sfffffff \"Hips\"",
                "\"LeftHand\"", "\"RightFoot\"")))
            wait_for("all of VRChat", lambda: all(f"/tracking/trackers/{n}/{what} fff" in said("vrchat")
                                                  for n in (1, 2, 3, 4, 5, 6, 7, 8, "head")
                                                  for what in ("position", "rotation")))
            for name in ports:
                self.assertNotIn("nan", said(name).lower())
                self.assertNotIn("error", said(name).lower())
        finally:
            for dump in dumps:
                dump.kill()
                dump.wait()
            for log in logs.values():
                log.close()


if __name__ == "__main__":
    unittest.main()
