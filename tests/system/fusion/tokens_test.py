"""A tracker reads a sensor that requires a token, reports a wrong token, and accepts another one while it runs; both report their state to
systemd."""

import json
import os
import pathlib
import signal
import socket
import unittest

from rig import Process, Rig, free_port, get, get_json, wait_for

READER = "0123456789abcdef"


class Tokens(Rig):
    def write(self, **entry):
        path = pathlib.Path(self.folder.name) / "fusion.json"
        path.write_text(json.dumps({"viewer_dir": "", "sensors": [{"id": "s1", **entry}]}))
        return str(path)

    def guarded_sensor(self):
        port = free_port()
        process = Process("chorus-sensor", "--port", str(port), "--set",
                          'http.tokens=' + json.dumps([{"token": READER, "role": "read"}]))
        self.processes.append(process)
        url = f"http://127.0.0.1:{port}/"
        wait_for("it answers", lambda: get(url + "healthz")[0] == 200)
        return url

    def test_the_tracker_is_let_in_with_its_token_and_without_it_says_what_is_wrong(self):
        url = self.guarded_sensor()
        self.assertEqual(get(url + "frame")[0], 401)
        self.assertEqual(get(url + ".well-known/wot")[0], 401, "what there is, is for readers")
        thing = get_json(url + ".well-known/wot", headers={"Authorization": f"Bearer {READER}"})
        self.assertEqual((thing["security"], thing["actions"]["startRecording"]["forms"][0]["security"]), (["read"], ["control"]))
        config = self.write(url=url, token="another-token")
        fusion = Process("chorus-fusion", "--config", config, "--port", str(free_port()), "--log-level", "debug")
        self.processes.append(fusion)
        port = fusion.child.args[fusion.child.args.index("--port") + 1]
        state = lambda: get_json(f"http://127.0.0.1:{port}/sensors/s1")  # noqa: E731
        wait_for("it says what is wrong", lambda: "token" in state().get("lastError", ""))
        self.write(url=url, token=READER)
        fusion.child.send_signal(signal.SIGHUP)
        wait_for("it is live with the right one", lambda: state()["state"] == "live")
        told = json.dumps(state()) + fusion.text()
        self.assertNotIn(READER, told, "a token is nobody else's business")
        self.assertNotIn("another-token", told)


class Systemd(Rig):
    def told(self, program, *arguments):
        path = str(pathlib.Path(self.folder.name) / "notify")
        listening = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.addCleanup(listening.close)
        listening.bind(path)
        listening.settimeout(20)
        os.environ.update(NOTIFY_SOCKET=path, WATCHDOG_USEC="200000")
        try:
            process = Process(program, "--port", str(free_port()), *arguments)
        finally:
            del os.environ["NOTIFY_SOCKET"], os.environ["WATCHDOG_USEC"]
        self.processes.append(process)
        messages = [listening.recv(100).decode() for _ in range(4)]
        self.assertEqual(process.stop(), 0)
        while messages[-1] == "WATCHDOG=1":
            messages.append(listening.recv(100).decode())
        return messages

    def test_is_told_of_the_start_of_every_pulse_and_of_the_end(self):
        for program in (("chorus-sensor",), ("chorus-fusion", "--set", "viewer_dir=")):
            with self.subTest(program[0]):
                messages = self.told(*program)
                self.assertEqual(messages[:4], ["READY=1"] + 3 * ["WATCHDOG=1"])
                self.assertEqual(messages[-1], "STOPPING=1")
                (pathlib.Path(self.folder.name) / "notify").unlink()


if __name__ == "__main__":
    unittest.main()
