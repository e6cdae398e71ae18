"""A client of Chorus in one file, with nothing but Python's standard library (3.9 or later).

    import chorus
    tracker = chorus.Tracker("http://127.0.0.1:8080/")      # token="..." where the tracker wants one
    for frame in tracker.frames(max_rate=30):
        if frame is None:                                    # nothing has come for a second
            print("stale")
            continue
        for person in frame.people:
            print(person.slot, person.id, person.joints["Head"])

Positions are in metres, in the tracker's world: y is up, right-handed.  As a program:
python3 chorus.py [URL] frames|people|events|state; CHORUS_URL and CHORUS_TOKEN are read, as by `chorus`.
"""
import argparse
import json
import os
import socket
import ssl
import sys
import time
import urllib.error
import urllib.parse
import urllib.request
from collections import namedtuple

Joint = namedtuple("Joint", "x y z state")
Joint.__doc__ = 'Metres; `state` is "Tracked" (seen), "Inferred" (reckoned) or "NotTracked" (then x, y and z are None).'


class Refused(Exception):
    """The tracker answered with an error; `status` is that of HTTP, the text says what to change."""

    def __init__(self, status, text):
        super().__init__(f"{status}: {text}")
        self.status = status


class Person:
    """Somebody at one instant: id, slot (None: no slot), sides (probability that left and right are right, or None),
    unseen_for (seconds for which nobody has seen them, or None), joints by name, and `raw`, the JSON."""

    def __init__(self, body):
        self.raw = body
        self.id = int(body["bodyId"])
        self.slot = body.get("slot")
        self.sides = body.get("sidesConfidence")
        self.unseen_for = body.get("carriedFor")
        self.joints = {name: Joint(joint.get("x"), joint.get("y"), joint.get("z"), joint["state"]) for name, joint in body["joints"].items()}


class Frame:
    """All people at one instant: sequence, time (seconds since 1970, by the tracker's clock), nanoseconds (exact), people."""

    def __init__(self, document):
        self.raw = document
        self.sequence = int(document["sequence"])
        self.nanoseconds = int(document["capturedNanoseconds"])
        self.time = self.nanoseconds / 1e9
        self.people = [Person(body) for body in document["bodies"]]

    def by_slot(self, slot):
        return next((person for person in self.people if person.slot == slot), None)

    def by_id(self, number):
        return next((person for person in self.people if person.id == number), None)


