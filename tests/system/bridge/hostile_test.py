"""Pushers that flood, stall, lie or send garbage affect nobody: neither readers of the sensor, nor other pushers, nor the sensor."""
import json
import os
import random
import socket
import threading
import time
import unittest

from bridge_rig import BridgeRig, frame_line, get, get_json, hello_line, send, wait_for

import chorus_push

NEVER_STOPS = 1 << 30
SLOW_READ_S = 8.0  # a read that waited for a hostile pusher would time out after 10; a busy machine takes a second


class Good(threading.Thread):
    """A well-behaved pusher at 30 Hz."""

    def __init__(self, sensor):
        super().__init__(daemon=True)
        self.told = []
        self.pusher = chorus_push.Pusher(sensor.ws, {"name": "good", "layout": "coco_17"}, tell=self.told.append)
        self.sent = 0
        self.stopped = threading.Event()
        self.start()

    def run(self):
        while not self.stopped.wait(1 / 30):
            self.sent += self.pusher.push([{"id": 1, "points": [[0, 0.8 - 0.1 * i, 2] for i in range(17)]}])

    def stop(self):
        self.stopped.set()
        self.join()
        self.pusher.close()


class Reader(threading.Thread):
    """Reads /frame again and again and records the longest time it took."""

    def __init__(self, sensor):
        super().__init__(daemon=True)
        self.url, self.worst, self.failed, self.stopped = sensor.url + "frame", 0.0, 0, threading.Event()
        self.start()

    def run(self):
        while not self.stopped.wait(0.02):
            begin = time.monotonic()
            try:
                self.failed += get(self.url)[0] != 200
            except OSError:
                self.failed += 1
            self.worst = max(self.worst, time.monotonic() - begin)

    def stop(self):
        self.stopped.set()
        self.join()


def raw_websocket(sensor):
    way = chorus_push.WebSocketWay(sensor.ws, None)
    way.socket.settimeout(10)
    return way


def heard_until_the_end(way):
    heard = []
    try:
        while (message := way.receive()) is not None:
            heard.append(json.loads(message))
    except OSError:
        pass
    return heard


def ended(way):
    """Whether the other side closes the connection before a time-out."""
    try:
        while way.receive() is not None:
            pass
    except TimeoutError:
        return False
    except OSError:
        pass
    return True


def local(sensor):
    way = chorus_push.LineWay(sensor.path)
    way.socket.settimeout(10)
    return way


