"""A take of a suit is put where a camera saw the person: from a recording, against the published truth; and every line of
docs/guide/suit.md that needs a video runs as printed where the runner is installed."""

import json
import math
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BIN = Path(os.environ["CHORUS_BIN"])
RUNNER = ROOT / "services/pose-runner/node_modules"
PAGE = (ROOT / "docs/guide/suit.md").read_text(encoding="utf-8")
SUIT = "tests/data/suit"
MOST_RMS_M = 0.25  # one camera, a suit that stands in for a real one


def run(*words, **more):
    return subprocess.run([str(word) for word in words], cwd=ROOT, capture_output=True, text=True, timeout=280, check=False, **more)


def hips(text):
    """The channels of the root of a BVH file [m]."""
    rows = text.split("Frame Time:")[1].splitlines()[1:]
    return [[float(value) / 100.0 for value in row.split()[:3]] for row in rows if row.strip()]


def true_hips(file):
    out = []
    for line in file.read_text(encoding="utf-8").splitlines():
        joint = json.loads(line)["bodies"][0]["joints"]["SpineBase"]
        out.append([joint["x"], joint["y"], joint["z"]])
    return out


class SuitGuide(unittest.TestCase):
    def test_a_recording_and_a_take_give_the_path_of_the_person(self):
        with tempfile.TemporaryDirectory() as folder:
            made = run(BIN / "chorus", "import", "pose2sim", "tests/data/pose2sim_mediapipe", "--out", f"{folder}/rec", "--rays")
            self.assertEqual(made.returncode, 0, made.stderr)
            done = run(BIN / "chorus", "position", f"{folder}/rec/cam01.mcap", f"{SUIT}/walk.bvh", "--place", f"{SUIT}/place.json",
                       "--search", "0.3", "--rate", "60", "--out", f"{folder}/out")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("wrote corrected.bvh", done.stdout)
            report = json.loads(Path(folder, "out/report.json").read_text(encoding="utf-8"))
            self.assertEqual(report["kind"], "position")
            found = hips(Path(folder, "out/corrected.bvh").read_text(encoding="utf-8"))
            truth = true_hips(Path(folder, "rec/truth.ndjson"))
            self.assertGreater(len(found), 0.9 * len(truth))
            truth = truth[len(truth) - len(found):]
            rms = math.sqrt(sum(math.dist(a, b) ** 2 for a, b in zip(found, truth)) / len(found))
            print(f"one camera and a stand-in suit: {1000 * rms:.0f} mm rms")
            self.assertLess(rms, MOST_RMS_M)
            moved = math.dist(found[0], found[-1])
            self.assertGreater(moved, 0.3, "the take had no path; the camera gave it one")

    def test_mistakes_are_told_by_name(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        wide = Path(folder.name, "wide.json")
        wide.write_text('{"width": 640, "height": 480, "fx": 500, "fy": 500, "cx": 320, "cy": 240}', encoding="utf-8")
        video = [f"{SUIT}/cam01.mp4", f"{SUIT}/walk.bvh", "--place", f"{SUIT}/place.json", "--intrinsics", f"{SUIT}/lens.json", "--out", "x"]
        for words, said in [
                (["position", *video, "--method", "magic"], "magic"),
                (["position", *video, "--method", "suit", "--start", "1;2"], "x,z in metres"),
                (["position", *video, "--method", "outline", "--background", "network"], "--method both"),
                (["position", *video, "--method", "suit", "--clock-offset", "3600"], "covers 0.0 s"),
                (["position", *video[:4], "--intrinsics", wide, "--out", "x", "--method", "outline"], "another part of the view"),
                (["position", f"{SUIT}/walk.bvh", "--place", f"{SUIT}/place.json", "--out", "x"], "a video is missing"),
                (["position", f"{SUIT}/cam01.mp4", "--place", f"{SUIT}/place.json", "--out", "x"], "a take of the suit is missing"),
                (["position", f"{SUIT}/cam01.mp4", f"{SUIT}/walk.bvh", "--place", f"{SUIT}/place.json", "--out", "x"], "--intrinsics"),
                (["calibrate", "place", "--intrinsics", f"{SUIT}/lens.json"], "--mark"),
                (["calibrate", "place", "--intrinsics", f"{SUIT}/lens.json", "--mark", "1,2=3"], "u,v=x,z")]:
            with self.subTest(words=words):
                done = run(BIN / "chorus", *words)
                self.assertNotEqual(done.returncode, 0)
                self.assertIn(said, done.stderr)

    @unittest.skipUnless(RUNNER.exists(), "runs after npm ci in services/pose-runner/")
    def test_the_line_with_a_video_does_what_the_page_says(self):
        line = next(each for block in re.findall(r"^```sh\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE) for each in block.splitlines()
                    if each.startswith("chorus position"))
        with tempfile.TemporaryDirectory() as folder:
            paths = {**os.environ, "PATH": f"{BIN.resolve()}:{os.environ['PATH']}"}
            done = run("bash", "-c", line.replace("--out out", f"--out {folder}/out"), env=paths)
            self.assertEqual(done.returncode, 0, done.stderr)
            for name in ("corrected.bvh", "position.mcap", "report.html", "report.json"):
                self.assertTrue(Path(folder, "out", name).exists(), name)


if __name__ == "__main__":
    unittest.main()
