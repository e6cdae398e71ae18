"""The output mqtt on Debian's mosquitto, read by its own mosquitto_sub: the poses of GET /frame, who left, and the last will."""
import json
import pathlib
import shutil
import signal
import socket
import subprocess
import unittest

from rig import Rig, free_port, get, wait_for

SENSORS = 3
PRINTED = 1e-4  # metres; /frame has four decimals
ENOUGH = 10     # number of frames compared
SBIN = "/usr/sbin:/usr/bin:/usr/local/sbin"


class Mqtt(Rig):
    def broker(self, port):
        config = pathlib.Path(self.folder.name) / "mosquitto.conf"
        passwords = pathlib.Path(self.folder.name) / "passwords"
        subprocess.run(["mosquitto_passwd", "-b", "-c", str(passwords), "plant", "secret"], check=True, capture_output=True)
        passwords.chmod(0o644)
        pathlib.Path(self.folder.name).chmod(0o755)
        config.write_text(f"listener {port} 127.0.0.1\nallow_anonymous false\npassword_file {passwords}\nmax_queued_messages 100\n")
        process = subprocess.Popen([shutil.which("mosquitto", path=SBIN), "-c", str(config)], stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        wait_for("the broker answers", lambda: socket.create_connection(("127.0.0.1", port), 1).close() or True)
        return process

    def subscriber(self, port, topic):
        process = subprocess.Popen(["mosquitto_sub", "-h", "127.0.0.1", "-p", str(port), "-u", "plant", "-P", "secret", "-t", topic, "-v"],
                                   stdout=subprocess.PIPE, text=True)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def test_a_plants_broker_has_the_poses_of_frame_and_the_last_will(self):
        port = free_port()
        sensors = {f"s{i + 1}": self.sensor(i, SENSORS).url for i in range(SENSORS)}
        # The broker comes later than the tracker.
        fusion = self.fusion(sensors, **{"registration.file": self.given_ring(SENSORS), "outputs.mqtt.enabled": "true",
                                         "outputs.mqtt.port": port, "outputs.mqtt.user": "plant",
                                         "outputs.mqtt.password": "secret", "outputs.mqtt.topic": "chorus/hall/a"})
        self.broker(port)
        people = self.subscriber(port, "chorus/hall/a/people/#")
        compared = 0
        while compared < ENOUGH:
            topic, _, payload = people.stdout.readline().partition(" ")
            message = json.loads(payload)
            self.assertEqual(topic, f"chorus/hall/a/people/{message['id']}")
            compared += self.compared(fusion, message)
        self.assertEqual(self.state(fusion)["clients"], 1)
        self.last_will(fusion, port)

    def compared(self, fusion, message):
        """Whether /frames/{seq} still has the frame; then it says the same."""
        status, _, body = get(fusion.url + f"frames/{message['sequence']}")
        if status != 200:
            return False
        bodies = {one["bodyId"]: one for one in json.loads(body)["bodies"]}
        joints = bodies[message["id"]]["joints"]
        tracked = {name for name, one in joints.items() if one["state"] != "NotTracked"}
        self.assertEqual(tracked, set(message["joints"]))
        for name, joint in message["joints"].items():
            for ours, key in zip(joint["place"], "xyz"):
                self.assertAlmostEqual(ours, joints[name][key], delta=PRINTED)
        return True

    @staticmethod
    def state(fusion):
        return json.loads(get(fusion.url + "outputs/")[2])["outputs"]["mqtt"]

    def last_will(self, fusion, port):
        status = self.subscriber(port, "chorus/hall/a/status")
        self.assertEqual(status.stdout.readline().strip(), "chorus/hall/a/status online")
        fusion.child.send_signal(signal.SIGKILL)
        self.assertEqual(status.stdout.readline().strip(), "chorus/hall/a/status offline")


if __name__ == "__main__":
    unittest.main()
