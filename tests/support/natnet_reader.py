"""Reads NatNet 3.x datagrams strictly, according to the format's description, without our encoder's code.

Little-endian. A datagram is {u16 message, u16 size, payload}; real servers send bytes after the payload of some answers, so read() returns
those, too. Everything inside a payload must be used up to its last byte.
"""
import struct
from collections import namedtuple

from output_readers import matrix_of

SERVER_INFO, RESPONSE, MODELS, FRAME, ECHO, UNRECOGNIZED = 1, 3, 5, 7, 13, 100

Server = namedtuple("Server", "name version natnet ticks_per_second data_port multicast group")
RigidBody = namedtuple("RigidBody", "id place turned error params")  # turned: x, y, z, w
Skeleton = namedtuple("Skeleton", "id bones")
Marker = namedtuple("Marker", "model member place size params residual")
Frame = namedtuple("Frame", "number marker_sets other_markers rigid_bodies skeletons markers force_plates devices timecode seconds "
                            "exposure received sent params")
Model = namedtuple("Model", "kind name id parent offset markers bones")  # kind: marker set, rigid body, skeleton


class Payload:
    def __init__(self, data):
        self.data, self.at = data, 0

    def one(self, kind):
        value, = struct.unpack_from("<" + kind, self.data, self.at)
        self.at += struct.calcsize("<" + kind)
        return value

    def some(self, kind, count):
        return tuple(self.one(kind) for _ in range(count))

    def text(self):
        end = self.data.index(b"\0", self.at)
        value, self.at = self.data[self.at:end].decode("utf-8"), end + 1
        return value

    def list(self, item, most=100_000):
        count = self.one("I")
        if count > most:
            raise ValueError(f"{count} of them")
        return [item(self) for _ in range(count)]

    def end(self):
        if self.at != len(self.data):
            raise ValueError(f"{len(self.data) - self.at} bytes are left over")


def read(datagram):
    """(message, payload, bytes after it)"""
    message, size = struct.unpack_from("<HH", datagram)
    if len(datagram) < 4 + size:
        raise ValueError("shorter than it says")
    return message, datagram[4:4 + size], datagram[4 + size:]


def server_info(payload):
    p = Payload(payload)
    name = p.some("B", 256)
    name = bytes(name[:name.index(0)]).decode()
    found = Server(name, p.some("B", 4), p.some("B", 4), p.one("Q"), p.one("H"), p.one("B"), p.some("B", 4))
    p.end()
    return found


def echo(payload):
    """(the client's number, the server's ticks)"""
    return struct.unpack("<QQ", payload)


def _rigid_body(p):
    return RigidBody(p.one("i"), p.some("f", 3), p.some("f", 4), p.one("f"), p.one("h"))


def _marker(p):
    member, model = p.one("H"), p.one("H")
    return Marker(model, member, p.some("f", 3), p.one("f"), p.one("h"), p.one("f"))


def _device(p):
    return p.one("i"), p.list(lambda q: q.list(lambda r: r.one("f")))


def frame(payload):
    p = Payload(payload)
    found = Frame(
        number=p.one("i"),
        marker_sets=p.list(lambda q: (q.text(), q.list(lambda r: r.some("f", 3)))),
        other_markers=p.list(lambda q: q.some("f", 3)),
        rigid_bodies=p.list(_rigid_body),
        skeletons=p.list(lambda q: Skeleton(q.one("i"), q.list(_rigid_body))),
        markers=p.list(_marker),
        force_plates=p.list(_device),
        devices=p.list(_device),
        timecode=p.some("I", 2),
        seconds=p.one("d"),
        exposure=p.one("Q"), received=p.one("Q"), sent=p.one("Q"),
        params=p.one("h"))
    if p.one("I") != 0:
        raise ValueError("a frame ends with zero")
    p.end()
    return found


def _rigid_body_model(p):
    name, number, parent, offset = p.text(), p.one("i"), p.one("i"), p.some("f", 3)
    markers = p.one("I")
    places = [p.some("f", 3) for _ in range(markers)]
    labels = p.some("I", markers)
    return Model("rigid body", name, number, parent, offset, list(zip(places, labels)), None)


def _model(p):
    kind = p.one("I")
    if kind == 0:
        return Model("marker set", p.text(), None, None, None, p.list(Payload.text), None)
    if kind == 1:
        return _rigid_body_model(p)
    if kind == 2:
        return Model("skeleton", p.text(), p.one("i"), None, None, None, p.list(_rigid_body_model))
    raise ValueError(f"model of unknown type {kind}")


def models(payload):
    p = Payload(payload)
    found = p.list(_model)
    p.end()
    return found


# Our joint about which a bone rotates, where there is one.
JOINT_OF_BONE = {
    "Hip": "SpineBase", "Chest": "SpineMid", "Neck": "SpineShoulder", "Head": "Neck",
    **{side[0] + bone: joint + side for side in ("Left", "Right")
       for bone, joint in (("UArm", "Shoulder"), ("FArm", "Elbow"), ("Hand", "Wrist"), ("Thigh", "Hip"), ("Shin", "Knee"),
                           ("Foot", "Ankle"), ("Toe", "Foot"))}}


def _product(a, b):
    return tuple(tuple(sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)) for i in range(3))


def bones_in_world(skeleton, model):
    """Name of a bone without that of its skeleton -> (position, rows of its rotation), multiplied along the chain of local bones."""
    done = {0: ((0.0, 0.0, 0.0), ((1, 0, 0), (0, 1, 0), (0, 0, 1)))}
    found = {}
    for bone, described in zip(skeleton.bones, model.bones):
        if bone.id != skeleton.id << 16 | described.id or skeleton.id != model.id:
            raise ValueError("a bone is not the one described")
        above, turned = done[described.parent]
        place = tuple(a + sum(m * c for m, c in zip(row, bone.place)) for a, row in zip(above, turned))
        done[described.id] = place, _product(turned, matrix_of(*bone.turned))
        found[described.name.removeprefix(model.name + "_")] = done[described.id]
    return found


def request(message, payload=b""):
    return struct.pack("<HH", message, len(payload)) + payload
