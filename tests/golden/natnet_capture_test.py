"""Our NatNet reader reads what a real Motive sent: it must be right before it judges our own frames."""
import math
import os
import re
import struct
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
import natnet_reader as natnet  # noqa: E402

PACKETS = ROOT / "tests/data/natnet_capture"
CAPTURE = Path(os.environ.get("CHORUS_SHARED", ROOT / "../shared")) / "data/natnet_capture/test_data/raw"
COMMANDS, DATA = 1510, 1511


def payload(name, message):
    found, data, behind = natnet.read((PACKETS / f"{name}.bin").read_bytes())
    assert (found, behind) == (message, b"")
    return data


class Packets(unittest.TestCase):
    def test_the_server_says_who_it_is(self):
        server = natnet.server_info(payload("serverinfo", natnet.SERVER_INFO))
        self.assertEqual(server[:3], ("Motive", (2, 1, 0, 0), (3, 0, 0, 0)))
        self.assertEqual(server[4:], (1511, 1, (239, 255, 42, 99)))

    def test_models(self):
        body, *sets = natnet.models(payload("modeldef", natnet.MODELS))
        self.assertEqual(body[:4], ("rigid body", "RaceQuad", 2, -1))
        self.assertEqual(len(body.markers), 5)
        self.assertEqual([(s.name, len(s.markers)) for s in sets], [("RaceQuad", 5), ("all", 5)])

    def test_frames(self):
        for name, number, body in (("mocapframe", 162734, 2), ("mocapframe_occluded", 269007, 7)):
            frame = natnet.frame(payload(name, natnet.FRAME))
            self.assertEqual((frame.number, [b.id for b in frame.rigid_bodies]), (number, [body]))
            self.assertAlmostEqual(math.hypot(*frame.rigid_bodies[0].turned), 1, places=5)

    def test_an_echo(self):
        asked, = struct.unpack("<Q", payload("echorequest", 12))
        self.assertEqual(natnet.echo(payload("echoresponse", natnet.ECHO))[0], asked)

    def test_what_is_cut_off_or_too_long_is_refused(self):
        whole = payload("mocapframe", natnet.FRAME)
        for wrong in (whole[:-1], whole + b"\0", whole[:100]):
            with self.assertRaises((ValueError, struct.error)):
                natnet.frame(wrong)


def datagrams(path):
    """(source port, target port, payload) of the UDP packets over IPv4 in a pcapng file."""
    data, at = path.read_bytes(), 0
    while at < len(data):
        kind, size = struct.unpack_from("<II", data, at)
        if kind == 6:  # enhanced packet
            ether = data[at + 28:at + 28 + struct.unpack_from("<I", data, at + 20)[0]]
            ip = ether[14:]
            if ether[12:14] == b"\x08\0" and ip[9] == 17:
                header = (ip[0] & 15) * 4
                yield *struct.unpack_from(">HH", ip, header), ip[header + 8:]
        at += size


@unittest.skipUnless(CAPTURE.is_dir(), f"runs where the whole capture is there: {CAPTURE}")
class WholeCapture(unittest.TestCase):
    """Compares with the output of the vendor's own sample client for the same frames."""

    def test_every_datagram_can_be_read(self):
        readers = {natnet.SERVER_INFO: natnet.server_info, natnet.MODELS: natnet.models, natnet.FRAME: natnet.frame,
                   natnet.ECHO: natnet.echo}
        seen = {}
        for source, _, data in datagrams(CAPTURE / "traffic.pcapng"):
            message, body, _ = natnet.read(data)
            if source in (COMMANDS, DATA) and message in readers:
                readers[message](body)
                seen[message] = seen.get(message, 0) + 1
        self.assertEqual(seen, {natnet.SERVER_INFO: 2, natnet.ECHO: 9, natnet.FRAME: 518, natnet.MODELS: 1})

    def test_frames_say_what_the_vendor_printed(self):
        everything = list(datagrams(CAPTURE / "traffic.pcapng"))
        read = [natnet.read(data) for _, _, data in everything]
        frames = {f.number: f for f in (natnet.frame(body) for message, body, _ in read if message == natnet.FRAME)}
        ticks = next(natnet.server_info(body) for message, body, _ in read if message == natnet.SERVER_INFO).ticks_per_second
        text = (CAPTURE / "SampleClient_output.txt").read_text()
        printed = re.findall(r"FrameID : (\d+)\nTimestamp : ([\d.]+)\nSoftware latency : ([\d.]+) .*\n"
                             r"System latency : ([\d.]+)", text)
        self.assertGreater(len(printed), 200)
        for number, stamp, software, system in printed:
            frame = frames[int(number)]
            milliseconds = [1000 * (frame.sent - since) / ticks for since in (frame.received, frame.exposure)]
            self.assert_printed((frame.seconds, *milliseconds), (stamp, software, system))
        bodies = re.findall(r"FrameID : (\d+)\n(?:(?!FrameID).*\n)*?Rigid Body \[ID=(\d+) .*Valid=(\d)\]\n.*\n\t([-.\d\t]+)", text)
        self.assertGreater(len(bodies), 200)
        for number, body, valid, pose in bodies:
            found, = frames[int(number)].rigid_bodies
            self.assertEqual((found.id, found.params & 1), (int(body), int(valid)))
            self.assert_printed(found.place + found.turned, pose.split())

    def assert_printed(self, numbers, texts):
        """Numbers printed with two digits; a five after them may have been rounded either way."""
        self.assertEqual(len(numbers), len(texts))
        for number, text in zip(numbers, texts):
            self.assertLessEqual(abs(number - float(text)), 0.005 + 1e-6)


if __name__ == "__main__":
    unittest.main()
