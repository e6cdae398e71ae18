"""Pushes frames of any tracker to a chorus-sensor whose device is `bridge`: Python's standard library and nothing else.

    from chorus_push import Pusher

    pusher = Pusher("ws://127.0.0.1:8081/push", {"name": "my camera", "layout": "coco_17", "axes": "right down ahead"})
    while True:
        captured, people = my_camera.next()                    # chorus_push.now_ns() of the exposure; landmarks in metres
        pusher.push([{"id": p.id, "points": p.landmarks} for p in people], captured)

ws://HOST:PORT/push is a WebSocket, http://HOST:PORT/push one POST a frame, anything else the path of a local socket.  wss:// and https://
are for a sensor with TLS: `ca` (or CHORUS_CA) names the ca.crt of its authority, where the system does not know that.  The
clock of this program need not be right: questions for the time are answered here.  When the sensor is not there, frames are
dropped and the connection is tried again once a second.  Landmarks with a NaN are sent as not seen; numbers of numpy will do.  What the
messages mean: proto/bridge.md.
"""
import base64
import contextlib
import http.client
import io
import json
import math
import os
import select
import socket
import ssl
import struct
import sys
import threading
import time
import urllib.parse

TIMEOUT_S = 5
RETRY_S = 1
_FIRST = time.time_ns() - time.perf_counter_ns()


def now_ns():
    """Nanoseconds since 1970 by this computer's clock.  On Windows, whose clock ticks every 16 ms, a finer counter goes on from it."""
    return _FIRST + time.perf_counter_ns() if sys.platform == "win32" else time.time_ns()


class Refused(ConnectionError):
    """The sensor closed the connection and said why."""


def complain(text):
    print("chorus_push:", text, file=sys.stderr, flush=True)


_LOST = object()


def seen(value):
    """The value as JSON knows it: numpy's numbers become plain ones, and a landmark with a NaN in it becomes None, which says not seen."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, float) and not math.isfinite(value):
        return _LOST
    if isinstance(value, dict):
        values = {key: seen(one) for key, one in value.items()}
        if values.get("at", 0) in (None, _LOST):
            return None
        return {key: None if one is _LOST else one for key, one in values.items()
                if one is not _LOST or key not in ("confidence", "covariance", "sigma")}
    if isinstance(value, (list, tuple)):
        values = [seen(one) for one in value]
        if _LOST in values and all(one is _LOST or isinstance(one, (int, float)) for one in values):
            return _LOST
        return [None if one is _LOST else one for one in values]
    return value


def _json(frame):
    try:
        return json.dumps(frame, separators=(",", ":"), allow_nan=False)
    except (TypeError, ValueError):
        return json.dumps(seen(frame), separators=(",", ":"), allow_nan=False)


def _path(parts):
    return parts.path.rstrip("/") or "/push"


def _reason(body, path):
    """Why the sensor refuses, from its problem document; what is no such document comes from elsewhere."""
    try:
        problem = json.loads(body)
        return ": ".join(part for part in (problem.get("context"), problem["detail"]) if part)
    except (ValueError, KeyError, TypeError, AttributeError):
        return "" if path.endswith("/push") else "the address of a sensor's bridge ends in /push"


def _advice(problem):
    """What to change, where the words of the system do not say it."""
    if isinstance(problem, socket.timeout):
        return "; the address of a sensor's bridge ends in /push"
    if isinstance(problem, ssl.SSLCertVerificationError) and "issuer" in str(problem):
        return "; name the ca.crt of the sensor's authority: Pusher(..., ca=\"ca.crt\") or CHORUS_CA"
    if isinstance(problem, ssl.SSLError) and "WRONG_VERSION_NUMBER" in str(problem):
        return "; this port does not speak TLS: write ws:// or http://, or give the sensor a certificate"
    return ""


def _trusting(ca):
    return ssl.create_default_context(cafile=ca or os.environ.get("CHORUS_CA") or None)


class SealedStream(io.RawIOBase):
    """A TLS socket that one thread reads while another writes, which Python's own does not allow."""

    def __init__(self, sealed):
        super().__init__()
        self.socket = sealed
        self.socket.setblocking(False)
        self.lock = threading.Lock()

    def readable(self):
        return True

    def readinto(self, room):
        while True:
            try:
                with self.lock:
                    return self.socket.recv_into(room)
            except (ssl.SSLWantReadError, ssl.SSLWantWriteError):
                select.select([self.socket], [], [])

    def sendall(self, data):
        left = memoryview(data)
        while left:
            try:
                with self.lock:
                    left = left[self.socket.send(left):]
            except (ssl.SSLWantReadError, ssl.SSLWantWriteError):
                select.select([], [self.socket], [], TIMEOUT_S)

    def settimeout(self, seconds):
        pass

    def close(self):
        super().close()
        try:
            self.socket.shutdown(socket.SHUT_RDWR)  # ends a select of the other thread
        except OSError:
            pass
        self.socket.close()


