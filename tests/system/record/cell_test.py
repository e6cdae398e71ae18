"""A cell of real processes is recorded, killed, downloaded, replayed and fused again."""

import json
import math
import pathlib
import signal
import subprocess
import sys
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tests/system/fusion"), str(ROOT / "tests/support")]
from ports import free_ports  # noqa: E402
from rig import BIN, Rig, get, get_json, send, wait_for  # noqa: E402

SENSORS = 3


def chorus(*arguments, seconds=90):
    return subprocess.run([BIN / "chorus", *map(str, arguments)], cwd=ROOT, capture_output=True, text=True, timeout=seconds)


def positions(frame):
    """Of the joints of the only person, each with who contributed; ids are given anew each time."""
    return {name: (tuple(joint[a] for a in "xyz"), sorted(joint.get("contributors", [])))
            for body in frame["bodies"] for name, joint in body["joints"].items() if "x" in joint}


class Cell(Rig):
    def cell(self, **settings):
        self.at = pathlib.Path(self.folder.name)
        sensors = {f"s{i + 1}": self.sensor(i, SENSORS).url for i in range(SENSORS)}
        fusion = self.fusion(sensors, **{"registration.file": self.given_ring(SENSORS),
                                         "recording.folder": self.at / "rec", "recording.min_free_mb": 0, **settings})
        wait_for("somebody is fused", lambda: get_json(fusion.url + "frame")["bodies"])
        return fusion

    def fuse(self, recording, out, *options):
        done = chorus("fuse", recording, "--out", self.at / out, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return (self.at / out).read_bytes()

    def finished(self, url):
        return wait_for("the recording ends", lambda: (r := get_json(url))["state"] == "finished" and r)

    def test_recorded_by_the_service_and_fused_again(self):
        fusion = self.cell()
        status, headers, body = send("POST", fusion.url + "recordings/", b'{"name": "walk", "seconds": 4}')
        self.assertEqual((status, headers["Location"]), (201, "/recordings/walk"), body)
        self.assertEqual(send("POST", fusion.url + "recordings/")[0], 409)
        report = self.finished(fusion.url + "recordings/walk")
        self.assertEqual(report["dropped"], 0)
        self.assertGreater(report["frames"], 4 * 8 * (SENSORS + 1), "a loaded machine delivers fewer than 30 a second")
        self.assertIn(b"chorus_recording_dropped_total 0", get(fusion.url + "metrics", accept="*/*")[2])
        file = self.downloaded(fusion, report)
        self.assertEqual(file.stat().st_size, report["bytes"])

        # Raw frames through the pipeline twice: the result is the same, byte for byte.
        self.assertEqual(self.fuse(file, "a.mcap"), self.fuse(self.at / "rec/walk", "b.mcap"))
        # Where the same sensors took part, it is not what was fused live: the server remembers what it saw before.  But it is close.
        apart = self.apart_from_live(file)
        self.assertLess(apart[len(apart) // 2], 0.005)
        self.assertLess(apart[len(apart) * 95 // 100], 0.025)
        self.assertNotEqual(self.fuse(file, "c.mcap", "--method", "mean"), (self.at / "a.mcap").read_bytes())

    def test_without_memory_a_recording_is_fused_as_it_was_live(self):
        fusion = self.cell(**{"fusion.method": "inverse-variance"})
        self.assertEqual(send("POST", fusion.url + "recordings/", b'{"name": "walk", "seconds": 4}')[0], 201)
        report = self.finished(fusion.url + "recordings/walk")
        file = self.downloaded(fusion, report)
        apart = self.apart_from_live(file, "--method", "inverse-variance")
        self.assertEqual(apart[len(apart) * 9 // 10], 0.0, "the beginning, where the recording lacks what came before, may differ")
        live = [len(joint.get("contributors", [])) for frame in self.fused_frames(file)
                for body in frame["bodies"] for joint in body["joints"].values()]
        self.assertGreater(max(live), 1, "it was fused, not passed on")

    def downloaded(self, fusion, report):
        file = self.at / "walk.mcap"
        file.write_bytes(get(fusion.url + report["download"].lstrip("/"), accept="*/*")[2])
        return file

    def apart_from_live(self, file, *options):
        """Distances of the joints that are fused again from where they were live [m], the shortest first.

        On a loaded machine a sensor's frame reaches the live server after its instant was published; the recording has it all the
        same, so `chorus fuse` uses it.  What was delivered is compared: joints to which live and again the same sensors contributed.
        """
        again = [json.loads(line) for line in self.fuse(file, "again.ndjson", *options).splitlines()]
        # Offline the 30 Hz instants are rounded, live they are truncated: a nanosecond apart.
        instant = lambda frame: round(int(frame["capturedNanoseconds"]) / 1e6)
        by_instant = {instant(frame): positions(frame) for frame in again}
        pairs = [(positions(frame), by_instant[instant(frame)]) for frame in self.fused_frames(file) if instant(frame) in by_instant]
        self.assertGreater(len(pairs), 30)
        alike = [(live[joint], joints[joint]) for live, joints in pairs for joint in live if joint in joints]
        same = [math.dist(a, b) for (a, by), (b, again_by) in alike if by == again_by]
        self.assertGreater(len(same), 500, f"joints of {len(pairs)} frames, of {len(alike)} seen both times")
        return sorted(same)

    def fused_frames(self, file):
        """The fused frames in a recording, read message by message by recording_probe, not as `chorus fuse` reads cells."""
        read = subprocess.run([BIN.parent / "tests/recording_probe", "read", file], capture_output=True, check=True)
        return [json.loads(m["text"]) for m in json.loads(read.stdout)["messages"] if m["topic"] == "/frame"]

    def test_recorded_from_outside_and_replayed(self):
        fusion = self.cell()
        done = chorus("record", fusion.url, "--out", self.at / "mine.mcap", "--seconds", 3, "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        streams = json.loads(done.stdout)["streams"]
        self.assertEqual(set(streams), {"/frame"} | {f"/sensors/s{i + 1}/frame" for i in range(SENSORS)})
        for topic, count in streams.items():
            self.assertGreater(count["frames"], 20, topic)
        again = chorus("record", fusion.url, "--out", self.at / "mine.mcap", "--seconds", 1)
        self.assertEqual(again.returncode, 1, "a file that exists is never overwritten")

        self.assertEqual(self.fuse(self.at / "mine.mcap", "a.mcap"), self.fuse(self.at / "mine.mcap", "b.mcap"))
        first = free_ports(SENSORS)
        replay = subprocess.Popen([BIN / "chorus", "replay", self.at / "mine.mcap", "--port", str(first)], cwd=ROOT,
                                  stdout=subprocess.PIPE, text=True)
        try:
            url = replay.stdout.readline().split()[2]
            frame = wait_for("the replay serves", lambda: (a := get(url + "frame"))[0] == 200 and json.loads(a[2]))
            self.assertEqual((frame["source"], frame["space"]), ("s1", "SensorSpace"))
        finally:
            replay.send_signal(signal.SIGTERM)
            replay.communicate(timeout=20)

    def test_a_sensor_records_itself(self):
        folder = pathlib.Path(self.folder.name) / "rec"
        sensor = self.sensor(0, **{"recording.folder": folder, "recording.min_free_mb": 0})
        self.assertEqual(send("POST", sensor.url + "recordings/", b'{"name": "a"}')[0], 201)
        wait_for("frames are written", lambda: get_json(sensor.url + "recordings/a")["frames"] > 20)
        self.assertEqual(send("DELETE", sensor.url + "recordings/a")[0], 202)
        self.finished(sensor.url + "recordings/a")
        self.assertEqual(send("DELETE", sensor.url + "recordings/a")[0], 200)
        self.assertEqual(send("POST", sensor.url + "recordings/", b'{"fused": true}')[0], 400)
        again = self.sensor(1, **{"id": "other", "device.kind": "replay", "device.replay.recording": folder / "a"})
        self.assertTrue(get_json(again.url + "frame")["bodies"])

    def test_two_recordings_of_one_sensor_are_not_taken_for_one(self):
        sensor, folder = self.sensor(0), pathlib.Path(self.folder.name) / "two"
        folder.mkdir()
        for name in ("b.mcap", "a.mcap"):  # the later one comes first by name
            self.assertEqual(chorus("record", sensor.url, "--out", folder / name, "--seconds", 1).returncode, 0)
        done = chorus("fuse", folder, "--out", folder / "x.ndjson")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("not parts of one recording", done.stderr)

    def test_an_import_spares_what_was_recorded(self):
        sensor, folder = self.sensor(0), pathlib.Path(self.folder.name) / "walks"
        folder.mkdir()
        self.assertEqual(chorus("record", sensor.url, "--out", folder / "s1.mcap", "--seconds", 1).returncode, 0)
        kept = (folder / "s1.mcap").read_bytes()
        source = "tests/data/kinect2_labanotation/Ges04_comehere.csv"
        done = chorus("import", "labanotation", source, "--out", folder, "--sensor", "s1")
        self.assertEqual(done.returncode, 1)
        self.assertIn("was recorded, not imported", done.stderr)
        self.assertEqual((folder / "s1.mcap").read_bytes(), kept)
        for _ in range(2):  # importing can be repeated
            done = chorus("import", "labanotation", source, "--out", folder, "--sensor", "s2")
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_name_that_is_taken_asks_for_another(self):
        folder = pathlib.Path(self.folder.name) / "rec"
        (folder / "walk").mkdir(parents=True)
        sensor = self.sensor(0, **{"recording.folder": folder, "recording.min_free_mb": 0})
        status, _, body = send("POST", sensor.url + "recordings/", b'{"name": "walk"}')
        self.assertEqual(status, 409)
        self.assertIn(b"choose another `name`", body)
        self.assertNotIn(str(folder).encode(), body)

    def test_kill_costs_at_most_the_open_chunk(self):
        fusion = self.cell()
        send("POST", fusion.url + "recordings/", b'{"name": "walk"}')
        wait_for("some seconds are written", lambda: get_json(fusion.url + "recordings/walk")["frames"] > 800)
        newest = int(get_json(fusion.url + "frame")["capturedNanoseconds"])
        fusion.child.kill()
        fusion.child.wait()
        file, = (self.at / "rec/walk").glob("*.mcap")
        frames = self.fused_frames(file)
        lost = (newest - int(frames[-1]["capturedNanoseconds"])) / 1e9
        # 800 frames of four streams take 7 s or more: a chunk that stayed open would cost them all.
        self.assertLess(lost, 4.0, "a chunk is closed after a second of recording")
        self.assertGreater(len(frames), 60)
        self.fuse(file, "a.mcap")
        # The next run of the service knows what happened.
        after = self.fusion({}, wait=False, **{"recording.folder": self.at / "rec"})
        report = wait_for("the list", lambda: get_json(after.url + "recordings/walk"))
        self.assertEqual(report["state"], "interrupted")
        self.assertEqual(report["bytes"], file.stat().st_size)

    def test_a_folder_that_cannot_be_written_is_told_and_harms_nothing(self):
        fusion = self.cell(**{"recording.folder": "/proc/nowhere"})
        status, _, body = send("POST", fusion.url + "recordings/")
        self.assertGreaterEqual(status, 500)
        self.assertIn(b"cannot be made", body)
        self.assertNotIn(b"/proc/nowhere", body, "no answer names a path of the host")
        before = get_json(fusion.url + "frame")["sequence"]
        wait_for("fusion goes on", lambda: get_json(fusion.url + "frame")["sequence"] > before + 10)


if __name__ == "__main__":
    unittest.main()
