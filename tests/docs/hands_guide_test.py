"""The line of docs/guide/hands.md that needs nothing but the repository runs as printed, and gives the hand that was drawn."""

import json
import math
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BIN = Path(os.environ["CHORUS_BIN"])
PAGE = (ROOT / "docs/guide/hands.md").read_text(encoding="utf-8")
LINE = "chorus scan tests/data/hand/scan.png --paper a4 --out hand.bvh"
TRUTH = json.loads((ROOT / "tests/data/hand/truth.json").read_text(encoding="utf-8"))
SCAN = ROOT / "tests/data/hand/scan.png"
SUIT = ROOT / "tests/data/suit"
MOST_TIP_PX = 2.0 / TRUTH["mmPerPixel"]


MOST_GLOVE_M = 0.015


def wrists(bvh):
    """The root's channels [m]."""
    rows = bvh.split("Frame Time:")[1].splitlines()[1:]
    return [[float(value) / 100.0 for value in row.split()[:3]] for row in rows if row.strip()]


def scan(folder, *more):
    paths = {**os.environ, "PATH": f"{BIN.resolve()}:{os.environ['PATH']}"}
    line = " ".join([LINE.replace("--out hand.bvh", f"--out {folder}/hand.bvh"), *more])
    return subprocess.run(["bash", "-c", line], cwd=ROOT, env=paths, capture_output=True, text=True, timeout=100, check=False)


class HandsGuide(unittest.TestCase):
    def test_the_line_for_the_shipped_scan_gives_the_hand_that_was_drawn(self):
        self.assertIn(LINE, re.sub(r"\s+", " ", PAGE))
        with tempfile.TemporaryDirectory() as folder:
            done = scan(folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("the picture is a whole sheet of A4", done.stdout)
            hand = json.loads(Path(folder, "hand.json").read_text(encoding="utf-8"))
            self.assertEqual((hand["side"], hand["seen"], hand["relative"]), (TRUTH["side"], TRUTH["seen"], False))
            self.assertAlmostEqual(hand["scale"]["mmPerPixel"], TRUTH["mmPerPixel"], delta=0.001)
            for name, truth in TRUTH["fingers"].items():
                found = hand["fingers"][name]
                self.assertLess(math.dist(found["tip"], truth["tip"]), MOST_TIP_PX, name)
                self.assertAlmostEqual(found["fromWebMm"] / truth["fromWebMm"], 1.0, delta=0.05, msg=name)
            bvh = Path(folder, "hand.bvh").read_text(encoding="utf-8")
            self.assertEqual(bvh.count("JOINT RightHand"), 15)
            self.assertGreater(Path(folder, "hand.annotated.png").stat().st_size, 10_000)

    def test_a_folder_of_scans_is_scanned_into_itself_and_again(self):
        with tempfile.TemporaryDirectory() as folder:
            scan = Path(folder, "hand.png")
            shutil.copy(SCAN, scan)
            line = [BIN / "chorus", "scan", folder, "--paper", "a4", "--no-network", "--out", folder]
            for _ in range(2):
                done = subprocess.run(line, capture_output=True, text=True, timeout=60, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(scan.read_bytes(), SCAN.read_bytes(), "the user's picture stays")
            self.assertEqual(sorted(p.name for p in Path(folder).iterdir()), ["hand.annotated.png", "hand.bvh", "hand.json", "hand.png"])

    def test_a_glove_is_put_where_the_camera_saw_it(self):
        line = "chorus glove glove.avi take.bvh --hand hand.json --intrinsics lens.json --out placed.bvh"
        self.assertIn(line, PAGE)
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([BIN / "chorus-drawn-hand", "glove", folder], check=True, timeout=60)
            paths = {**os.environ, "PATH": f"{BIN.resolve()}:{os.environ['PATH']}"}
            done = subprocess.run(["bash", "-c", line], cwd=folder, env=paths, capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("found in 40 of 40 pictures", done.stdout)
            self.assertNotIn("doubt:", done.stdout)
            found, truth = (wrists(Path(folder, name).read_text(encoding="utf-8")) for name in ("placed.bvh", "truth.bvh"))
            self.assertEqual(len(found), len(truth))
            rms = math.sqrt(sum(math.dist(a, b) ** 2 for a, b in zip(found, truth)) / len(truth))
            print(f"glove: {1000 * rms:.1f} mm rms")
            self.assertLess(rms, MOST_GLOVE_M)
            # The true take tells the size; a hand scanned 4 % too large does not fit it.
            hand = json.loads(Path(folder, "hand.json").read_text(encoding="utf-8"))
            for scale, said in ((1.0, "size fits"), (1.04, "size is wrong")):
                wrong = {**hand, "restMm": [[scale * v for v in p] for p in hand["restMm"]], "palmMm": [scale * v for v in hand["palmMm"]],
                         "palmRadiusMm": scale * hand["palmRadiusMm"]}
                Path(folder, "wrong.json").write_text(json.dumps(wrong), encoding="utf-8")
                done = subprocess.run([BIN / "chorus", "glove", "glove.avi", "truth.bvh", "--hand", "wrong.json", "--intrinsics", "lens.json",
                                       "--placed", "--out", "x.bvh"], cwd=folder, capture_output=True, text=True, timeout=60, check=False)
                self.assertIn(said, done.stdout, done.stderr)

    def test_a_video_without_a_glove_is_doubted_and_the_hands_file_is_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([BIN / "chorus-drawn-hand", "glove", folder], check=True, timeout=60)
            line = [BIN / "chorus", "glove", SUIT / "cam01.mp4", "take.bvh", "--hand", "hand.json", "--intrinsics", SUIT / "lens.json", "--out"]
            done = subprocess.run([*line, "placed.bvh"], cwd=folder, capture_output=True, text=True, timeout=60, check=False)
            self.assertIn("doubt: what is seen is not shaped like the hand", done.stdout, done.stderr)
            done = subprocess.run([*line, "hand.json"], cwd=folder, capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual(done.returncode, 1)
            self.assertIn("is what is read here", done.stderr)

    def test_the_papers_method_is_nameable(self):
        with tempfile.TemporaryDirectory() as folder:
            done = scan(folder, "--method paper")
            self.assertEqual(done.returncode, 0, done.stderr)
            hand = json.loads(Path(folder, "hand.json").read_text(encoding="utf-8"))
            self.assertEqual(hand["method"], "paper")


if __name__ == "__main__":
    unittest.main()
