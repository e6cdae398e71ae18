"""Readers of DTrack, OSC/VMC and trackd, written from the formats' descriptions, without our encoders' code."""
import math
import re
import struct

JOINTS = ["SpineBase", "SpineMid", "Neck", "Head", "ShoulderLeft", "ElbowLeft", "WristLeft", "HandLeft", "ShoulderRight",
          "ElbowRight", "WristRight", "HandRight", "HipLeft", "KneeLeft", "AnkleLeft", "FootLeft", "HipRight", "KneeRight",
          "AnkleRight", "FootRight", "SpineShoulder", "HandTipLeft", "ThumbLeft", "HandTipRight", "ThumbRight"]

# Joint whose orientation is sent for a joint that has none: the next one towards the pelvis.
TOWARDS_PELVIS = {
    "SpineMid": "SpineBase", "SpineShoulder": "SpineMid", "Neck": "SpineShoulder", "Head": "Neck",
    "ShoulderLeft": "SpineShoulder", "ElbowLeft": "ShoulderLeft", "WristLeft": "ElbowLeft", "HandLeft": "WristLeft",
    "HandTipLeft": "HandLeft", "ThumbLeft": "WristLeft", "ShoulderRight": "SpineShoulder", "ElbowRight": "ShoulderRight",
    "WristRight": "ElbowRight", "HandRight": "WristRight", "HandTipRight": "HandRight", "ThumbRight": "WristRight",
    "HipLeft": "SpineBase", "KneeLeft": "HipLeft", "AnkleLeft": "KneeLeft", "FootLeft": "AnkleLeft",
    "HipRight": "SpineBase", "KneeRight": "HipRight", "AnkleRight": "KneeRight", "FootRight": "AnkleRight"}

# Unity's humanoid, and the joint about which each bone rotates, where it is one of ours.
UNITY_PARENT = {
    "Spine": "Hips", "Chest": "Spine", "UpperChest": "Chest", "Neck": "UpperChest", "Head": "Neck",
    **{side + bone: parent if parent in ("UpperChest", "Hips") else side + parent
       for side in ("Left", "Right")
       for bone, parent in (("Shoulder", "UpperChest"), ("UpperArm", "Shoulder"), ("LowerArm", "UpperArm"),
                            ("Hand", "LowerArm"), ("UpperLeg", "Hips"), ("LowerLeg", "UpperLeg"), ("Foot", "LowerLeg"),
                            ("Toes", "Foot"))}}
JOINT_OF_BONE = {
    "Hips": "SpineBase", "Chest": "SpineMid", "Neck": "SpineShoulder", "Head": "Neck",
    **{side + bone: joint + side for side in ("Left", "Right")
       for bone, joint in (("UpperArm", "Shoulder"), ("LowerArm", "Elbow"), ("Hand", "Wrist"), ("UpperLeg", "Hip"),
                           ("LowerLeg", "Knee"), ("Foot", "Ankle"), ("Toes", "Foot"))}}


def matrix_of(x, y, z, w):
    """Rows of the rotation of a Hamilton quaternion."""
    return ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))


def orientation(joints, name):
    """Orientation (x, y, z, w) sent for a joint of /frame, or None if no joint towards the pelvis has one."""
    while name is not None:
        joint = joints.get(name, {})
        if "qw" in joint:
            return tuple(joint[key] for key in ("qx", "qy", "qz", "qw"))
        name = TOWARDS_PELVIS.get(name)
    return None


def dtrack_lines(datagram):
    """Name of each line -> the rest of it."""
    text = datagram.decode("ascii")
    if not text.endswith("\r\n"):
        raise ValueError("a datagram must end with CR LF")
    return dict(line.split(" ", 1) for line in text[:-2].split("\r\n"))


def dtrack_bodies(datagram):
    """Body id -> (place in mm, rows of the rotation)."""
    count, _, rest = dtrack_lines(datagram)["6d"].partition(" ")
    blocks = [[float(n) for n in block.split()] for block in re.findall(r"\[([^\]]*)\]", rest)]
    if len(blocks) != 3 * int(count):
        raise ValueError(f"{count} bodies, {len(blocks)} blocks")
    bodies = {}
    for (number, quality), pose, b in zip(blocks[0::3], blocks[1::3], blocks[2::3]):
        if quality != 1 or len(pose) != 6 or len(b) != 9:
            raise ValueError("a body is [id 1.000][6 numbers][9 numbers]")
        bodies[int(number)] = (pose[:3], tuple(zip(b[0:3], b[3:6], b[6:9])))
    return bodies


def _osc_string(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 4 - (end - at) % 4


def osc_messages(packet):
    """[(address, [arguments])] of a message or a bundle."""
    if packet.startswith(b"#bundle\0"):
        if struct.unpack_from(">Q", packet, 8)[0] != 1:
            raise ValueError("the time tag is not 'now'")
        messages, at = [], 16
        while at < len(packet):
            size = struct.unpack_from(">i", packet, at)[0]
            messages += osc_messages(packet[at + 4:at + 4 + size])
            at += 4 + size
        return messages
    address, at = _osc_string(packet, 0)
    types, at = _osc_string(packet, at)
    arguments = []
    for kind in types[1:]:
        if kind == "s":
            value, at = _osc_string(packet, at)
        else:
            value, at = struct.unpack_from(">" + kind, packet, at)[0], at + 4
        arguments.append(value)
    if at != len(packet):
        raise ValueError("bytes behind the last argument")
    return [(address, arguments)]


def _turned(q, v):
    return tuple(sum(m * c for m, c in zip(row, v)) for row in matrix_of(*q))


def _times(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def vmc_bone_places(messages):
    """Bone -> its position in our world (x, y, z): multiplied along the chain, then converted from Unity's axes."""
    local = {a[0]: (a[1:4], a[4:8]) for address, a in messages if address == "/VMC/Ext/Bone/Pos"}

    def world(bone):
        if bone not in local:  # the receiver never received it: use its parent's pose
            return world(UNITY_PARENT[bone]) if bone in UNITY_PARENT else ((0, 0, 0), (0, 0, 0, 1))
        p, q = local[bone]
        if bone not in UNITY_PARENT:
            return tuple(p), tuple(q)
        above, turned = world(UNITY_PARENT[bone])
        return tuple(a + b for a, b in zip(above, _turned(turned, p))), _times(turned, q)

    places = {bone: world(bone)[0] for bone in local}
    return {bone: (x, y, -z) for bone, (x, y, z) in places.items()}


def trackd_sensors(block):
    """[(place as written, azimuth, elevation, roll, calibrated)] of a tracker block in native byte order."""
    version, count, offset, size = struct.unpack_from("=4I", block, 0)
    if version != 1 or size != 40:
        raise ValueError("not trackd's layout")
    sensors = []
    for i in range(count):
        x, y, z, azimuth, elevation, roll, _, _, calibrated, _ = struct.unpack_from("=6f2I2i", block, offset + i * size)
        sensors.append(((x, y, z), azimuth, elevation, roll, calibrated))
    return sensors


def trackd_matrix(azimuth, elevation, roll):
    """Rows of Ry(azimuth) Rx(elevation) Rz(roll), degrees."""
    def axis(x, y, z, degrees):
        half = math.radians(degrees) / 2
        return (x * math.sin(half), y * math.sin(half), z * math.sin(half), math.cos(half))
    return matrix_of(*_times(_times(axis(0, 1, 0, azimuth), axis(1, 0, 0, elevation)), axis(0, 0, 1, roll)))