class Tracker:
    """A fusion server, or a sensor; what only a fusion server has raises Refused (404) at a sensor."""

    def __init__(self, url=None, token=None, timeout=10.0):
        self.url = (url or os.environ.get("CHORUS_URL") or "http://127.0.0.1:8080/").rstrip("/") + "/"
        self.token = token or os.environ.get("CHORUS_TOKEN")
        self.timeout = timeout

    # ---- frames --------------------------------------------------------------------------------------------------

    def frame(self):
        """The latest frame, with everything that is known (Person.raw)."""
        return Frame(self._json("GET", "frame"))

    def at(self, instant, form="pose"):
        """The frame of an instant: seconds since 1970, or "now" (predicted by at most 250 ms).  form=None: the full frame."""
        if instant != "now":
            instant = str(round(instant * 1e9))
        query = {"at": instant, **({"form": form} if form else {})}
        return Frame(self._json("GET", "frame?" + urllib.parse.urlencode(query)))

    def frames(self, max_rate=None, form="pose", stale=1.0):
        """Frames as they come, for ever.  Yields None when none has come for `stale` seconds, and after each further such
        time; connects again by itself.  Who reads slowly misses frames and gets the newest one.  Raises Refused when the
        tracker does not want to be read."""
        query = {**({"max_rate": max_rate} if max_rate else {}), **({"form": form} if form else {})}
        for data in self._stream("frame?" + urllib.parse.urlencode(query), stale):
            yield None if data is None else Frame(json.loads(data))

    # ---- people and events ---------------------------------------------------------------------------------------

    def people(self):
        """Who is, or lately was, there: {id: {"name", "state", "slot", "sensors", "stature", ...}}."""
        return {int(number): person for number, person in self._json("GET", "people/")["people"].items()}

    def name(self, number, name):
        """Gives a person a name; None takes it away."""
        return self._json("PATCH", f"people/{number}", {"name": name})

    def forget(self, number):
        """Forgets a person; if they are still there, they are somebody new."""
        self._json("POST", f"people/{number}/forget")

    def events(self, after=0):
        """What happened in the last day, oldest first; only what came after the event with this eventId."""
        return self._json("GET", f"events?after={after}")["events"]

    def follow_events(self, after=None):
        """Events as they happen, for ever, each once, even across restarts of the tracker; those kept from before come first."""
        for data in self._stream("events", 60.0, after):
            if data is not None:
                yield json.loads(data)

    # ---- registration and recording ------------------------------------------------------------------------------

    def registration(self):
        return self._json("GET", "registration")

    def register(self, seconds=30, progress=None):
        """Starts a registration, waits until it is over, and returns it: "verdict", "adopted", "reasons".  Somebody has to
        walk through the room meanwhile; `progress` is called with the session about twice a second."""
        place = self._location("registration", {"seconds": seconds})
        while True:
            session = self._json("GET", place)
            if progress:
                progress(session)
            if session["state"] in ("done", "cancelled"):
                return session
            time.sleep(0.5)

    def record(self, seconds=None, name=None):
        """Starts a recording and returns its name; without `seconds` it goes on until stop()."""
        wish = {**({"name": name} if name else {}), **({"seconds": seconds} if seconds else {})}
        return self._location("recordings/", wish).rstrip("/").rsplit("/", 1)[-1]

    def stop(self, name):
        """Ends a recording, waits until its file is complete, and returns its description."""
        try:
            self._json("DELETE", f"recordings/{name}")
        except Refused as refusal:
            if refusal.status != 409:  # It has ended by itself.
                raise
        return self.recorded(name)

    def recorded(self, name):
        """Waits until a recording has ended and returns its description."""
        while True:
            recording = self._json("GET", f"recordings/{name}")
            if recording["state"] not in ("recording", "stopping"):
                return recording
            time.sleep(0.1)

    def download(self, name, path):
        """Stores a recording of one file at `path` (MCAP)."""
        with self._open("GET", f"recordings/{name}.mcap", accept="*/*") as answer, open(path, "wb") as file:
            while piece := answer.read(1 << 20):
                file.write(piece)

    # ---- how ---------------------------------------------------------------------------------------------------------

    def _headers(self, more=None):
        return {"Accept": "application/json", **({"Authorization": f"Bearer {self.token}"} if self.token else {}), **(more or {})}

    def _open(self, method, path, body=None, accept="application/json"):
        data = None if body is None else json.dumps(body).encode()
        if data is None and method == "POST":
            data = b""
        headers = self._headers({"Accept": accept, **({"Content-Type": "application/json"} if body is not None else {})})
        request = urllib.request.Request(urllib.parse.urljoin(self.url, path.lstrip("/")), data=data, headers=headers, method=method)
        try:
            return urllib.request.urlopen(request, timeout=self.timeout)
        except urllib.error.HTTPError as refusal:
            raise Refused(refusal.code, _detail(refusal.read())) from None

    def _json(self, method, path, body=None):
        with self._open(method, path, body) as answer:
            text = answer.read()
            return json.loads(text) if text else None

    def _location(self, path, body):
        with self._open("POST", path, body) as answer:
            return answer.headers["Location"].lstrip("/")

    def _stream(self, path, patience, last=None):
        """The data of server-sent events; None after each `patience` seconds without one.  Connects again when the tracker
        goes away or says nothing at all for longer than its heartbeat."""
        while True:
            try:
                with _EventStream(urllib.parse.urljoin(self.url, path), self._headers(), last, min(patience, 5.0)) as stream:
                    waited = time.monotonic()
                    for event in stream.events():
                        if event is not None:
                            last = event.get("id", last)
                            waited = time.monotonic()
                            yield event["data"]
                        elif time.monotonic() - waited >= patience:
                            waited = time.monotonic()
                            yield None
            except OSError:  # It is gone; Refused is none of these.
                time.sleep(min(patience, 1.0))
                yield None


