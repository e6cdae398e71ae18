"""A tracker reads its sensors over TLS; an expired, a foreign and a renewed certificate, and a file damaged while everything runs."""

import json
import os
import pathlib
import shutil
import signal
import socket
import ssl
import subprocess
import sys
import time
import unittest
import urllib.request

from rig import BIN, ROOT, Process, Rig, free_port, wait_for

sys.path.insert(0, str(ROOT / "docs/guide/examples/bridge"))
import chorus_push  # noqa: E402

CHORUS = BIN / "chorus"


class Tls(Rig):
    def setUp(self):
        super().setUp()
        self.path = pathlib.Path(self.folder.name)
        self.chorus("init", "ca", "--out", self.path / "ca")
        self.certify("host")
        self.trusting = ssl.create_default_context(cafile=str(self.path / "ca/ca.crt"))

    def chorus(self, *words, check=True):
        program = CHORUS if CHORUS.exists() else BIN / "chorus-host"
        done = subprocess.run([str(word) for word in (program, *words)], capture_output=True, text=True, check=False,
                              env={**os.environ, "CHORUS_CA": str(self.path / "ca/ca.crt")})
        if check:
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def certify(self, name, *hosts, authority="ca", days=30):
        self.chorus("init", "certificate", *(hosts or ("localhost",)), "--authority", self.path / authority, "--out", self.path / name,
                    "--days", days, "--renew")

    def get(self, url, **headers):
        with urllib.request.urlopen(urllib.request.Request(url, headers=headers), timeout=10, context=self.trusting) as answer:
            return answer.read()

    def get_json(self, url):
        return json.loads(self.get(url, Accept="application/json"))

    def tls(self, name):
        return {"certificate": str(self.path / name / "host.crt"), "key": str(self.path / name / "host.key")}

    def secure_sensor(self, name="host", kind="simulated"):
        config = self.path / "sensor.json"
        config.write_text(json.dumps({"http": {"port": free_port(), "tls": self.tls(name)},
                                      "device": {"kind": kind, **({"bridge": {"socket": ""}} if kind == "bridge" else {})}}))
        sensor = Process("chorus-sensor", "--config", str(config))
        self.processes.append(sensor)
        sensor.port = json.loads(config.read_text())["http"]["port"]
        sensor.url = f"https://127.0.0.1:{sensor.port}/"
        wait_for("it listens", lambda: not sensor.alive() or socket.create_connection(("127.0.0.1", sensor.port)).close() is None)
        self.assertTrue(sensor.alive(), sensor.text())
        return sensor

    def secure_fusion(self, sensor, **http):
        config = self.path / "fusion.json"
        port = free_port()
        config.write_text(json.dumps({"viewer_dir": "", "http": {"port": port, "tls": self.tls("host"), **http},
                                      "poll": {"ca": str(self.path / "ca/ca.crt")}, "sensors": [{"id": "s1", "url": sensor.url}]}))
        fusion = Process("chorus-fusion", "--config", str(config))
        self.processes.append(fusion)
        fusion.url, fusion.port = f"https://127.0.0.1:{port}/", port
        wait_for("it answers", lambda: self.get(fusion.url + "clock") if fusion.alive() else True)
        self.assertTrue(fusion.alive(), fusion.text())
        return fusion

    def state(self, fusion):
        return self.get_json(fusion.url + "sensors/s1")

    def wait_live(self, fusion):
        wait_for("the sensor is live", lambda: self.state(fusion)["state"] == "live")

    def wait_error(self, fusion, words):
        wait_for(f"it says {words!r}", lambda: words in self.state(fusion).get("lastError", ""))

    def test_frames_come_over_tls_and_the_command_line_reads_them(self):
        fusion = self.secure_fusion(self.secure_sensor())
        self.wait_live(fusion)
        wait_for("it is followed by a stream", lambda: self.state(fusion)["transport"] == "stream")  # begun anew if the first was late
        self.assertEqual(self.get_json(fusion.url + ".well-known/wot")["base"], fusion.url)
        self.assertIn("s1", self.chorus("status", "--url", fusion.url))
        refused = self.chorus("status", "--url", fusion.url.replace("https", "http"), check=False)
        self.assertIn("https://", refused)
        with socket.create_connection(("127.0.0.1", fusion.port)) as plain:
            plain.sendall(b"GET /frame HTTP/1.1\r\nHost: localhost\r\n\r\n")
            self.assertTrue(plain.recv(100).startswith(b"HTTP/1.1 400 "))
        recording = self.path / "s1.mcap"
        self.chorus("record", fusion.url, "--out", recording, "--seconds", "2")
        self.assertGreater(recording.stat().st_size, 1000)

    def test_an_old_version_of_tls_is_refused(self):
        sensor = self.secure_sensor()
        for version, taken in ((ssl.TLSVersion.TLSv1_1, False), (ssl.TLSVersion.TLSv1_2, True), (ssl.TLSVersion.TLSv1_3, True)):
            context = ssl.create_default_context(cafile=str(self.path / "ca/ca.crt"))
            context.set_ciphers("DEFAULT:@SECLEVEL=0")
            context.minimum_version = context.maximum_version = version
            with self.subTest(version.name), socket.create_connection(("127.0.0.1", sensor.port), 5) as connection:
                try:
                    context.wrap_socket(connection, server_hostname="127.0.0.1").close()
                    self.assertTrue(taken)
                except (ssl.SSLError, OSError):
                    self.assertFalse(taken)

    def by_hand(self, name, days="-1", names="IP:127.0.0.1,DNS:localhost"):
        """Made with openssl, because our own program makes none that is expired or not for this host."""
        folder = self.path / name
        shutil.copytree(self.path / "host", folder)
        (folder / "names").write_text(f"subjectAltName={names}\n")
        request = subprocess.run(["openssl", "req", "-new", "-key", folder / "host.key", "-subj", "/CN=old"], capture_output=True, check=True)
        subprocess.run(["openssl", "x509", "-req", "-CA", self.path / "ca/ca.crt", "-CAkey", self.path / "ca/ca.key", "-days", days,
                        "-extfile", folder / "names", "-out", folder / "host.crt"], input=request.stdout, capture_output=True, check=True)

    def test_an_expired_certificate_is_told_and_its_renewal_needs_no_restart(self):
        self.by_hand("old")
        sensor = self.secure_sensor("old")
        fusion = self.secure_fusion(sensor)
        self.wait_error(fusion, "has expired")
        self.assertIn("chorus init certificate", self.state(fusion)["lastError"])
        for file in ("host.crt", "host.key"):
            shutil.copy(self.path / "host" / file, self.path / "old" / file)
        sensor.child.send_signal(signal.SIGHUP)
        self.wait_live(fusion)

    def test_a_renewal_costs_no_frame(self):
        sensor = self.secure_sensor()
        fusion = self.secure_fusion(sensor)
        self.wait_live(fusion)
        # A loaded machine misses frames, too: a renewal that cost one would cost it every time.
        missed = [self.missed_by_a_renewal(sensor, fusion) for _ in range(3)]
        self.assertIn(0, missed)

    def missed_by_a_renewal(self, sensor, fusion):
        before = self.state(fusion).get("framesMissed", 0)
        first = ssl.get_server_certificate(("127.0.0.1", sensor.port))
        self.certify("host")
        sensor.child.send_signal(signal.SIGHUP)
        wait_for("the new one is shown", lambda: ssl.get_server_certificate(("127.0.0.1", sensor.port)) != first)
        received = self.state(fusion)["framesReceived"]
        wait_for("it goes on", lambda: self.state(fusion)["framesReceived"] > received + 20)
        self.assertEqual(self.state(fusion)["state"], "live")
        return self.state(fusion).get("framesMissed", 0) - before

    def test_a_spoilt_file_on_reload_keeps_the_old_certificate(self):
        sensor = self.secure_sensor()
        first = ssl.get_server_certificate(("127.0.0.1", sensor.port))
        (self.path / "host/host.crt").write_text("nothing")
        sensor.child.send_signal(signal.SIGHUP)
        wait_for("the log says so", lambda: "http.tls.certificate" in sensor.text())
        self.assertEqual(ssl.get_server_certificate(("127.0.0.1", sensor.port)), first)

    def test_a_foreign_authority_and_a_wrong_name_are_told(self):
        self.chorus("init", "ca", "--out", self.path / "other", "--name", "Somebody")
        self.certify("foreign", authority="other")
        sensor = self.secure_sensor("foreign")
        fusion = self.secure_fusion(sensor)
        self.wait_error(fusion, "signed by Somebody, who is not among those in")
        self.assertIn("poll.ca", self.state(fusion)["lastError"])

    def test_a_configuration_without_its_files_is_refused_with_what_to_do(self):
        config = self.path / "bad.json"
        for tls, words in (({"certificate": "/nowhere.crt", "key": "/nowhere.key"}, "chorus init certificate"),
                           ({"certificate": str(self.path / "host/host.crt")}, "is needed beside the certificate"),
                           ({**self.tls("host"), "key": str(self.path / "ca/ca.key")}, "belongs to another certificate")):
            config.write_text(json.dumps({"http": {"tls": tls}}))
            done = subprocess.run([str(BIN / "chorus-sensor"), "--check", "--config", str(config)], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
            self.assertIn(words, done.stdout + done.stderr)

    def test_frames_are_pushed_over_tls(self):
        sensor = self.secure_sensor(kind="bridge")
        for way in ("wss", "https"):
            told = []
            pusher = chorus_push.Pusher(f"{way}://127.0.0.1:{sensor.port}/push", {"name": "test", "layout": "coco_17"}, tell=told.append,
                                        ca=str(self.path / "ca/ca.crt"))
            points = [[0.0, 0.1 * i, 2.5] for i in range(17)]

            def served():
                self.assertTrue(pusher.push([{"id": 1, "points": points}]), told)
                return len(self.get_json(sensor.url + "frame")["bodies"]) == 1

            with self.subTest(way):
                wait_for("what was pushed is served", served)
                self.assertEqual(told, [])
            pusher.close()

    def circle(self, sensor, seconds, ca="ca/ca.crt"):
        """Starts the guide's sender in C++."""
        return subprocess.Popen([os.environ["CHORUS_PUSH_CIRCLE"], f"wss://127.0.0.1:{sensor.port}/push", str(seconds)],
                                stderr=subprocess.PIPE, text=True, env={**os.environ, "CHORUS_CA": str(self.path / ca) if ca else ""})

    def test_frames_are_pushed_over_tls_from_c_plus_plus(self):
        sensor = self.secure_sensor(kind="bridge")
        process = self.circle(sensor, 60)
        wait_for("what was pushed is served", lambda: len(self.get_json(sensor.url + "frame")["bodies"]) == 1)
        wait_for("it answers for its clock", lambda: self.get_json(sensor.url + "push")["pusher"]["frames"] > 60)
        wait_for("it is right", lambda: abs(self.get_json(sensor.url + "push")["pusher"]["clockOffsetMilliseconds"]) < 20)
        process.terminate()
        process.communicate()

    def test_a_c_plus_plus_sender_refuses_whom_it_cannot_believe(self):
        self.chorus("init", "ca", "--out", self.path / "other", "--name", "Somebody")
        self.by_hand("elsewhere", "30", "DNS:sensor-9")
        self.by_hand("old")
        for certificate, ca, words in (("host", None, "unable to get local issuer"), ("host", "other/ca.crt", "self-signed certificate|issuer"),
                                       ("elsewhere", "ca/ca.crt", "IP address mismatch"),
                                       ("old", "ca/ca.crt", "certificate has expired"), ("host", "none.crt", "no certificate can be read")):
            with self.subTest(words):
                sensor = self.secure_sensor(certificate, kind="bridge")
                said = self.circle(sensor, 0.1, ca).communicate(timeout=30)[1]
                self.assertRegex(said, words)
                sensor.stop()


if __name__ == "__main__":
    unittest.main()
