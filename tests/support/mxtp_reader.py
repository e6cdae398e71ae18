"""Reads MXTP02 datagrams strictly, according to the format's description, without our encoder's code.

Big-endian: "MXTP02", u32 sample, u8 datagram (0x80: the only one), u8 items, u32 time code in ms, u8 character, u8 body segments,
u8 props, u8 finger segments, u16 reserved, u16 bytes of payload; then per segment u32 id, f32 x y z, f32 qw qx qy qz.
Metres, right-handed, +z up; a person in T-pose who looks along +x has identities only.
"""
import math
import struct
from collections import namedtuple

from output_readers import matrix_of

Datagram = namedtuple("Datagram", "sample time_ms character segments")  # segments: name -> Segment
Segment = namedtuple("Segment", "place turned")  # turned: x, y, z, w

NAMES = ["Pelvis", "L5", "L3", "T12", "T8", "Neck", "Head", "RightShoulder", "RightUpperArm", "RightForeArm", "RightHand",
         "LeftShoulder", "LeftUpperArm", "LeftForeArm", "LeftHand", "RightUpperLeg", "RightLowerLeg", "RightFoot", "RightToe",
         "LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "LeftToe"]

# Segments whose origin is at one of our joints.
JOINT_OF_SEGMENT = {
    "Pelvis": "SpineBase", "T12": "SpineMid", "Neck": "SpineShoulder",
    **{side + segment: joint + side for side in ("Left", "Right")
       for segment, joint in (("UpperArm", "Shoulder"), ("ForeArm", "Elbow"), ("Hand", "Wrist"), ("UpperLeg", "Hip"),
                              ("LowerLeg", "Knee"), ("Foot", "Ankle"), ("Toe", "Foot"))}}

# Segments along two of our joints, and their directions in T-pose. A sole is flat if ankle to foot points down by 25 degrees.
UP, DOWN, LEFT, RIGHT = (0, 0, 1), (0, 0, -1), (0, 1, 0), (0, -1, 0)
AHEAD_AND_DOWN = (math.cos(math.radians(25)), 0, -math.sin(math.radians(25)))
ALONG = {
    "L5": ("SpineBase", "SpineMid", UP), "L3": ("SpineBase", "SpineMid", UP), "T12": ("SpineMid", "SpineShoulder", UP),
    "Neck": ("SpineShoulder", "Neck", UP), "Head": ("Neck", "Head", UP), "Pelvis": ("HipRight", "HipLeft", LEFT),
    **{side + segment: (start + side, end + side, out if arm else AHEAD_AND_DOWN if segment == "Foot" else DOWN)
       for side, out in (("Left", LEFT), ("Right", RIGHT))
       for segment, start, end, arm in (("UpperArm", "Shoulder", "Elbow", True), ("ForeArm", "Elbow", "Wrist", True),
                                        ("Hand", "Wrist", "HandTip", True), ("UpperLeg", "Hip", "Knee", False),
                                        ("LowerLeg", "Knee", "Ankle", False), ("Foot", "Ankle", "Foot", False))}}

# Pairs that bend in one plane, and the cross product of the upper and the lower segment in T-pose.
HINGES = {("LeftUpperArm", "LeftForeArm"): DOWN, ("RightUpperArm", "RightForeArm"): UP,
          ("LeftUpperLeg", "LeftLowerLeg"): LEFT, ("RightUpperLeg", "RightLowerLeg"): LEFT}


def read(data):
    magic, sample, number, items, time_ms, character, body, props, fingers, reserved, payload = struct.unpack_from(">6sIBBIBBBBHH", data)
    if (magic, number, items, body, props, fingers, reserved) != (b"MXTP02", 0x80, 23, 23, 0, 0, 0):
        raise ValueError("not the only datagram of a body of 23 segments")
    if (payload, len(data)) != (736, 760):
        raise ValueError(f"{len(data)} bytes that say their payload has {payload}")
    segments = {}
    for i, name in enumerate(NAMES):
        number, *numbers = struct.unpack_from(">I7f", data, 24 + 32 * i)
        if number != i + 1 or not all(map(math.isfinite, numbers)):
            raise ValueError(f"segment {i + 1}: {number}, {numbers}")
        x, y, z, qw, qx, qy, qz = numbers
        if abs(qw * qw + qx * qx + qy * qy + qz * qz - 1) > 1e-4:
            raise ValueError(f"segment {number} does not turn: {numbers}")
        segments[name] = Segment((x, y, z), (qx, qy, qz, qw))
    return Datagram(sample, time_ms, character, segments)


def place(joint):
    """A joint of /frame converted to Xsens' axes."""
    return joint["z"], joint["x"], joint["y"]


def head(joints):
    """Where the head begins and MVN's neck ends: our Neck is half-way there from SpineShoulder; None if these are not tracked."""
    if "x" not in joints["Neck"] or "x" not in joints["SpineShoulder"]:
        return None
    return tuple(2 * n - s for n, s in zip(place(joints["Neck"]), place(joints["SpineShoulder"])))


def directions(segments, joints):
    """(name, T-pose direction rotated by the segment, direction according to the joints), where both are known."""
    def way(start, end):
        if "x" not in joints[start] or "x" not in joints[end]:
            return None
        difference = [b - a for a, b in zip(place(joints[start]), place(joints[end]))]
        return [c / math.hypot(*difference) for c in difference]

    def turned(name, direction):
        return [sum(m * c for m, c in zip(row, direction)) for row in matrix_of(*segments[name].turned)]

    ways = {name: way(start, end) for name, (start, end, _) in ALONG.items()}
    for name, expected in ways.items():
        if expected:
            yield name, turned(name, ALONG[name][2]), expected
    for (upper, lower), hinge in HINGES.items():
        (ux, uy, uz), (lx, ly, lz) = ways[upper] or (0, 0, 0), ways[lower] or (0, 0, 0)
        normal = (uy * lz - uz * ly, uz * lx - ux * lz, ux * ly - uy * lx)
        if math.hypot(*normal) > math.sin(math.radians(31)):  # for straighter limbs the twist is a guess
            expected = [c / math.hypot(*normal) for c in normal]
            yield upper + "'s hinge", turned(upper, hinge), expected
            yield lower + "'s hinge", turned(lower, hinge), expected
