"""chorus-fusion as a program: configuration, signals, exit codes, self-description."""
import json
import pathlib
import signal
import socket
import time
import unittest

from rig import BIN, ROOT, Process, Rig, free_port, get, get_json, send, wait_for


class Program(Rig):
    def run_to_end(self, *arguments):
        process = Process("chorus-fusion", *arguments)
        self.processes.append(process)
        return process.child.wait(timeout=20), process.text()

    def write(self, name, text):
        path = pathlib.Path(self.folder.name) / name
        path.write_text(text)
        return str(path)

    def test_bad_configurations_end_with_2_and_one_clear_message(self):
        cases = {
            "missing": ("no-such-file.json", "cannot be read"),
            "broken": (self.write("broken.json", "{ nope"), "broken.json"),
            "unknown": (self.write("unknown.json", '{"outptu": {}}'), "output"),
            "range": (self.write("range.json", '{"output": {"rate_hz": 0}}'), "output.rate_hz"),
            "url": (self.write("url.json", '{"sensors": [{"id": "s1", "url": "ftp://x"}]}'), "sensors.0.url"),
            "twice": (self.write("twice.json", '{"sensors": [{"id": "s1", "url": "http://a/"}, {"id": "s1", "url": "http://b/"}]}'), "sensors.1.id"),
            "extrinsics": (self.write("given.json", '{"registration": {"file": "no-such-registration.json"}}'),
                           "no-such-registration.json"),
        }
        for name, (path, expected) in cases.items():
            code, text = self.run_to_end("--config", path, "--set", "http.port=0")
            self.assertEqual(code, 2, f"{name}: {text}")
            self.assertIn(expected, text, name)
            self.assertNotIn("terminate", text)

    def test_wrong_options_end_with_2_and_help_with_0(self):
        for options in (("--no-such-option",), ("--config",), ("--config", "deploy/config/fusion.json", "--log-level", "loud")):
            code, text = self.run_to_end(*options)
            self.assertEqual(code, 2, f"{options}: {text}")
        code, text = self.run_to_end("--help")
        self.assertEqual((code, "Exit codes: 0" in text), (0, True), text)

    def test_check_judges_a_file_and_starts_nothing(self):
        code, text = self.run_to_end("--config", "deploy/config/fusion.json", "--check")
        self.assertEqual((code, "is good" in text), (0, True), text)
        code, text = self.run_to_end("--config", self.write("bad.json", '{"prot": 1}'), "--check")
        self.assertEqual(code, 2, text)

    def test_a_port_in_use_ends_with_2(self):
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            port = taken.getsockname()[1]
            code, text = self.run_to_end("--config", "deploy/config/fusion.json", "--set", f"http.port={port}")
        self.assertEqual(code, 2, text)
        self.assertIn(str(port), text)
        self.assertIn("in use", text.lower())
        self.assertIn("set http.port to", text)

    def test_a_corrupt_stored_registration_is_reported_and_survived(self):
        state = pathlib.Path(self.folder.name) / "state"
        state.mkdir()
        for content in ("{", "[]", '{"sensors": {"s1": {"x": "NaN"}}}', "", "[" * 20000):
            (state / "registration.json").write_text(content)
            fusion = self.fusion({}, state_dir=state)
            self.assertIn("stored registration damaged", fusion.text())
            shown = get_json(fusion.url + "registration")
            self.assertEqual(shown["verdict"], "None")
            self.assertIn("have to be registered anew", shown["storeProblem"])
            self.assertIn(content, [file.read_text() for file in state.glob("registration.json.damaged*")], "kept aside")
            self.assertEqual(fusion.stop(), 0)

    def test_reload_takes_the_new_file_and_keeps_the_old_one_when_it_is_wrong(self):
        config = self.write("fusion.json", '{"sensors": [{"id": "a", "url": "http://127.0.0.1:1/"}]}')
        port = free_port()
        fusion = Process("chorus-fusion", "--config", config, "--set", f"http.port={port}")
        self.processes.append(fusion)
        url = f"http://127.0.0.1:{port}/"
        sensors = lambda: sorted(get_json(url + "sensors/")["sensors"])
        self.assertEqual(wait_for("it answers", sensors), ["a"])
        self.write("fusion.json", '{"sensors": [{"id": "a", "url": "http://127.0.0.1:1/"}, '
                                  '{"id": "b", "url": "http://127.0.0.1:2/"}], "output": {"rate_hz": 60}}')
        fusion.child.send_signal(signal.SIGHUP)
        wait_for("the new sensor", lambda: sensors() == ["a", "b"])
        self.assertEqual(get(url + "sensors/b")[0], 200)
        self.write("fusion.json", '{"sensors": 7}')
        fusion.child.send_signal(signal.SIGHUP)
        wait_for("the refusal", lambda: "the old one stays" in fusion.text())
        self.assertEqual(sensors(), ["a", "b"])
        self.write("fusion.json", '{"sensors": [], "http": {"address": "0.0.0.0"}}')
        fusion.child.send_signal(signal.SIGHUP)
        wait_for("what waits is named", lambda: "changes wait for a restart" in fusion.text())
        wait_for("no sensors", lambda: sensors() == [])
        self.assertEqual(fusion.stop(), 0)

    def test_log_and_token_are_reloaded_while_it_runs(self):
        config = self.write("fusion.json", '{"log": {"format": "json"}, "http": {"bearer_token": "the-old-token"}}')
        port = free_port()
        fusion = Process("chorus-fusion", "--config", config, "--port", str(port), "--log-level", "info")
        self.processes.append(fusion)
        url = f"http://127.0.0.1:{port}/"
        wait_for("it answers", lambda: get(url + "frame")[0] in (200, 503))
        wait_for("it says so", lambda: "fusion server ready" in [json.loads(line)["event"] for line in fusion.text().splitlines()])

        def allowed(token):
            headers = {"Authorization": f"Bearer {token}"}
            return send("DELETE", url + "recordings/none", headers=headers)[0] == 404

        self.assertEqual((allowed("the-old-token"), allowed("the-new-token")), (True, False))
        self.write("fusion.json", '{"log": {"format": "text"}, "http": {"bearer_token": "the-new-token"}}')
        fusion.child.send_signal(signal.SIGHUP)
        wait_for("the new token", lambda: allowed("the-new-token"))
        self.assertFalse(allowed("the-old-token"))
        wait_for("the new format", lambda: "configuration reloaded" in fusion.text())
        self.assertFalse(fusion.text().splitlines()[-1].startswith("{"), fusion.text())
        self.assertNotIn("wait for a restart", fusion.text())

    def test_it_says_what_is_in_force_and_reloads_its_outputs(self):
        vrpn = free_port()
        config = self.write("fusion.json", '{"title": "a", "http": {"bearer_token": "a-secret-token"}}')
        port = free_port()
        fusion = Process("chorus-fusion", "--config", config, "--port", str(port))
        self.processes.append(fusion)
        url = f"http://127.0.0.1:{port}/"
        told = wait_for("it answers", lambda: get_json(url + "configuration"))
        self.assertEqual((told["file"], told["pendingRestart"], told["changedOnDisk"]), ("fusion.json", [], []))
        self.assertNotIn("a-secret-token", json.dumps(told))
        self.assertNotIn(str(self.folder.name), json.dumps(told), "no path of the host")
        self.assertEqual(get_json(url + "outputs/")["outputs"], {})

        def reloaded(text):
            self.write("fusion.json", text)
            fusion.child.send_signal(signal.SIGHUP)

        reloaded('{"title": "a", "outputs": {"vrpn": {"enabled": true, "port": %d}}}' % vrpn)
        wait_for("VRPN is served", lambda: get_json(url + "outputs/")["outputs"]["vrpn"]["state"] == "open")
        with socket.create_connection(("127.0.0.1", vrpn), timeout=10) as client:
            self.assertTrue(client.recv(6).startswith(b"vrpn"))
        reloaded('{"title": 3}')
        told = wait_for("the mistake is told", lambda: get_json(url + "configuration").get("lastReloadError"))
        self.assertIn("title", told)
        self.assertIn(b"chorus_configuration_reload_failed 1", get(url + "metrics", accept="*/*")[2])
        self.assertEqual(get_json(url + "outputs/")["outputs"]["vrpn"]["state"], "open", "the old one stays")
        reloaded('{"title": "b"}')
        wait_for("it waits", lambda: get_json(url + "configuration")["pendingRestart"] == ["http.bearer_token", "title"]
                 or get_json(url + "configuration")["pendingRestart"] == ["title"])
        wait_for("VRPN is closed", lambda: get_json(url + "outputs/")["outputs"] == {})

    def test_signals_that_mean_nothing_end_nothing(self):
        fusion = self.fusion({"gone": "http://127.0.0.1:1/"})
        for number in (signal.SIGUSR1, signal.SIGUSR2):
            fusion.child.send_signal(number)
        self.assertIn(get(fusion.url + "clock")[0], (200,))
        self.assertEqual(fusion.stop(), 0)

    def test_sigterm_ends_with_0_even_with_long_polls_waiting(self):
        fusion = self.fusion({"gone": "http://127.0.0.1:1/"})
        tag = get(fusion.url + "registration")[1]["ETag"]
        waiting = socket.create_connection(("127.0.0.1", fusion.port))
        waiting.sendall(f"GET /registration HTTP/1.1\r\nHost: localhost\r\nIf-None-Match: {tag}\r\nPrefer: wait=30\r\n\r\n".encode())
        begun = time.monotonic()
        self.assertEqual(fusion.stop(), 0)
        self.assertLess(time.monotonic() - begun, 20.0, "the client would have waited 30 s")
        waiting.close()

    def test_every_resource_answers_in_every_format(self):
        fusion = self.fusion({"gone": "http://127.0.0.1:1/"}, viewer_dir=str(ROOT / "services/viewer"))
        formats = ("text/turtle", "application/ld+json", "application/json", "application/n-triples")
        for path in ("", "frame", "skeletons/", "floor-plane", "sensors/", "sensors/gone", "registration", "clock"):
            for accept in formats:
                status, headers, body = get(fusion.url + path, accept=accept)
                self.assertEqual(status, 200, f"{path} {accept} {body[:200]}")
                self.assertEqual(headers["Content-Type"].split(";")[0], accept)
                self.assertTrue(headers["ETag"])
                self.assertTrue(headers["Chorus-Clock"])
                if "json" in accept:
                    json.loads(body)
        page = get(fusion.url, accept="text/html,application/xhtml+xml,*/*;q=0.8")
        self.assertIn(b"viewer/", page[2])
        self.assertEqual(get(fusion.url + "viewer/", accept="text/html")[0], 200)
        self.assertEqual(get(fusion.url + "sensors/nobody")[0], 404)
        self.assertEqual(get(fusion.url + "sensors/gone/frame")[0], 503)
        self.assertEqual(get(fusion.url + "skeletons/1")[0], 404)
        self.assertEqual(get(fusion.url + "frame", accept="image/png")[0], 406)
        metrics = get(fusion.url + "metrics", accept="*/*")[2].decode()
        for name in ("chorus_fused_frames_total", "chorus_sensor_up", "chorus_http_requests_total"):
            self.assertIn(name, metrics)


if __name__ == "__main__":
    assert BIN.exists(), f"build chorus-fusion first ({BIN})"
    unittest.main(verbosity=2)
