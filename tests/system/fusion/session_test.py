"""Registration sessions as seen by clients, and what is kept when the server is killed: real processes, simulated sensors."""
import json
import os
import pathlib
import signal
import subprocess
import time
import unittest

from rig import BIN, ROOT, Rig, get, get_json, send, wait_for

COUNT = 3
# Good after a short walk: how good the registration is does not matter in this test.
QUICK = {"registration.seconds": 10, "registration.good_duration_s": 8, "registration.good_position_m": 1.0, "registration.max_position_m": 1.0, "registration.good_rms_m": 1.0}
CHORUS = BIN / "chorus"


class Sessions(Rig):
    def start(self, count=COUNT, **settings):
        self.sensors = [self.sensor(i, COUNT) for i in range(count)]
        self.polled = {f"s{i + 1}": sensor.url for i, sensor in enumerate(self.sensors)}
        return self.fusion(self.polled, **{**QUICK, **settings})

    def registration(self, fusion):
        return get_json(fusion.url + "registration")

    def registered(self, fusion):
        wait_for("registered", lambda: self.registration(fusion)["verdict"] == "Good")
        wait_for("no session runs", lambda: self.registration(fusion)["session"]["state"] == "idle")
        return self.registration(fusion)

    def test_everybody_follows_one_session_from_the_answer_on(self):
        fusion = self.start(**{"registration.auto": "false"})
        wait_for("it says what to do", lambda: "run chorus register" in " ".join(self.registration(fusion)["awaits"]))
        status, headers, body = send("POST", fusion.url + "registration", b'{"seconds": 8}')
        self.assertEqual(status, 202)
        path = headers["Location"]
        for _ in range(40):  # until the pipeline has received it
            session = get_json(fusion.url + path.lstrip("/"))
            self.assertEqual((session["state"], session["verdict"]), ("collecting", "None"), session)
            self.assertEqual(self.registration(fusion)["session"]["state"], "collecting")
        self.assertIn(path.encode(), body, "the answer shows it too")
        self.assertEqual(send("POST", fusion.url + "registration")[0], 409)
        done = wait_for("it is over", lambda: (s := get_json(fusion.url + path.lstrip("/")))["state"] == "done" and s)
        self.assertTrue(done["adopted"], done)
        self.assertEqual(send("DELETE", fusion.url + path.lstrip("/"))[0], 409)
        again = send("POST", fusion.url + "registration")[1]["Location"]
        self.assertNotEqual(again, path)
        self.assertEqual(send("DELETE", fusion.url + again.lstrip("/"))[0], 204)
        self.assertEqual(get_json(fusion.url + again.lstrip("/"))["state"], "cancelled")
        self.assertEqual(get_json(fusion.url + path.lstrip("/"))["state"], "done", "the last ones stay readable")

    def test_a_result_waits_until_it_is_accepted(self):
        fusion = self.start()
        before = self.registered(fusion)
        post = lambda what: send("POST", fusion.url + "registration" + what)[0]  # noqa: E731
        self.assertEqual((post("/accept"), post("/decline")), (404, 404))

        def walked():
            status, headers, _ = send("POST", fusion.url + "registration", b'{"seconds": 16, "adopt": "when-accepted"}')
            self.assertEqual(status, 202)
            path = fusion.url + headers["Location"].lstrip("/")
            return path, wait_for("it is over", lambda: (s := get_json(path))["state"] == "done" and s)

        def proposed():
            # On a busy machine a walk may hold too few frames to place anybody as well as before: then it says so, and one walks again.
            for _ in range(4):
                path, done = walked()
                if "proposal" in self.registration(fusion):
                    break
                self.assertIn("no sensor is better placed", " ".join(done["reasons"]))
            self.assertEqual((done["adopt"], done["adopted"]), ("when-accepted", False), done)
            shown = self.registration(fusion)
            self.assertEqual((shown["version"], shown["sensors"]), (before["version"], before["sensors"]), "nothing has changed")
            proposal = shown["proposal"]
            self.assertEqual(proposal["sessionId"], done["sessionId"])
            self.assertEqual([c["sensorId"] for c in proposal["changes"]], ["s1", "s2", "s3"])
            for change in proposal["changes"]:
                self.assertLess(change["moves"], 0.3)
                self.assertLess(change["expectedRadius"], 0.3)
                self.assertIn("presentRadius", change)
            return path

        path = proposed()
        self.assertEqual(post("/decline"), 200)
        self.assertNotIn("proposal", self.registration(fusion))
        wait_for("it says why", lambda: "declined" in " ".join(get_json(path)["reasons"]))
        path = proposed()
        self.assertEqual(post("/accept"), 200)
        self.assertGreater(self.registration(fusion)["version"], before["version"], "from the answer on")
        wait_for("in use", lambda: get_json(path)["adopted"] and self.registration(fusion)["earlier"]["version"] == before["version"])

    def test_the_command_line_registers_afresh_and_joins_what_runs_by_itself(self):
        if not CHORUS.exists():
            self.skipTest("runs in builds with the program chorus")
        fusion = self.start()
        wait_for("a session by itself", lambda: self.registration(fusion)["session"]["state"] == "collecting")
        for arguments in (("--seconds", "9"), ("--seconds", "8", "--fresh", "--json")):
            begun = time.monotonic()
            done = subprocess.run([CHORUS, "register", "--url", fusion.url, *arguments], capture_output=True, text=True, timeout=90)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertGreater(time.monotonic() - begun, 3.0, "never the verdict of before")
        self.assertIn(json.loads(done.stdout)["verdict"], ("Good", "Provisional"))

    def test_a_killed_server_comes_back_as_it_was(self):
        state = pathlib.Path(self.folder.name) / "state"
        fusion = self.start(state_dir=state)
        self.registered(fusion)
        before = wait_for("stored", lambda: (r := self.registration(fusion))["stored"] and r)
        stored = wait_for("stored", lambda: (t := (state / "registration.json").read_bytes()) and json.loads(t)["version"] == before["version"] and t)
        person = wait_for("somebody", lambda: get_json(fusion.url + "frame")["bodies"])[0]["bodyId"]
        fusion.stop(signal.SIGKILL)
        again = self.fusion(self.polled, wait=False, state_dir=state, **QUICK)
        wait_for("it answers", lambda: get(again.url + "healthz")[0])
        begun = time.monotonic()
        bodies = wait_for("a body", lambda: get_json(again.url + "frame").get("bodies"))
        print(f"first body {1e3 * (time.monotonic() - begun):.0f} ms after the first answer")
        self.assertLess(time.monotonic() - begun, QUICK["registration.seconds"] / 2, "a new walk would take longer")
        self.assertGreater(bodies[0]["bodyId"], person, "ids of people go on")
        after = self.registration(again)
        for key in ("verdict", "master", "sensors", "edges", "version"):
            self.assertEqual(after[key], before[key])
        send("POST", again.url + "registration", b'{"seconds": 60}')
        self.assertEqual((state / "registration.json").read_bytes(), stored, "to the bit")

    def test_state_has_a_folder_by_default_and_none_on_purpose(self):
        fusion = self.fusion({}, wait=False)
        wait_for("it answers", lambda: get(fusion.url + "registration")[0] == 200)
        folder = pathlib.Path(fusion.state.name) / f"chorus/fusion-{fusion.port}"
        wait_for("the folder", lambda: (folder / "people.json").exists())
        self.assertTrue(self.registration(fusion)["stored"])
        nowhere = self.fusion({}, wait=False, state_dir="")
        wait_for("it answers", lambda: get(nowhere.url + "registration")[0] == 200)
        shown = self.registration(nowhere)
        self.assertFalse(shown["stored"])
        self.assertIn("state_dir is empty", shown["storeProblem"])
        self.assertIn("state_dir is empty", nowhere.text())

    def test_folders_that_cannot_be_used_are_told_at_the_start(self):
        in_the_way = pathlib.Path(self.folder.name) / "file"
        in_the_way.write_text("")
        fusion = self.start(state_dir=in_the_way, viewer_dir=in_the_way, **{
            "recording.folder": in_the_way / "below", "registration.file": self.given_ring(COUNT)})
        for text in ("state cannot be kept", "viewer cannot be served", "nothing can be recorded"):
            self.assertIn(text, fusion.text())
        shown = self.registration(fusion)
        self.assertFalse(shown["stored"])
        self.assertIn(str(in_the_way), shown["storeProblem"])
        self.assertIn("chorus_registration_stored 0", get(fusion.url + "metrics", accept="*/*")[2].decode())
        wait_for("healthy", lambda: get(fusion.url + "healthz")[0] == 200)
        self.assertIn(str(in_the_way), get_json(fusion.url + "healthz")["warning"])

    def test_a_sensor_added_later_moves_none_of_the_others(self):
        fusion = self.start(count=2)
        before = self.registered(fusion)
        self.assertEqual(len(before["sensors"]), 2)
        fusion.stop()
        third = self.sensor(2, COUNT)
        state = pathlib.Path(self.folder.name) / "state"
        state.mkdir()
        # A restart with a third sensor has the effect of a SIGHUP with a longer list, without a file to edit.
        (state / "registration.json").write_bytes(
            (pathlib.Path(fusion.state.name) / f"chorus/fusion-{fusion.port}/registration.json").read_bytes())
        more = self.fusion({**self.polled, "s3": third.url}, state_dir=state, **QUICK)
        verdicts = set()

        def placed():
            shown = self.registration(more)
            verdicts.add(shown["verdict"])
            for name, place in before["sensors"].items():
                self.assertEqual({k: shown["sensors"][name][k] for k in "xyz"}, {k: place[k] for k in "xyz"})
                self.assertEqual(shown["sensors"][name]["verdict"], "Good")
            return "s3" in shown["sensors"] and shown["session"]["state"] == "idle"

        wait_for("its bodies are counted before it has a place",
                 lambda: get_json(more.url + "sensors/s3")["bodies"] == 1 and "s3" not in self.registration(more)["sensors"])
        wait_for("the third has a place", placed)
        self.assertLessEqual(verdicts, {"Good", "Provisional"}, "the third is in use before the walk is long enough for Good")
        self.assertEqual(self.registration(more)["verdict"], "Good")
        wait_for("its share", lambda: get_json(more.url + "sensors/s3")["share"] > 0.5)


if __name__ == "__main__":
    os.chdir(ROOT)
    unittest.main(verbosity=2)