class _EventStream:
    """One connection that reads text/event-stream and notices when nothing comes."""

    HEARTBEAT = 15.0  # [s]; the tracker sends something at least this often.

    def __init__(self, url, headers, last, patience):
        parts = urllib.parse.urlsplit(url)
        secure = parts.scheme == "https"
        self.socket = socket.create_connection((parts.hostname, parts.port or (443 if secure else 80)), timeout=10.0)
        try:
            if secure:
                self.socket = ssl.create_default_context().wrap_socket(self.socket, server_hostname=parts.hostname)
            self.received = b""
            fields = {"Host": parts.netloc.rsplit("@")[-1], **headers, "Accept": "text/event-stream", **({"Last-Event-ID": str(last)} if last else {})}
            target = (parts.path or "/") + ("?" + parts.query if parts.query else "")
            self.socket.sendall("".join([f"GET {target} HTTP/1.1\r\n", *(f"{k}: {v}\r\n" for k, v in fields.items()), "\r\n"]).encode())
            self._read_head()
            self.socket.settimeout(patience)
        except BaseException:
            self.socket.close()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def _read_head(self):
        while b"\r\n\r\n" not in self.received:
            self.received += self._more()
        head, self.received = self.received.split(b"\r\n\r\n", 1)
        status = int(head.split(b" ", 2)[1])
        if status == 503:
            raise ConnectionError("the tracker is not ready yet")
        if status != 200:
            try:
                while len(self.received) < 1 << 16:
                    self.received += self._more()
            except OSError:
                pass
            raise Refused(status, _detail(self.received))

    def _more(self):
        piece = self.socket.recv(1 << 16)
        if not piece:
            raise ConnectionError("the tracker has hung up")
        return piece

    def events(self):
        """Dictionaries of the fields; None whenever nothing has come for the socket's timeout."""
        heard = time.monotonic()
        while True:
            while b"\n\n" in self.received:
                block, self.received = self.received.split(b"\n\n", 1)
                fields = dict(line.partition(": ")[::2] for line in block.decode().split("\n") if not line.startswith(":"))
                if "data" in fields:
                    yield fields
            try:
                self.received += self._more()
                heard = time.monotonic()
            except TimeoutError:
                if time.monotonic() - heard > 2 * self.HEARTBEAT:
                    raise ConnectionError("the tracker says nothing") from None
            yield None  # The caller looks at the clock.


def _detail(body):
    try:
        return json.loads(body)["detail"]
    except (ValueError, KeyError, TypeError):
        return body[:200].decode(errors="replace")


def main(words=None):
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("url", nargs="?", default=None)
    options.add_argument("what", choices=["frames", "people", "events", "state"])
    options.add_argument("--rate", type=float, default=5.0, help="frames a second, at most")
    options.add_argument("--count", type=int, default=0, help="end after so many frames; 0: never")
    given = options.parse_args(words)
    tracker = Tracker(given.url)
    if given.what == "people":
        for number, person in tracker.people().items():
            print(number, person.get("name", "-"), person["state"], "slot", person.get("slot", "-"), "seen by", ", ".join(person["sensors"]) or "nobody")
    elif given.what == "events":
        for event in tracker.events():
            print(event["time"], event["severity"], event["message"], event.get("advice", ""))
    elif given.what == "state":
        print(tracker.registration()["verdict"])
    else:
        for count, frame in enumerate(tracker.frames(max_rate=given.rate), 1):
            heads = [] if frame is None else [f"{person.id}: {person.joints['Head'].y or 0:.2f} m" for person in frame.people]
            print("stale" if frame is None else f"{frame.sequence} {'; '.join(heads) or 'nobody'}", flush=True)
            if count == given.count:
                break


if __name__ == "__main__":
    try:
        main()
    except (Refused, OSError) as failure:
        sys.exit(f"chorus.py: {failure}")
    except KeyboardInterrupt:
        sys.exit(130)