class Hostile(BridgeRig):
    def with_good(self, hostility, **settings):
        """Runs an attack together with a good pusher and a reader, and checks that these are not affected."""
        sensor = self.bridge(**settings)
        good = Good(sensor)
        wait_for("the good one is live", lambda: self.push_state(sensor)["state"] == "live" and good.sent > 10)
        reader = Reader(sensor)
        hostility(sensor)
        reader.stop()
        good.stop()
        self.assertTrue(sensor.alive(), sensor.text()[-2000:])
        self.assertEqual(reader.failed, 0)
        self.assertLess(reader.worst, SLOW_READ_S)
        self.assertEqual(good.told, [])
        return sensor

    def test_garbage_of_strangers(self):
        noise = random.Random(7)

        def garbage(sensor):
            for size in (1, 17, 1000, 60_000):
                junk = noise.randbytes(size)
                send("POST", sensor.url + "push", junk)
                send("POST", sensor.url + "push", hello_line(name="junk").encode() + b"\n" + junk)
                for open_way in (raw_websocket, local):
                    way = open_way(sensor)
                    way.socket.sendall(junk)
                    way.socket.close()
                for message in ("{}", "[" * 5000, '{"type":"frame"}', '{"type":"hello","layout":[]}', "\u2603" * 1000):
                    way = raw_websocket(sensor)
                    way.send(message)
                    self.assertEqual(heard_until_the_end(way)[-1]["type"], "bye")
                    way.socket.close()

        self.with_good(garbage)

    def test_half_messages_and_early_ends(self):
        def halves(sensor):
            for _ in range(20):
                way = local(sensor)
                way.socket.sendall(hello_line().encode()[:random.randrange(1, 40)])
                way.socket.close()
                way = raw_websocket(sensor)
                way.socket.sendall(b"\x81\xfe")
                way.socket.close()
                plain = socket.create_connection(("127.0.0.1", sensor.port))
                plain.sendall(b"POST /push HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 1000\r\n\r\nhalf")
                plain.close()

        sensor = self.with_good(halves)
        wait_for("nothing of them is left", lambda: [raw_websocket(sensor) for _ in range(4)])

    def test_a_second_pusher_is_turned_away(self):
        def intrude(sensor):
            for open_way in (raw_websocket, local):
                way = open_way(sensor)
                way.send(hello_line(name="intruder"))
                last = heard_until_the_end(way)[-1]
                self.assertEqual(last["type"], "bye")
                self.assertIn('"good"', last["detail"])
            status, _, body = send("POST", sensor.url + "push", hello_line(name="intruder").encode())
            self.assertEqual(status, 409, body)

        self.with_good(intrude)

    def test_a_flood_is_cut_off_and_told(self):
        sensor = self.bridge()
        reader = Reader(sensor)
        for open_way in (raw_websocket, local):
            way = open_way(sensor)
            way.send(hello_line(name="flood"))
            try:
                for _ in range(20_000):
                    way.send(frame_line())
            except OSError:
                pass
            heard = []
            try:
                heard = heard_until_the_end(way)
            except ValueError:
                pass
            way.socket.close()
            if heard:
                self.assertIn("too much", heard[-1]["detail"])
            state = wait_for("it is gone", lambda: (s := self.push_state(sensor))["state"] == "waiting" and s)
            self.assertIn("too much", state["reason"])
            time.sleep(1.2)
        reader.stop()
        self.assertLess(reader.worst, SLOW_READ_S)
        self.assertTrue(sensor.alive())

    def test_a_flood_of_posts_is_told_and_does_no_harm(self):
        sensor = self.bridge()
        body = "\n".join([hello_line(name="flood"), *(frame_line() for _ in range(60))]).encode()
        statuses = [send("POST", sensor.url + "push", body)[0] for _ in range(40)]
        self.assertIn(503, statuses)
        self.assertEqual(get(sensor.url + "push")[0], 200)

    def test_connections_that_say_nothing(self):
        def silent(sensor):
            ways = [raw_websocket(sensor) for _ in range(16)]  # four times max_pushers may be silent
            newest = raw_websocket(sensor)  # the oldest of them makes room
            self.assertIn("makes room", heard_until_the_end(ways[0])[-1]["detail"])
            for way in [*ways[1:], newest]:
                self.assertIn("hello", heard_until_the_end(way)[-1]["detail"])

        self.with_good(silent)

    def test_a_stall_shows_with_its_reason(self):
        sensor = self.bridge()
        self.assertEqual(self.health(sensor), (503, "no program pushes frames"))
        pusher = chorus_push.Pusher(sensor.ws, {"name": "stalls", "layout": "coco_17"})
        wait_for("it is live", lambda: pusher.push([]) and time.sleep(0.03) is None and self.push_state(sensor)["state"] == "live")
        wait_for("its silence shows", lambda: self.health(sensor)[0] == 503)
        self.assertIn('"stalls" (WebSocket from 127.0.0.1) has pushed no frame for', self.health(sensor)[1])
        self.assertEqual(self.push_state(sensor)["state"], "silent")
        pusher.close()
        wait_for("that it left shows", lambda: '"stalls" (WebSocket from 127.0.0.1) left' in self.health(sensor)[1])

    def test_lies_about_the_time(self):
        sensor = self.bridge()
        now = time.time_ns()
        for off, says in ((60, "in the future"), (-60, "ago"), (86400 * 365, "in the future")):
            status, _, body = send("POST", sensor.url + "push", "\n".join([hello_line(), frame_line(now + int(off * 1e9))]).encode())
            self.assertEqual(status, 400)
            self.assertIn(says, json.loads(body)["detail"])
            self.assertEqual(json.loads(body)["context"], "captured")
        self.assertIn("captured", self.health(sensor)[1])
        self.assertEqual(get(sensor.url + "frame")[0], 503, "none of them is shown")
        liar = raw_websocket(sensor)
        wait_for("the sensor is free", lambda: time.sleep(0.5) is None and self.push_state(sensor)["state"] == "silent")
        time.sleep(2)
        liar.send(hello_line(name="liar"))
        for _ in range(30):  # answers each time request with another day
            message = json.loads(liar.receive())
            self.assertNotEqual(message["type"], "bye")
            if message["type"] == "clock":
                stamp = str(now + random.randrange(-10**17, 10**17))
                liar.send(json.dumps({"type": "clock", "sent": message["sent"], "received": stamp, "answered": stamp}))
                liar.send(frame_line())
                if message.get("sent") and random.random() < 0.2:
                    break
        liar.close()
        self.assertTrue(sensor.alive())

    def test_lines_and_messages_that_never_end(self):
        def endless(sensor):
            for open_way in (raw_websocket, local):
                way = open_way(sensor)
                try:
                    if open_way is raw_websocket:
                        way.socket.sendall(b"\x81\xff" + NEVER_STOPS.to_bytes(8, "big") + b"\0\0\0\0")
                    for _ in range(200):
                        way.socket.sendall(b"x" * 10_000)
                except OSError:
                    pass
                self.assertTrue(ended(way), "two megabytes of one message were taken")
                way.socket.close()

        self.with_good(endless)

    def test_who_may_push(self):
        sensor = self.bridge(**{"http.bearer_token": "the-right-token"})
        body = "\n".join([hello_line(), frame_line()]).encode()
        self.assertEqual(send("POST", sensor.url + "push", body)[0], 401)
        self.assertEqual(send("POST", sensor.url + "push", body, {"Authorization": "Bearer wrong"})[0], 401)
        with self.assertRaises(chorus_push.Refused):
            raw_websocket(sensor)
        self.assertEqual(self.push_state(sensor)["state"], "waiting")
        body = "\n".join([hello_line(), frame_line()]).encode()
        self.assertEqual(send("POST", sensor.url + "push", body, {"Authorization": "Bearer the-right-token"})[0], 200)
        foreign = {"Authorization": "Bearer the-right-token", "Host": "evil.example"}
        self.assertEqual(send("POST", sensor.url + "push", body, foreign)[0], 421)
        self.assertEqual(os.stat(sensor.path).st_mode & 0o777, 0o660)

    def test_what_is_in_the_way_of_the_socket(self):
        first = self.bridge("s1")
        second = self.bridge("s2", **{"device.bridge.socket": first.path})
        wait_for("the second says so", lambda: "another program listens there" in self.health(second)[1])
        self.assertIn(b"sensor", get(first.url)[2])
        first.kill()
        third = self.bridge("s3", **{"device.bridge.socket": first.path})
        wait_for("what a dead one left is replaced", lambda: third.alive() and chorus_push.LineWay(first.path).close() is None)
        plain = os.path.join(self.folder.name, "plain")
        with open(plain, "w", encoding="utf-8") as file:
            file.write("mine")
        fourth = self.bridge("s4", **{"device.bridge.socket": plain})
        wait_for("a file is left alone", lambda: "no socket" in self.health(fourth)[1])
        self.assertEqual(open(plain, encoding="utf-8").read(), "mine")


class Post(BridgeRig):
    def test_says_what_became_of_each_frame(self):
        sensor = self.bridge()
        now = time.time_ns()
        lines = [hello_line(), frame_line(now), frame_line(now), frame_line(now + 10**7), '{"type":"frame"}']
        status, headers, body = send("POST", sensor.url + "push", "\r\n\n".join(lines).encode())
        answer = json.loads(body)
        self.assertEqual((status, answer["taken"], answer["refused"]), (200, 2, 2), body)
        self.assertIn("later", answer["reason"])
        self.assertEqual(len(headers["Chorus-Clock"].split()), 2)
        last = str(now + 10**7)
        wait_for("the last one is shown", lambda: get_json(sensor.url + "frame")["capturedNanoseconds"] == last)

    def test_begins_with_a_hello(self):
        sensor = self.bridge()
        for body, expected in ((b"\n\n", 400), (b"x", 400), (frame_line().encode(), 409)):
            status, _, answer = send("POST", sensor.url + "push", body)
            self.assertEqual(status, expected, answer)


if __name__ == "__main__":
    unittest.main(warnings="ignore")  # impolite clients leave sockets open
