"""A VRPN client in a page of Python, written from the protocol's description: for tests, and to look at a stream.

    python3 vrpn_client.py Body0@127.0.0.1:3883        (UDP)
    python3 vrpn_client.py Body0@tcp://127.0.0.1:3883
"""
import re
import select
import socket
import struct
import sys
import time

COOKIE = b"vrpn: ver. 07.35  0".ljust(24, b"\0")


def message(sender, kind, payload=b""):
    length = 24 + len(payload)
    head = struct.pack(">IIIiiI", length, int(time.time()), 0, sender, kind, 0)
    return (head + payload).ljust(-(-length // 8) * 8, b"\0")


def description(kind, number, name):
    return message(number, kind, struct.pack(">I", len(name) + 1) + name.encode() + b"\0")


class VrpnClient:
    def __init__(self, trackers, port, host="127.0.0.1", udp=True):
        self.trackers = trackers
        self.senders, self.types = {}, {}
        self.bytes = b""
        self.datagrams = None
        if udp:
            self._call_back(host, port)
        else:
            self.stream = socket.create_connection((host, port))
        opening = COOKIE
        if self.datagrams:
            address, datagram_port = self.datagrams.getsockname()
            opening += message(datagram_port, -3, address.encode() + b"\0")
        opening += b"".join(description(-1, i, name) for i, name in enumerate(trackers))
        self.stream.sendall(opening + description(-2, 0, "vrpn_Base ping_message"))
        self._fill(24)
        if not self.bytes.startswith(b"vrpn: ver. 07."):
            raise ValueError(f"not a VRPN server: {self.bytes[:24]}")
        self.bytes = self.bytes[24:]

    def _call_back(self, host, port):
        self.datagrams = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.datagrams.connect((host, port))  # only to find out which of our addresses is used for it
        own = self.datagrams.getsockname()[0]
        self.datagrams.close()
        self.datagrams = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.datagrams.bind((own, 0))
        listener = socket.create_server((own, 0))
        listener.settimeout(2)
        for _ in range(10):
            self.datagrams.sendto(f"{own} {listener.getsockname()[1]}\0".encode(), (host, port))
            try:
                self.stream = listener.accept()[0]
                break
            except TimeoutError:
                continue
        else:
            raise TimeoutError("the server does not connect back")
        listener.close()

    def _fill(self, size):
        while len(self.bytes) < size:
            got = self.stream.recv(65536)
            if not got:
                raise EOFError("the server has closed the connection")
            self.bytes += got

    def _cut(self, data):
        """(message or None, rest); raises an error for what the protocol does not allow."""
        length, seconds, us, sender, kind, _ = struct.unpack(">IIIiiI", data[:24])
        stored = -(-length // 8) * 8
        if not 24 <= length <= 64000 or stored > len(data):
            raise ValueError(f"a message of {length} bytes")
        payload = data[24:length]
        if kind in (-1, -2):
            (count,) = struct.unpack(">I", payload[:4])
            if count + 4 != len(payload):
                raise ValueError("a bad description")
            (self.senders if kind == -1 else self.types)[sender] = payload[4:-1].decode()
            return None, data[stored:]
        if kind not in self.types:
            return None, data[stored:]  # a datagram has overtaken the description
        return (self.senders.get(sender), self.types[kind], seconds * 10**6 + us, payload), data[stored:]

    def ping(self):
        for i in range(len(self.trackers)):
            self.stream.sendall(message(i, 0))

    def messages(self, patience=10.0):
        """Yields (tracker, type, time in us, payload, by datagram?)."""
        sockets = [s for s in (self.stream, self.datagrams) if s]
        while True:
            while len(self.bytes) >= 24 and len(self.bytes) >= -(-struct.unpack(">I", self.bytes[:4])[0] // 8) * 8:
                found, self.bytes = self._cut(self.bytes)
                if found:
                    yield (*found, False)
            ready = select.select(sockets, [], [], patience)[0]
            if not ready:
                raise TimeoutError("nothing comes")
            if self.datagrams in ready:
                rest = self.datagrams.recv(1473)
                if len(rest) > 1472:
                    raise ValueError("a datagram longer than a client's buffer")
                while rest:
                    found, rest = self._cut(rest)
                    if found:
                        yield (*found, True)
            if self.stream in ready:
                self._fill(len(self.bytes) + 1)

    def poses(self, patience=10.0):
        """Yields (tracker, sensor, time in us, position, quaternion x y z w, by datagram?)."""
        for tracker, kind, us, payload, datagram in self.messages(patience):
            if kind == "vrpn_Tracker Pos_Quat":
                sensor, _, *numbers = struct.unpack(">ii7d", payload)
                yield tracker, sensor, us, numbers[:3], numbers[3:], datagram

    def close(self):
        for s in (self.stream, self.datagrams):
            if s:
                s.close()


if __name__ == "__main__":
    name, tcp, host, port = re.fullmatch(r"(\w+)@(tcp://)?([\w.]+)(?::(\d+))?", sys.argv[1]).groups()
    for pose in VrpnClient([name], int(port or 3883), host, udp=not tcp).poses():
        print("{0} sensor {1} time {2} pos {3} quat {4}".format(*pose))
