"""chorus import and fuse as users run them: from the shipped recordings to fused frames."""

import json
import statistics
import subprocess
import tempfile
import unittest
from pathlib import Path

from chorus_program import BIN, CAMERAS, chorus

PLAIN_MEAN_M = 0.104  # fusion must be better than this (tests/data/README.md)
SETTINGS = ["--config", f"{CAMERAS}/fusion.json"]


def frames_of(file):
    return [json.loads(line) for line in Path(file).read_text().splitlines()]


def median_error(fused, truth):
    """Median error over all joints of all frames with a truth at exactly the same instant [m]."""
    truth_at = {frame["capturedNanoseconds"]: frame["bodies"][0]["joints"] for frame in truth}
    errors = []
    for frame in fused:
        wanted = truth_at.get(frame["capturedNanoseconds"])
        for body in frame["bodies"] if wanted else []:
            for name, joint in body["joints"].items():
                if "x" in joint and "x" in wanted.get(name, {}):
                    errors.append(sum((joint[axis] - wanted[name][axis]) ** 2 for axis in "xyz") ** 0.5)
    return statistics.median(errors), len(errors)


def unsteadiness(frames):
    """Mean size of the second difference of the joints from frame to frame [m]."""
    sizes = []
    for three in zip(frames, frames[1:], frames[2:]):
        for name, joint in three[1]["bodies"][0]["joints"].items():
            a, c = (frame["bodies"][0]["joints"][name] for frame in three[::2])
            if all("x" in each for each in (a, joint, c)):
                sizes.append(sum((a[axis] - 2 * joint[axis] + c[axis]) ** 2 for axis in "xyz") ** 0.5)
    return statistics.mean(sizes)