class LineWay:
    """Messages as lines, over a local socket."""

    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.settimeout(TIMEOUT_S)
        self.socket.connect(path)
        self.socket.settimeout(None)
        self.lines = self.socket.makefile("rb")
        self.lock = threading.Lock()

    def send(self, text):
        with self.lock:
            self.socket.sendall(text.encode() + b"\n")

    def receive(self):
        """The next message; None at the end."""
        line = self.lines.readline()
        return line.decode() if line else None

    def close(self):
        self.socket.close()


class WebSocketWay:
    """Messages as text frames of RFC 6455, as far as a client of our own sensor needs it."""

    TEXT, CLOSE, PING, PONG = 1, 8, 9, 10

    def __init__(self, url, token, ca=None):
        parts = urllib.parse.urlsplit(url)
        secure = parts.scheme == "wss"
        self.socket = socket.create_connection((parts.hostname, parts.port or (443 if secure else 80)), TIMEOUT_S)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if secure:
            self.socket = SealedStream(_trusting(ca).wrap_socket(self.socket, server_hostname=parts.hostname))
            self.stream = io.BufferedReader(self.socket)
        else:
            self.stream = self.socket.makefile("rb")
        self.lock = threading.Lock()
        key = base64.b64encode(os.urandom(16)).decode()
        fields = [f"GET {_path(parts)} HTTP/1.1", f"Host: {parts.netloc}", "Connection: Upgrade", "Upgrade: websocket",
                  "Sec-WebSocket-Version: 13", f"Sec-WebSocket-Key: {key}"]
        if token:
            fields.append(f"Authorization: Bearer {token}")
        self.socket.sendall(("\r\n".join(fields) + "\r\n\r\n").encode())
        status = self.stream.readline().decode()
        length = 0
        while (line := self.stream.readline().strip()):
            name, _, value = line.partition(b":")
            if name.lower() == b"content-length":
                length = int(value)
        if " 101 " not in status:
            why = _reason(self.stream.read(length).decode(errors="replace"), _path(parts))
            self.socket.close()
            raise Refused(f"{status.strip()}: {why}")
        self.socket.settimeout(None)

    def send(self, text):
        self._send(self.TEXT, text.encode())

    def _send(self, opcode, payload):
        size = len(payload)
        head = bytes([0x80 | opcode])
        if size < 126:
            head += bytes([0x80 | size])
        elif size < 65536:
            head += bytes([0x80 | 126]) + struct.pack(">H", size)
        else:
            head += bytes([0x80 | 127]) + struct.pack(">Q", size)
        mask = os.urandom(4)
        key = int.from_bytes((mask * (size // 4 + 1))[:size], "big")
        masked = (int.from_bytes(payload, "big") ^ key).to_bytes(size, "big")
        with self.lock:
            self.socket.sendall(head + mask + masked)

    def receive(self):
        """The next message; None at the end."""
        text = b""
        while True:
            head = self.stream.read(2)
            if len(head) < 2:
                return None
            size = head[1] & 0x7F
            if size == 126:
                size, = struct.unpack(">H", self.stream.read(2))
            elif size == 127:
                size, = struct.unpack(">Q", self.stream.read(8))
            payload = self.stream.read(size)
            opcode = head[0] & 0x0F
            if opcode == self.CLOSE:
                return None
            if opcode == self.PING:
                self._send(self.PONG, payload)
            elif opcode != self.PONG:
                text += payload
                if head[0] & 0x80:
                    return text.decode()

    def close(self):
        try:
            self._send(self.CLOSE, struct.pack(">H", 1000))
        except OSError:
            pass
        self.socket.close()


class Talk:
    """A connection that is open both ways; a thread of its own answers the sensor's questions for the time."""

    def __init__(self, way, hello, clock, tell):
        self.way, self.clock, self.tell = way, clock, tell
        self.over = None
        way.send(hello)
        way.socket.settimeout(TIMEOUT_S)
        first = way.receive()
        way.socket.settimeout(None)
        answer = json.loads(first) if first else {"type": "bye", "detail": "the connection was closed"}
        if answer.get("type") != "welcome":
            way.close()
            raise Refused(": ".join(filter(None, (answer.get("context"), answer.get("detail", "the address of a sensor's bridge ends in /push")))))
        self.welcome = answer
        self.last = "the sensor has gone"
        self.listener = threading.Thread(target=self._listen, daemon=True)
        self.listener.start()

    def _listen(self):
        try:
            while (text := self.way.receive()) is not None:
                received = self.clock()
                message = json.loads(text)
                if message["type"] == "clock":
                    with contextlib.suppress(OSError):  # a bye may still come
                        self.way.send(json.dumps({"type": "clock", "sent": message["sent"], "received": str(received),
                                                  "answered": str(self.clock())}))
                elif message["type"] in ("error", "bye", "doubt"):
                    self.tell(f"{message['type']}: {message['context']}: {message['detail']}")
                    if message["type"] == "bye":
                        self.last = message["detail"]
        except (OSError, ValueError):
            pass
        self.over = True

    def push(self, frame):
        if self.over:
            raise ConnectionError(self.last)
        try:
            self.way.send(frame)
        except OSError:
            self.listener.join(RETRY_S)  # its bye says more than the broken connection
            raise

    def close(self):
        self.way.close()


class Post:
    """Sends each frame by a POST; it also carries the times of the previous answer, so that the sensor learns our clock."""

    def __init__(self, url, token, ca, hello, clock, tell):
        parts = urllib.parse.urlsplit(url)
        self.path = _path(parts)
        if parts.scheme == "https":
            self.connection = http.client.HTTPSConnection(parts.hostname, parts.port or 443, timeout=TIMEOUT_S, context=_trusting(ca))
        else:
            self.connection = http.client.HTTPConnection(parts.hostname, parts.port or 80, timeout=TIMEOUT_S)
        self.connection.connect()
        self.connection.sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.headers = {"Content-Type": "application/x-ndjson", **({"Authorization": f"Bearer {token}"} if token else {})}
        self.hello, self.clock, self.tell = hello, clock, tell
        self.asked = None
        for _ in range(3):  # so that the clock is known before the first frame
            self._post([])

    def _post(self, lines):
        lines = [self.hello, *lines]
        if self.asked:
            sent, received = self.asked
            lines.insert(1, json.dumps({"type": "clock", "sent": sent, "received": str(received), "answered": str(self.clock())}))
        self.connection.request("POST", self.path, "\n".join(lines) + "\n", self.headers)
        answer = self.connection.getresponse()
        received = self.clock()
        body = answer.read()
        stamps = answer.headers.get("Chorus-Clock", "").split()
        self.asked = (stamps[1], received) if len(stamps) == 2 else None
        text = body.decode(errors="replace")
        if answer.status in (401, 403, 404, 405, 409, 429, 503):
            raise Refused(f"{answer.status}: {_reason(text, self.path)}")
        if answer.status != 200:
            self.tell(f"{answer.status}: {_reason(text, self.path)}")
        elif (doubt := json.loads(text).get("doubt")):
            self.tell(f"doubt: {doubt}")

    def push(self, frame):
        self._post([frame])

    def close(self):
        self.connection.close()


class Pusher:
    """`hello` lacks its type; `clock` returns nanoseconds since 1970, and `captured` is by this clock."""

    def __init__(self, url, hello, token=None, clock=now_ns, tell=complain, ca=None):
        self.url, self.token, self.clock, self.tell, self.ca = url, token, clock, tell, ca
        self.hello = json.dumps({"type": "hello", "version": 1, **hello})
        self.sequence = 0
        self.dropped = 0
        self._talk = None
        self._tried = -RETRY_S

    def push(self, bodies, captured=None, **more):
        """Sends one frame; `bodies` is [] when nobody is seen.  Returns False when it could not be sent."""
        self.sequence += 1
        captured = self.clock() if captured is None else captured
        try:
            frame = _json({"type": "frame", "sequence": self.sequence, "captured": str(int(captured)), "bodies": bodies, **more})
        except (TypeError, ValueError) as problem:
            self.tell(f"frame {self.sequence} cannot be sent: {problem}")
            self.dropped += 1
            return False
        try:
            if not self._connected():
                self.dropped += 1
                return False
            self._talk.push(frame)
            return True
        except (OSError, http.client.HTTPException) as problem:
            self.tell(f"{self.url}: {problem}{_advice(problem)}")
            self.dropped += 1
            self.close()
            return False

    def _connected(self):
        if self._talk is not None:
            return True
        if time.monotonic() - self._tried < RETRY_S:
            return False
        self._tried = time.monotonic()
        self._talk = self._connect()
        return True

    def _connect(self):
        if self.url.startswith(("http://", "https://")):
            return Post(self.url, self.token, self.ca, self.hello, self.clock, self.tell)
        way = WebSocketWay(self.url, self.token, self.ca) if self.url.startswith(("ws://", "wss://")) else LineWay(self.url)
        return Talk(way, self.hello, self.clock, self.tell)

    def close(self):
        if self._talk is not None:
            self._talk.close()
            self._talk = None
