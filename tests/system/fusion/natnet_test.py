"""Simulated sensors, a real chorus-fusion, and NatNet clients of both kinds: frames carry the poses of GET /frame."""
import json
import os
import socket
import struct
import sys
import threading
import time
import unittest

from rig import ROOT, Rig, get, get_json, wait_for

sys.path.insert(0, str(ROOT / "tests/support"))
import natnet_reader as natnet  # noqa: E402
from output_readers import matrix_of, orientation  # noqa: E402
from ports import free_port  # noqa: E402

SENSORS = 3
PRINTED = 1e-4  # metres; /frame has four decimals
ENOUGH = 20     # number of frames compared
MOST = 1000     # most datagrams read to get them
CONNECT, MODELS, FRAME, KEEP_ALIVE, ECHO = 0, 4, 6, 10, 12


def udp_socket(test):
    s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    test.addCleanup(s.close)
    s.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 22)
    s.settimeout(20)
    return s


class Client:
    def __init__(self, test, port):
        self.socket = udp_socket(test)
        self.socket.bind(("127.0.0.1", 0))
        self.server = ("127.0.0.1", port)

    def say(self, message, payload=b""):
        self.socket.sendto(natnet.request(message, payload), self.server)

    def hear(self, message):
        """The payload of the next datagram with such a message."""
        for _ in range(MOST):
            found, payload, behind = natnet.read(self.socket.recv(65536))
            if behind:
                raise ValueError("bytes behind the payload")
            if found == message:
                return payload
        raise ValueError(f"no message {message}")

    def ask(self, message, answer, payload=b""):
        self.say(message, payload)
        return self.hear(answer)


