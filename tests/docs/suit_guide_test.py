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


def there_and_back(rows, times=8):
    return [row for i in range(times) for row in (rows if i % 2 == 0 else rows[::-1])]


def long_views(folder):
    """The shipped landmarks, forwards and backwards in turn."""
    source = ROOT / "tests/data/pose2sim_mediapipe"
    (folder / "cameras.json").write_bytes((source / "cameras.json").read_bytes())
    for name in ("cam01", "cam02", "cam03", "cam04"):
        view = json.loads((source / f"{name}.json").read_text(encoding="utf-8"))
        step = view["frames"][1]["t_s"] - view["frames"][0]["t_s"]
        view["frames"] = [{**frame, "t_s": i * step} for i, frame in enumerate(there_and_back(view["frames"]))]
        (folder / f"{name}.json").write_text(json.dumps(view), encoding="utf-8")


def bent_suit(file, joint, degrees):
    """The shipped suit as long as that, the bone that ends in `joint` turned about z by a constant."""
    head, motion = (ROOT / SUIT / "walk.bvh").read_text(encoding="utf-8").split("MOTION\n")
    lines = motion.strip().split("\n")
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))

    def turned(match):
        x, y, z = (float(each) for each in match.groups()[1:])
        return f"{match[1]}OFFSET {cosine * x - sine * y:.6f} {sine * x + cosine * y:.6f} {z:.6f}"

    head = re.sub(r"(JOINT " + joint + r"\s*\{\s*)OFFSET (\S+) (\S+) (\S+)", turned, head)
    frames = there_and_back(lines[2:])
    file.write_text(f"{head}MOTION\nFrames: {len(frames)}\n{lines[1]}\n" + "\n".join(frames) + "\n", encoding="utf-8")


def offsets(text):
    """Length of the bone to each joint of a BVH file [m]."""
    found = re.findall(r"JOINT (\w+)\s*\{\s*OFFSET (\S+) (\S+) (\S+)", text)
    return {name: math.hypot(*(float(each) / 100.0 for each in xyz)) for name, *xyz in found}


class SuitGuide(unittest.TestCase):
    def test_what_is_read_is_not_written_over_and_a_camera_below_the_floor_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            take = Path(folder, "corrected.bvh")
            take.write_bytes((ROOT / SUIT / "walk.bvh").read_bytes())
            line = [BIN / "chorus", "position", "--method", "suit", f"{SUIT}/cam01.mp4", take, "--intrinsics", f"{SUIT}/lens.json"]
            done = run(*line, "--place", f"{SUIT}/place.json", "--out", folder)
            self.assertEqual(done.returncode, 1)
            self.assertIn("corrected.bvh in it is what is read here", done.stderr)
            self.assertEqual(take.read_bytes(), (ROOT / SUIT / "walk.bvh").read_bytes())
            places = json.loads((ROOT / SUIT / "place.json").read_text(encoding="utf-8"))
            places["sensors"]["cam01"]["y"] *= -1.0
            Path(folder, "below.json").write_text(json.dumps(places), encoding="utf-8")
            done = run(*line, "--place", f"{folder}/below.json", "--out", f"{folder}/out")
            self.assertIn("cam01 stands 1.90 m below the floor", done.stderr)

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

    def test_size_and_bones_are_found_by_cameras(self):
        # The take of 1.7 s, forwards and backwards eight times; the suit's right shank is bent by 15 degrees.
        with tempfile.TemporaryDirectory() as folder:
            long_views(Path(folder))
            bent_suit(Path(folder, "bent.bvh"), "AnkleRight", 15.0)
            made = run(BIN / "chorus", "import", "pose2sim", folder, "--out", f"{folder}/rec", "--rays")
            self.assertEqual(made.returncode, 0, made.stderr)
            views = [f"{folder}/rec/cam0{i}.mcap" for i in range(1, 5)]
            done = run(BIN / "chorus", "position", *views, f"{folder}/bent.bvh", "--place", f"{SUIT}/place.json", "--search", "0.3", "--method", "landmarks",
                       "--recalibrate", "--size-from", views[2], "--out", f"{folder}/out")
            self.assertEqual(done.returncode, 0, done.stderr)
            size = float(re.search(r"stature (\S+) m", done.stdout).group(1))
            self.assertAlmostEqual(size, 1.62, delta=0.08, msg="the four cameras say 1.57 to 1.65")
            turned = {name: float(by) for name, by in re.findall(r"bone to (\w+): turned by (\S+) degrees", done.stdout)}
            self.assertAlmostEqual(turned.get("AnkleRight", 0.0), 15.0, delta=4.0, msg=done.stdout)
            for right in ("AnkleLeft", "KneeLeft", "KneeRight"):
                self.assertNotIn(right, turned, done.stdout)
            # What was found is in the take.
            shank = offsets(Path(folder, "out/corrected.bvh").read_text(encoding="utf-8"))
            self.assertGreater(shank["AnkleRight"], 0.3)

    def test_a_take_that_ends_early_or_is_damaged_says_so(self):
        with tempfile.TemporaryDirectory() as folder:
            made = run(BIN / "chorus", "import", "pose2sim", "tests/data/pose2sim_mediapipe", "--out", f"{folder}/rec", "--rays")
            self.assertEqual(made.returncode, 0, made.stderr)
            whole = (ROOT / SUIT / "walk.bvh").read_text(encoding="utf-8")
            lines = whole.splitlines()
            begin = next(i for i, line in enumerate(lines) if line.startswith("Frame Time")) + 1
            damaged = [*lines[:begin + 40], "nan " + lines[begin + 40].split(" ", 1)[1], *lines[begin + 41:]]
            for name, text, said in [("cut", "\n".join(lines[:begin + 60]), ["announces 100 frames and holds 60", "has no pose for"]),
                                     ("damaged", "\n".join(damaged), ["1 frames cannot be read"])]:
                with self.subTest(name):
                    Path(folder, f"{name}.bvh").write_text(text + "\n", encoding="utf-8")
                    done = run(BIN / "chorus", "position", f"{folder}/rec/cam01.mcap", f"{folder}/{name}.bvh", "--place", f"{SUIT}/place.json", "--search", "0.3",
                               "--method", "landmarks", "--out", f"{folder}/{name}")
                    self.assertEqual(done.returncode, 0, done.stderr)
                    for each in said:
                        self.assertIn(each, done.stdout)

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
