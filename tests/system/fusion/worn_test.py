"""Real processes: a simulated suit on a person whom three sensors see; it is found out who wears it, and it helps fusion."""
import json
import unittest

from rig import Rig, get, get_json, wait_for

COUNT = 3


class Worn(Rig):
    def start(self, **settings):
        sensors = {f"s{i + 1}": self.sensor(i, COUNT).url for i in range(COUNT)}
        suit = self.sensor(0, id="suit", **{"device.kind": "inertial", "device.inertial.source": "simulated", "device.inertial.sensors": 13})
        return self.fusion(sensors, **{"registration.file": self.given_ring(COUNT),
                                       "inertial": json.dumps([{"id": "suit", "url": suit.url}]), **settings})

    def sensor(self, index, count=COUNT, port=None, **settings):
        if settings.get("device.kind") != "inertial":
            return super().sensor(index, count, port, **settings)
        # It has /orientations instead of /frame.
        from rig import Process, free_port
        port = free_port()
        options = {"http.port": port, **settings}
        arguments = [a for key, value in options.items() for a in ("--set", f"{key}={value}")]
        process = Process("chorus-sensor", "--config", "deploy/config/sensor.json", *arguments)
        self.processes.append(process)
        process.url = f"http://127.0.0.1:{port}/"
        wait_for("the suit answers", lambda: not process.alive() or get(process.url + "orientations")[0] == 200)
        self.assertTrue(process.alive(), process.text())
        return process

    def test_a_suit_is_calibrated_and_is_named_among_the_contributors(self):
        fusion = self.start(**{"fusion.inertial.enabled": "true"})
        of_suit = lambda: get_json(fusion.url + "inertial/")["inertialSources"]["suit"]
        wait_for("it is known who wears it", lambda: of_suit().get("wearer"))
        wait_for("four limbs are calibrated", lambda: len(of_suit().get("knownLimbs", [])) >= 4)

        def helped():
            frame = get_json(fusion.url + "frame")
            for body in frame["bodies"]:
                for joint in body["joints"].values():
                    if "suit" in joint.get("contributors", []) and "oxx" in joint:
                        return frame, body
            return None
        frame, body = wait_for("the suit is a contributor", helped)
        self.assertEqual(int(body["bodyId"]), int(of_suit()["wearer"]))
        # It is no sensor: it has no place, and is in no list of sensors.
        self.assertNotIn("suit", get_json(fusion.url + "sensors/")["sensors"])
        self.assertNotIn("suit", json.dumps(get_json(fusion.url + "registration")))
        status, headers, turtle = get(fusion.url + "frame", accept="text/turtle")
        self.assertEqual(status, 200)
        self.assertIn(b'"suit"', turtle)

    def test_unless_it_is_enabled_a_suit_changes_nothing(self):
        fusion = self.start()
        wait_for("the suit is followed", lambda: get_json(fusion.url + "inertial/")["inertialSources"]["suit"]["rateHz"] > 10)
        self.assertNotIn("wearer", get_json(fusion.url + "inertial/")["inertialSources"]["suit"])
        self.assertNotIn("suit", json.dumps(get_json(fusion.url + "frame")))


if __name__ == "__main__":
    unittest.main()