class NatNet(Rig):
    def tracker(self, **settings):
        sensors = {f"s{i + 1}": self.sensor(i, SENSORS).url for i in range(SENSORS)}
        self.port = free_port()
        fusion = self.fusion(sensors, **{"registration.file": self.given_ring(SENSORS), "outputs.natnet.enabled": "true",
                                         "outputs.natnet.command_port": self.port, **settings})
        wait_for("somebody", lambda: get_json(fusion.url + "frame")["bodies"])
        return fusion

    def frame_of(self, fusion, number):
        """What /frames reports for the newest sequence with these lowest 31 bits; None if it is no longer kept."""
        now = get_json(fusion.url + "frame")["sequence"] + 30
        status, _, body = get(fusion.url + f"frames/{now - (now - number) % 2**31}")
        return json.loads(body) if status == 200 else None

    def assert_near(self, got, expected, tolerance, what):
        self.assertEqual(len(got), len(expected))
        for a, b in zip(got, expected):
            self.assertLessEqual(abs(a - b), tolerance, f"{what}: {got} is not {expected}")

    def check(self, frame, told, models):
        """True when there was a person to compare."""
        self.assertEqual(frame.exposure, int(told["capturedNanoseconds"]))
        self.assertLessEqual(frame.exposure, frame.received)
        self.assertLessEqual(frame.received, frame.sent)
        self.assertEqual((frame.params, frame.timecode), (0, (0, 0)))
        self.assertEqual(len(frame.rigid_bodies), 25 * len(told["bodies"]))
        if len(told["bodies"]) != 1:
            return False
        joints = told["bodies"][0]["joints"]
        names = {model.id: model.name for model in models if model.kind == "rigid body"}
        for body in frame.rigid_bodies:
            name = names[body.id].removeprefix("Body0_")
            self.assertEqual(body.params & 1, 1 if "x" in joints[name] else 0, name)
            if body.params:
                self.assert_near(body.place, [joints[name][key] for key in "xyz"], PRINTED, name)
                for a, b in zip(matrix_of(*body.turned), matrix_of(*orientation(joints, name))):
                    self.assert_near(a, b, 1e-4, name)
        skeleton, = frame.skeletons
        model = next(model for model in models if model.kind == "skeleton" and model.id == skeleton.id)
        tracked = {described.name.removeprefix("Body0_") for described, bone in zip(model.bones, skeleton.bones) if bone.params}
        for name, (place, _) in natnet.bones_in_world(skeleton, model).items():
            if name in tracked and name in natnet.JOINT_OF_BONE:
                joint = joints[natnet.JOINT_OF_BONE[name]]
                self.assert_near(place, [joint[key] for key in "xyz"], 2 * PRINTED, name)
        self.assertGreaterEqual(len(tracked), 15)
        return True

    def compare(self, fusion, next_frame, models):
        checked = 0
        for _ in range(MOST):
            frame = natnet.frame(next_frame())
            told = self.frame_of(fusion, frame.number)
            if told and self.check(frame, told, models):
                checked += 1
            if checked == ENOUGH:
                return
        self.fail(f"only {checked} frames to compare")

    def metric(self, fusion, name):
        lines = get(fusion.url + "metrics", accept="text/plain")[2].decode().splitlines()
        return next(float(line.split()[-1]) for line in lines if line.startswith(f'chorus_output_{name}{{output="natnet"}}'))

    def stated_rate(self, client):
        rate, = struct.unpack("<f", client.ask(2, natnet.RESPONSE, b"FrameRate\0"))
        return rate

    def test_a_client_gets_the_poses_of_frame_while_others_misbehave(self):
        fusion = self.tracker()
        client = Client(self, self.port)
        server = natnet.server_info(client.ask(CONNECT, natnet.SERVER_INFO))
        self.assertEqual((server.name, server.natnet, server.multicast), ("Chorus", (3, 1, 0, 0), 0))
        models = natnet.models(client.ask(MODELS, natnet.MODELS))
        self.assertEqual(len(models), 6 * 26)
        stamp, ticks = natnet.echo(client.ask(ECHO, natnet.ECHO, struct.pack("<Q", 7)))
        self.assertEqual(stamp, 7)
        self.assertLess(abs(ticks - time.time_ns()), 10**9)
        end = time.monotonic() + 20  # Of the first second a busy machine publishes fewer.
        while abs((rate := self.stated_rate(client)) - 30) > 3 and time.monotonic() < end:
            time.sleep(0.3)
        self.assertAlmostEqual(rate, 30, delta=3)
        done = threading.Event()
        noise = threading.Thread(target=self.misbehave, args=(done,))
        noise.start()
        try:
            self.compare(fusion, lambda: (client.say(KEEP_ALIVE), client.hear(natnet.FRAME))[1], models)
        finally:
            done.set()
            noise.join()
        self.assertGreater(self.metric(fusion, "refused_total"), 0)
        self.assertEqual(self.metric(fusion, "failed_total"), 0)
        # How many frames are dropped is the machine's (one that is not sent before the next one is there): that the others cost none is
        # told by the frames that compare() gets while they misbehave.
        self.assertTrue(1 <= self.metric(fusion, "clients") <= 16)

    def misbehave(self, done):
        """Noise, datagrams shorter than they announce, far too long ones, and connections from many ports."""
        kinds = [os.urandom(40), b"", b"\0", struct.pack("<HH", 0, 500), b"\0" * 60000, natnet.request(77), natnet.request(7)]
        while not done.wait(0.02):
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
                for kind in kinds:
                    stranger.sendto(kind, ("127.0.0.1", self.port))
                stranger.sendto(natnet.request(CONNECT), ("127.0.0.1", self.port))

    def test_the_group_gets_the_same(self):
        member, data_port = udp_socket(self), free_port()
        member.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        member.bind(("", data_port))
        try:
            member.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                              socket.inet_aton("239.255.42.99") + socket.inet_aton("127.0.0.1"))
        except OSError as error:
            self.skipTest(f"runs where loopback has multicast: {error}")
        fusion = self.tracker(**{"outputs.natnet.transmission": "multicast", "outputs.natnet.data_port": data_port})
        client = Client(self, self.port)
        server = natnet.server_info(client.ask(CONNECT, natnet.SERVER_INFO))
        self.assertEqual((server.multicast, server.data_port, server.group), (1, data_port, (239, 255, 42, 99)))
        models = natnet.models(client.ask(MODELS, natnet.MODELS))

        def next_frame():
            message, payload, _ = natnet.read(member.recv(65536))
            self.assertEqual(message, natnet.FRAME)
            return payload
        self.compare(fusion, next_frame, models)
        client.socket.settimeout(0.2)
        with self.assertRaises(TimeoutError):
            client.socket.recv(65536)


if __name__ == "__main__":
    unittest.main()
