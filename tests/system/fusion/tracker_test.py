"""Six simulated sensors and the fusion server as real processes: one tracker, whatever happens to its sensors."""
import json
import pathlib
import time
import unittest

from rig import Rig, get, get_json, send, wait_for

SENSORS = 6


class Tracker(Rig):
    def start_all(self, count=SENSORS, **settings):
        self.sensors = [self.sensor(i, count) for i in range(count)]
        polled = {f"s{i + 1}": sensor.url for i, sensor in enumerate(self.sensors)}
        return self.fusion(polled, **settings)

    def body_seen(self, fusion):
        return get_json(fusion.url + "frame")["bodies"]

    def contributors(self, fusion):
        return {sensor for body in self.body_seen(fusion) for joint in body["joints"].values()
                for sensor in joint.get("contributors", [])}

    def states(self, fusion):
        return {k: v["state"] for k, v in get_json(fusion.url + "sensors/")["sensors"].items()}

    def test_registers_from_the_walk_survives_a_restart_and_a_dead_sensor(self):
        state = pathlib.Path(self.folder.name) / "state"
        settings = {"state_dir": state, "registration.seconds": 10, "registration.good_duration_s": 8}
        fusion = self.start_all(**settings)
        self.assertEqual(get(fusion.url + "healthz")[0], 503)

        wait_for("the first fused body", lambda: self.body_seen(fusion))
        self.assertIn(get_json(fusion.url + "registration")["verdict"], ("Provisional", "Good"))
        wait_for("healthy", lambda: get(fusion.url + "healthz")[0] == 200)
        wait_for("the session is over",
                 lambda: get_json(fusion.url + "registration")["session"]["state"] == "idle")
        stored = wait_for("the registration is stored", lambda: (state / "registration.json").exists()) and \
            json.loads((state / "registration.json").read_text())
        self.assertEqual(len(stored["sensors"]), SENSORS)

        self.check_frames(fusion)
        self.check_dead_sensor(fusion)
        self.check_sessions(fusion)
        self.check_restart(fusion, settings, stored)

    def check_frames(self, fusion):
        """Long polling returns each sequence once, in order."""
        tag, sequences = None, []
        while len(sequences) < 60:
            headers = {"If-None-Match": tag, "Prefer": "wait=5"} if tag else {}
            status, answer, body = get(fusion.url + "frame", headers=headers)
            if status != 200:
                continue
            tag = answer["ETag"]
            sequences.append(json.loads(body)["sequence"])
        self.assertEqual(len(set(sequences)), len(sequences))
        self.assertEqual(sequences, sorted(sequences))
        old = get_json(fusion.url + f"frames/{sequences[-30]}")
        self.assertEqual(old["sequence"], sequences[-30])
        self.assertEqual(get(fusion.url + "frames/1")[0], 410)
        self.assertEqual(get(fusion.url + f"frames/{sequences[-1] + 10**6}")[0], 404)
        between = int(old["capturedNanoseconds"]) + 5000  # within a microsecond it would be that frame
        self.assertEqual(int(get_json(fusion.url + f"frame?at={between}")["capturedNanoseconds"]), between)
        self.assertEqual(get(fusion.url + "frame?at=yesterday")[0], 400)
        self.assertEqual(get(fusion.url + "frame?at=2026-01-01T00:00:00Z")[0], 410)

    def check_dead_sensor(self, fusion):
        victim = self.sensors[2]
        victim.kill()
        wait_for("s3 is lost", lambda: self.states(fusion)["s3"] == "lost")
        self.assertEqual(get_json(fusion.url + "sensors/")["sensors"]["s3"]["share"], 0)
        others = wait_for("bodies without s3", lambda: "s3" not in self.contributors(fusion) and self.contributors(fusion))
        self.assertGreaterEqual(len(others), 2)
        self.processes.remove(victim)
        self.sensors[2] = self.sensor(2, SENSORS, port=victim.port)
        wait_for("s3 is back", lambda: self.states(fusion)["s3"] == "live" and "s3" in self.contributors(fusion))
        self.assertIn("sensor lost", fusion.text())

    def check_sessions(self, fusion):
        before = get_json(fusion.url + "registration")
        self.assertEqual(send("POST", fusion.url + "registration", b'{"seconds": 1}')[0], 400)
        self.assertEqual(send("POST", fusion.url + "registration", b'{"second": 30}')[0], 400)
        self.assertEqual(send("POST", fusion.url + "registration", b'nonsense')[0], 400)
        self.assertEqual(send("POST", fusion.url + "registration", b'{"seconds": 60}')[0], 202)
        wait_for("the session runs",
                 lambda: get_json(fusion.url + "registration")["session"]["state"] == "collecting")
        status, _, body = send("POST", fusion.url + "registration")
        self.assertEqual(status, 409)
        self.assertIn("running", json.loads(body)["detail"])
        # A running session does not change the good registration.
        self.assertEqual(get_json(fusion.url + "registration")["version"], before["version"])

    def check_restart(self, fusion, settings, stored):
        self.assertEqual(fusion.stop(), 0)
        polled = {f"s{i + 1}": sensor.url for i, sensor in enumerate(self.sensors)}
        again = self.fusion(polled, **settings)
        shown = get_json(again.url + "registration")
        self.assertEqual(shown["verdict"], stored["verdict"])
        for name, place in stored["sensors"].items():
            self.assertAlmostEqual(shown["sensors"][name]["x"], place["x"], places=3)
        wait_for("a body without a new walk", lambda: self.body_seen(again))
        self.assertEqual(get_json(again.url + "registration")["session"]["state"], "idle")
        self.assertEqual(send("DELETE", again.url + "registration")[0], 204)
        wait_for("forgotten", lambda: get_json(again.url + "registration")["version"] is not None and
                 not (pathlib.Path(settings["state_dir"]) / "registration.json").exists())

    def test_what_is_asked_for_seconds_later_is_smoothed_and_says_so(self):
        smoothing = {"live": True, "sides_ms": 1000, "bodies_ms": 200}
        fusion = self.start_all(count=3, **{"registration.file": self.given_ring(3),
                                            **{f"fusion.smoothing.{key}": json.dumps(value) for key, value in smoothing.items()}})
        frame = wait_for("a body", lambda: (shown := get_json(fusion.url + "frame"))["bodies"] and shown)
        instant = frame["capturedNanoseconds"]
        self.assertNotIn("smoothedOver", frame["bodies"][0])
        self.assertNotIn("smoothedOver", get_json(fusion.url + f"frame?at={instant}")["bodies"][0])
        over = wait_for("the smoothed frame",
                        lambda: get_json(fusion.url + f"frame?at={instant}")["bodies"][0].get("smoothedOver"))
        self.assertAlmostEqual(over, 1.2, delta=0.1)
        self.assertNotIn("smoothedOver", get_json(fusion.url + f"frames/{frame['sequence']}")["bodies"][0])
        self.check_what_frames_say_beside_places(fusion)

    def check_what_frames_say_beside_places(self, fusion):
        """Velocities, the person's build, the method, and the version of the world, which rises when the origin moves."""
        def walker():
            bodies = get_json(fusion.url + "frame")["bodies"]
            return bodies and "stature" in bodies[0] and abs(bodies[0].get("vx", 0)) + abs(bodies[0].get("vz", 0)) > 0.1 and bodies[0]
        body = wait_for("somebody walks", walker)
        self.assertLess(abs(body["vx"]) + abs(body["vz"]), 4)
        self.assertGreater(body["velocityVariance"], 0)
        self.assertEqual(body["fusionMethod"], "body-filter")
        self.assertTrue(1.2 < body["stature"] < 2.2 and 0 < body["statureSigma"] < 0.3, body["stature"])
        knee = body["joints"]["KneeLeft"]
        self.assertTrue(0.25 < knee["boneLength"] < 0.6 and 0 < knee["boneSigma"] < 0.1, knee)
        self.assertTrue({"vx", "vy", "vz", "velocityVariance"} <= set(body["joints"]["SpineMid"]))
        version = get_json(fusion.url + "frame")["registrationVersion"]
        self.assertEqual(version, get_json(fusion.url + "registration")["version"])
        self.assertEqual(send("POST", fusion.url + "registration/origin", b'{"x": 0.5, "z": 0, "yawDegrees": 0}')[0], 200)
        wait_for("a frame of the moved world", lambda: get_json(fusion.url + "frame")["registrationVersion"] == version + 1)

    def test_a_fusion_server_is_a_sensor_for_another(self):
        cell = self.start_all(count=3, **{"registration.file": self.given_ring(3)})
        wait_for("the cell sees somebody", lambda: self.body_seen(cell))
        site = self.fusion({"cell": cell.url}, **{"registration.seconds": 8, "registration.min_spread_m": 0.0})
        wait_for("the cell is live", lambda: self.states(site)["cell"] == "live")
        space = wait_for("the relayed frame", lambda: get_json(site.url + "sensors/cell/frame")["space"])
        self.assertEqual(space, "WorldSpace")
        wait_for("the site fuses the cell's body", lambda: self.body_seen(site))
        self.assertEqual(site.child.poll(), None)


if __name__ == "__main__":
    unittest.main(verbosity=2)