class Offline(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.at = Path(cls.folder.name)
        cls.recordings = cls.at / "cameras"
        cls.imported = chorus("import", "pose2sim", CAMERAS, "--out", cls.recordings, "--json")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def fuse(self, out, *options):
        return chorus("fuse", self.recordings, "--out", self.at / out, *options)

    def test_import_reports_what_it_wrote(self):
        code, out, _ = self.imported
        self.assertEqual(code, 0)
        report = json.loads(out)
        self.assertEqual([r["sensor"] for r in report["recordings"]], ["cam01", "cam02", "cam03", "cam04"])
        self.assertEqual({r["frames"] for r in report["recordings"]}, {100})
        for file in report["files"]:
            self.assertTrue(Path(file).is_file(), file)
        registration = json.loads((self.recordings / "registration.json").read_text())
        self.assertEqual(set(registration["sensors"]), {"cam01", "cam02", "cam03", "cam04"})
        self.assertEqual(len(frames_of(self.recordings / "truth.ndjson")), 100)

    def test_importing_twice_gives_the_same_bytes(self):
        again = self.at / "again"
        self.assertEqual(chorus("import", "pose2sim", CAMERAS, "--out", again)[0], 0)
        for file in sorted(self.recordings.iterdir()):
            self.assertEqual(file.read_bytes(), (again / file.name).read_bytes(), file.name)

    def test_fusing_with_published_extrinsics_beats_the_plain_mean_twice_with_the_same_bytes(self):
        given = [*SETTINGS, "--registration", self.recordings / "registration.json"]
        for out in ("a.ndjson", "b.ndjson"):
            self.assertEqual(self.fuse(out, *given)[0], 0)
        self.assertEqual((self.at / "a.ndjson").read_bytes(), (self.at / "b.ndjson").read_bytes())
        error, joints = median_error(frames_of(self.at / "a.ndjson"), frames_of(self.recordings / "truth.ndjson"))
        self.assertGreater(joints, 1000)
        self.assertLess(error, PLAIN_MEAN_M / 2)

    def test_every_method_answers_and_the_worse_ones_are_worse(self):
        given = [*SETTINGS, "--registration", self.recordings / "registration.json"]
        truth = frames_of(self.recordings / "truth.ndjson")
        error = {}
        for method in ("otto", "mean", "best-view", "inverse-variance"):
            self.assertEqual(self.fuse(f"{method}.ndjson", *given, "--method", method)[0], 0, method)
            error[method], _ = median_error(frames_of(self.at / f"{method}.ndjson"), truth)
        self.assertEqual(min(error, key=error.get), "inverse-variance", error)

    def test_registering_from_the_person_alone_is_deterministic_and_reported(self):
        code, out, error = self.fuse("own.ndjson", *SETTINGS, "--json", "--save-registration", self.at / "own.json")
        self.assertEqual((code, out), (0, ""))
        summary = json.loads(error)
        self.assertEqual(summary["sensors"], 4)
        self.assertEqual(set(summary["registration"]["sensors"]), {"cam01", "cam02", "cam03", "cam04"})
        self.assertIn(summary["registration"]["verdict"], ("Good", "Provisional"))
        self.assertEqual(self.fuse("own2.ndjson", *SETTINGS, "--save-registration", self.at / "own2.json")[0], 0)
        self.assertEqual((self.at / "own.ndjson").read_bytes(), (self.at / "own2.ndjson").read_bytes())
        self.assertEqual((self.at / "own.json").read_bytes(), (self.at / "own2.json").read_bytes())

    def test_frames_go_to_standard_output_alone(self):
        code, out, error = chorus("fuse", self.recordings, "--out", "-", *SETTINGS)
        self.assertEqual(code, 0)
        self.assertEqual({json.loads(line)["@type"] for line in out.splitlines()}, {"Frame"})
        self.assertIn("registration: ", error)

    def test_a_kinect_recording_with_floor_and_start(self):
        source = "tests/data/kinect2_labanotation/Ges04_comehere.csv"
        code, out, _ = chorus("import", "labanotation", source, "--out", self.at / "kinect", "--floor", "0,1,0,0.9",
                              "--start", "2026-11-21T07:30:00Z", "--sensor", "s1")
        self.assertEqual(code, 0)
        self.assertIn("2026-11-21T07:30:00.000000000Z", out)
        self.assertIn("not UTC", out)
        self.assertTrue((self.at / "kinect" / "s1.mcap").is_file())

    def test_smoothing_answers_the_same_instants_more_calmly_and_says_so(self):
        source = "tests/data/kinect2_labanotation/Ges04_comehere.csv"
        self.assertEqual(chorus("import", "labanotation", source, "--out", self.at / "gesture", "--floor", "0,1,0,0.9",
                                "--start", "2026-11-21T07:30:00Z", "--sensor", "s1")[0], 0)
        places = self.at / "places.json"
        places.write_text(json.dumps({"sensors": {"s1": {"x": 0, "y": 0.9, "z": 0, "qx": 0, "qy": 0, "qz": 0, "qw": 1}}}))
        frames = {}
        for out, options in (("causal", []), ("smooth", ["--smooth"]), ("again", ["--smooth"])):
            code, _, error = chorus("fuse", self.at / "gesture", "--registration", places, "--out", self.at / f"{out}.ndjson", *options)
            self.assertEqual(code, 0, error)
            frames[out] = [frame for frame in frames_of(self.at / f"{out}.ndjson") if frame["bodies"]]
        self.assertIn("body-filter, smoothed", error)
        self.assertEqual((self.at / "smooth.ndjson").read_bytes(), (self.at / "again.ndjson").read_bytes())
        self.assertEqual([frame["capturedNanoseconds"] for frame in frames["smooth"]],
                         [frame["capturedNanoseconds"] for frame in frames["causal"]])
        self.assertLess(unsteadiness(frames["smooth"]), 0.9 * unsteadiness(frames["causal"]))
        self.assertTrue(all("smoothedOver" in frame["bodies"][0] for frame in frames["smooth"]))
        self.assertFalse(any("smoothedOver" in frame["bodies"][0] for frame in frames["causal"]))

    def test_bad_input_is_named(self):
        bad = self.at / "bad.csv"
        bad.write_text("1,2,3\n")
        code, _, error = chorus("import", "labanotation", bad, "--out", self.at / "none")
        self.assertEqual(code, 1)
        self.assertIn("bad.csv:1: holds 3 values", error)
        self.assertFalse((self.at / "none").exists(), "nothing is written for a bad input")
        broken = self.at / "broken.mcap"
        broken.write_bytes(b"no recording")
        code, _, error = chorus("fuse", broken, "--out", self.at / "x")
        self.assertEqual(code, 1)
        self.assertIn("broken.mcap", error)
        registration = self.at / "registration.json"
        registration.write_text('{"sensors": {"cam01": {"x": 1}}}')
        code, _, error = self.fuse("x", "--registration", registration)
        self.assertEqual(code, 1)
        self.assertIn("sensors.cam01", error)
        copy = self.recordings / "cam01.mcap"
        code, _, error = chorus("fuse", self.recordings, copy, "--out", self.at / "x")
        self.assertEqual(code, 1)
        self.assertIn("is a recording of sensor cam01, and so is", error)
        code, _, error = self.fuse("no/such/folder/x", *SETTINGS)
        self.assertEqual(code, 1)
        self.assertIn("is its folder there?", error)
        code, _, error = self.fuse("x", "--set", "fusion.metod=otto")
        self.assertEqual(code, 1)
        self.assertIn("metod", error)

    def test_no_input_and_no_recording_is_ever_overwritten(self):
        walk = self.at / "walk.mcap"
        walk.write_bytes((self.recordings / "cam01.mcap").read_bytes())
        link = self.at / "link.ndjson"
        link.symlink_to(walk)
        kept = walk.read_bytes()
        for out, reason in ((walk, "is what is read here"), (link, "is what is read here"),
                            (self.recordings / "cam02.mcap", "never overwritten")):
            code, _, error = chorus("fuse", walk, "--out", out, *SETTINGS)
            self.assertEqual(code, 1, out)
            self.assertIn(reason, error)
            self.assertEqual(walk.read_bytes(), kept, out)
        fused = self.at / "fused.ndjson"
        given = ["--registration", self.recordings / "registration.json"]
        self.assertEqual(self.fuse("fused.ndjson", *SETTINGS, *given)[0], 0)
        code, _, error = chorus("export", fused, "--format", "csv", "--out", fused)
        self.assertEqual(code, 1)
        self.assertIn("is what is read here", error)
        self.assertTrue(frames_of(fused))

    def test_profiles_of_real_sensors_load(self):
        kind = self.at / "kind"
        code, out, error = chorus("characterise", self.recordings, *SETTINGS, "--out", kind)
        self.assertEqual(code, 0, error)
        self.assertIn("as if each erred by", out)
        for program, profile in (("chorus-fusion", "fusion-profile.json"), ("chorus-sensor", "sensor-profile.json")):
            done = subprocess.run([BIN / program, "--config", kind / profile, "--check"], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_damage_is_told_and_stands_in_the_json(self):
        damaged = self.at / "damaged"
        damaged.mkdir()
        for file in self.recordings.glob("*.mcap"):
            (damaged / file.name).write_bytes(file.read_bytes())
        cut = damaged / "cam02.mcap"
        cut.write_bytes(cut.read_bytes()[:-100])
        given = [*SETTINGS, "--registration", self.recordings / "registration.json"]
        _, _, error = chorus("fuse", damaged, "--out", self.at / "damaged.ndjson", *given)
        self.assertIn("note: cam02.mcap: the end is missing", error)
        _, _, error = chorus("fuse", damaged, "--out", self.at / "damaged.ndjson", *given, "--json")
        self.assertEqual(len(json.loads(error)["notes"]), 1)

    def test_recordings_of_an_older_import_are_pointed_out(self):
        stale = self.at / "stale"
        stale.mkdir()
        (stale / "old.mcap").write_bytes(b"")
        _, _, error = chorus("import", "pose2sim", CAMERAS, "--out", stale)
        self.assertIn("old.mcap was there before", error)


if __name__ == "__main__":
    unittest.main()
