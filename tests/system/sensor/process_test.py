"""chorus-sensor as a process: start, wrong options, signals, synchronised replays."""

import json
import os
import signal
import socket
import subprocess
import threading
import time
import unittest

from sensor_process import SENSOR, Sensor, make_recording, temporary_folder


def refused(*options):
    """Runs chorus-sensor with options that it must refuse; returns exit code and output."""
    done = subprocess.run([SENSOR, *options], capture_output=True, text=True, timeout=60)
    return done.returncode, done.stderr.strip()


def but_for_the_clock(text):
    """The lines that do not depend on whether this host's clock is synchronised."""
    return [line for line in text.splitlines() if "clock" not in line]


class Process(unittest.TestCase):
    def setUp(self):
        self.folder = temporary_folder()
        self.addCleanup(self.folder.cleanup)

    def start(self, *options):
        sensor = Sensor(*options)
        self.addCleanup(sensor.stop)
        return sensor

    def test_all_mistakes_are_named_at_once(self):
        code, text = refused("--set", "http.prt=1", "--set", "images=7", "--set", "device.kind=usb", "--set",
                             "device.replay.speed=0")
        self.assertEqual(code, 2)
        for key in ("http.prt", "images", "device.kind", "device.replay.speed", "did you mean 'port'"):
            self.assertIn(key, text)

    def test_a_broken_recording_is_named(self):
        path = os.path.join(self.folder.name, "not.mcap")
        with open(path, "w", encoding="utf-8") as file:
            file.write("this is not a recording")
        code, text = refused("--recording", path)
        self.assertEqual(code, 2)
        self.assertIn("not.mcap", text)
        self.assertIn("not an MCAP file", text)

    def test_port_in_use_is_one_clear_line(self):
        with socket.create_server(("127.0.0.1", 0)) as other:
            port = other.getsockname()[1]
            code, text = refused("--port", str(port))
        self.assertEqual(code, 2)
        self.assertEqual(len(but_for_the_clock(text)), 1, text)
        self.assertIn(str(port), text)
        self.assertIn("in use", text)

    def test_signals_stop_it_soon_even_while_clients_wait(self):
        recording = make_recording(self.folder.name, frames=5)
        for number in (signal.SIGTERM, signal.SIGINT):
            sensor = self.start("--recording", recording, "--set", "device.replay.loop=false")
            sensor.wait_for("/healthz", 503, containing="has come to its end")
            etag = sensor.get("/frame").headers["ETag"]
            statuses = []

            def poll(sensor=sensor, etag=etag, statuses=statuses):
                headers = {"If-None-Match": etag, "Prefer": "wait=20"}
                statuses.append(sensor.get("/frame", headers=headers).status)

            waiting = threading.Thread(target=poll)
            waiting.start()
            sensor.wait_for("/metrics", 200, containing="chorus_http_longpoll_waiters 1\n")
            sensor.signal(number)
            code, took_s = sensor.stop()
            waiting.join()
            self.assertEqual(code, 0)
            self.assertLess(took_s, 15.0, "the client would have waited 20 s")
            self.assertEqual(statuses, [503])

    def test_reload_applies_what_it_can_and_refuses_a_wrong_file(self):
        recording = make_recording(self.folder.name)
        path = os.path.join(self.folder.name, "sensor.json")

        def configure(**changes):
            config = {"id": "s1", "images": False,
                      "device": {"kind": "replay", "replay": {"recording": recording}}, **changes}
            with open(path, "w", encoding="utf-8") as file:
                file.write("// with a comment\n" + json.dumps(config))

        configure()
        sensor = self.start("--config", path)
        sensor.wait_for("/frame", 200)
        self.assertIn("images: true", sensor.get("/images/depth").json["detail"])
        configure(images="yes")
        sensor.signal(signal.SIGHUP)
        self.assertIn("images", str(sensor.wait_for_event("configuration not reloaded, the old one stays")))
        self.assertEqual(sensor.get("/frame").status, 200)
        configure(images=True, id="other", http={"bearer_token": "secret-of-many"})
        sensor.signal(signal.SIGHUP)
        self.assertEqual(sensor.wait_for_event("changes wait for a restart")["keys"], "id")
        sensor.wait_for_event("configuration reloaded")
        self.assertIn("no such images", sensor.wait_for("/images/depth", 404).json["detail"])
        self.assertEqual(sensor.get("/frame").json["source"], "s1")

    def test_replays_with_one_epoch_stay_in_step(self):
        first = make_recording(self.folder.name, "first", frames=100)
        second = make_recording(self.folder.name, "second", frames=50, first_ms=1000)  # began one second later
        epoch = str(time.time_ns())
        sensors = [self.start("--recording", path, "--set", f"device.replay.epoch_ns={epoch}")
                   for path in (first, second)]
        times = []
        for sensor in sensors:
            answer = sensor.wait_for("/frame", 200)
            seen = set()
            while len(seen) < 20:
                headers = {"If-None-Match": answer.headers["ETag"], "Prefer": "wait=10"}
                answer = sensor.get("/frame", headers=headers)
                seen.add(int(answer.json["capturedNanoseconds"]))
            times.append(seen)
        step, period = 40_000_000, 4_000_000_000
        start = int(float(epoch))  # the precision that a JSON number keeps
        for seen in times:
            for captured in seen:
                # 256 ns, because of the two conversions to double
                off = (captured - start) % step
                self.assertLess(min(off, step - off), 600)
        for captured in times[1]:
            self.assertTrue(0.999e9 <= (captured - start) % period <= 3.001e9, "its place in the round is kept")

    def test_images_of_the_simulated_device(self):
        sensor = self.start("--set", "images=true")
        for path, media_type, magic in (("/images/depth", "image/png", b"\x89PNG"), ("/images/color", "image/jpeg", b"\xff\xd8")):
            sensor.wait_for(path, 200)
            answer = sensor.get(path, accept="image/*")
            self.assertEqual((answer.status, answer.type), (200, media_type))
            self.assertTrue(answer.bytes.startswith(magic))
            self.assertIn('</images/>; rel="describedby"', ", ".join(answer.headers.get_all("Link")))
        depth = sensor.get("/images/").json["depthImage"]
        self.assertEqual((depth["width"], depth["height"]), (512, 424))

    def test_a_simulated_clock_error_shows_everywhere(self):
        sensor = self.start("--recording", make_recording(self.folder.name), "--set", "clock.offset_ms=60000")
        answer = sensor.wait_for("/frame", 200)
        ahead = int(answer.json["capturedNanoseconds"]) / 1e9 - time.time()
        self.assertAlmostEqual(ahead, 60, delta=10)
        self.assertAlmostEqual(int(answer.headers["Chorus-Clock"].split()[1]) / 1e9 - time.time(), 60, delta=10)
        self.assertAlmostEqual(int(sensor.get("/clock").json["nowNanoseconds"]) / 1e9 - time.time(), 60, delta=10)

    def test_the_commented_configuration_is_good_and_says_the_defaults(self):
        done = subprocess.run([SENSOR, "--config", "deploy/config/sensor.json", "--check"], capture_output=True,
                              text=True, timeout=60)
        self.assertEqual((done.returncode, but_for_the_clock(done.stderr)), (0, []), done.stderr)


if __name__ == "__main__":
    unittest.main()
