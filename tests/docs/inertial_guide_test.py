"""Every `chorus` line of docs/guide/inertial.md runs as printed, on a made-up walk with five sensors whose tracker bends the left
shank wrongly from 14 to 16 s; the report names that limb and no other."""

import json
import math
import os
import random
import re
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
from ports import free_ports  # noqa: E402

PATIENCE_S = 120
BIN = Path(os.environ.get("CHORUS_BIN", ROOT / "build/dev/bin"))
GUIDE = ROOT / "docs/guide/inertial.md"
BLOCK = re.compile(r"^```sh\n(.*?)^```", re.DOTALL | re.MULTILINE)
TRC_WITHOUT_NAMES = "\n".join((
    "PathFileType\t4\t(X/Y/Z)\tother.trc", "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames",
    "100\t100\t2\t2\tmm\t100\t1\t2", "Frame#\tTime\tAlpha\t\t\tBeta\t\t", "\t\tX1\tY1\tZ1\tX2\tY2\tZ2", "",
    "1\t0.00\t1\t2\t3\t4\t5\t6", "2\t0.01\t1\t2\t3\t4\t5\t6", ""))
LENGTH, WRONG = 20.0, (14.0, 16.0)
SENSORS = {  # column of the table: (from, to, hinge, other), heading [rad], mount (w, x, y, z)
    "femur_l_imu": (("HipLeft", "KneeLeft", "KneeLeft", "AnkleLeft"), 0.7, (0.5, 0.5, 0.5, 0.5)),
    "tibia_l_imu": (("KneeLeft", "AnkleLeft", "KneeLeft", "HipLeft"), -1.1, (0.8, 0.0, 0.6, 0.0)),
    "femur_r_imu": (("HipRight", "KneeRight", "KneeRight", "AnkleRight"), 2.0, (0.6, 0.8, 0.0, 0.0)),
    "tibia_r_imu": (("KneeRight", "AnkleRight", "KneeRight", "HipRight"), 0.1, (0.0, 0.6, 0.8, 0.0)),
    "humerus_r_imu": (("ShoulderRight", "ElbowRight", "ElbowRight", "WristRight"), -2.5, (0.5, -0.5, 0.5, 0.5)),
}


def mul(a, b):
    w, x, y, z = a
    v, p, q, r = b
    return (w * v - x * p - y * q - z * r, w * p + x * v + y * r - z * q, w * q - x * r + y * v + z * p,
            w * r + x * q - y * p + z * v)


def conj(q):
    return (q[0], -q[1], -q[2], -q[3])


def sub(a, b):
    return [a[i] - b[i] for i in range(3)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    n = math.sqrt(sum(c * c for c in a))
    return [c / n for c in a]


def frame(joints, row):
    """world_from_limb: +y along the bone, +x across bone and neighbour (common/evaluation/limb_frame.h)."""
    start, end, hinge, other = (joints[name] for name in row)
    y = unit(sub(end, start))
    x = unit(cross(y, sub(other, hinge)))
    z = cross(x, y)
    m = [[x[i], y[i], z[i]] for i in range(3)]
    w = math.sqrt(max(1e-12, 1 + m[0][0] + m[1][1] + m[2][2])) / 2
    if w > 1e-3:
        return (w, (m[2][1] - m[1][2]) / (4 * w), (m[0][2] - m[2][0]) / (4 * w), (m[1][0] - m[0][1]) / (4 * w))
    i = max(range(3), key=lambda k: m[k][k])
    j, k = (i + 1) % 3, (i + 2) % 3
    s = math.sqrt(1 + m[i][i] - m[j][j] - m[k][k]) * 2
    q = [0.0] * 4
    q[0], q[i + 1], q[j + 1], q[k + 1] = (m[k][j] - m[j][k]) / s, s / 4, (m[j][i] + m[i][j]) / s, (m[k][i] + m[i][k]) / s
    return tuple(q)


def body(t, wrong=False):
    """A person who lifts, bends and turns the limbs in several directions."""
    joints = {"SpineBase": [0, 1, 0], "SpineMid": [0, 1.25, 0], "SpineShoulder": [0, 1.5, 0], "Neck": [0, 1.6, 0],
              "Head": [0, 1.75, 0]}
    for side, s in (("Left", 1), ("Right", -1)):
        hip = [0.1 * s, 0.95, 0]
        swing = 0.6 * math.sin(1.9 * t + s)
        aside = 0.35 * math.sin(1.3 * t + 0.5 * s) * s
        bend = 0.9 + 0.5 * math.sin(2.3 * t + 2 * s)
        knee = [hip[0] + 0.42 * math.sin(aside), hip[1] - 0.42 * math.cos(swing) * math.cos(aside),
                hip[2] + 0.42 * math.sin(swing) * math.cos(aside)]
        lower = swing - bend - (1.0 if wrong and s == 1 else 0.0)
        ankle = [knee[0] + 0.4 * math.sin(aside), knee[1] - 0.4 * math.cos(lower) * math.cos(aside),
                 knee[2] + 0.4 * math.sin(lower) * math.cos(aside)]
        lift = 0.9 + 0.6 * math.sin(1.7 * t + s)
        out = 0.5 * math.sin(1.1 * t) * s
        elbow = [0.2 * s + 0.3 * math.sin(out), 1.45 - 0.3 * math.cos(lift) * math.cos(out), 0.3 * math.sin(lift) * math.cos(out)]
        wrist = [elbow[0] - 0.12 * s * math.cos(t), elbow[1] + 0.2, elbow[2] + 0.15]
        joints.update({f"Hip{side}": hip, f"Knee{side}": knee, f"Ankle{side}": ankle, f"Shoulder{side}": [0.2 * s, 1.45, 0],
                       f"Elbow{side}": elbow, f"Wrist{side}": wrist})
    return joints


def write_tracking(file, wrong):
    lines = []
    for i in range(int(LENGTH * 30)):
        t = i / 30
        joints = body(t, wrong and WRONG[0] <= t <= WRONG[1])
        ns = str(1795246200000000000 + round(t * 1e9))
        placed = {name: {"x": round(p[0], 4), "y": round(p[1], 4), "z": round(p[2], 4), "state": "Tracked"}
                  for name, p in joints.items()}
        lines.append(json.dumps({"@type": "Frame", "sequence": i + 1, "capturedNanoseconds": ns, "source": "fusion",
                                 "space": "WorldSpace", "sensors": ["s1"],
                                 "bodies": [{"bodyId": 1, "capturedNanoseconds": ns, "joints": placed}]}))
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_reference(folder, from_s=3.0, speed=1.0):
    """vicon.c3d: the truth, begun later, in a world that is turned and elsewhere."""
    lines = []
    for i in range(int((LENGTH - 3) * 100)):
        joints = body(from_s + speed * i / 100)
        ns = str(1500000000000000000 + i * 10_000_000)
        placed = {name: {"x": round(0.8 * p[0] + 0.6 * p[2] + 2, 4), "y": round(p[1], 4), "z": round(0.8 * p[2] - 0.6 * p[0] - 1, 4),
                         "state": "Tracked"} for name, p in joints.items()}
        lines.append(json.dumps({"@type": "Frame", "sequence": i + 1, "capturedNanoseconds": ns, "source": "fusion",
                                 "space": "WorldSpace", "sensors": ["v"],
                                 "bodies": [{"bodyId": 1, "capturedNanoseconds": ns, "joints": placed}]}))
    (folder / "vicon.ndjson").write_text("\n".join(lines) + "\n", encoding="utf-8")
    subprocess.run([BIN / "chorus", "export", "vicon.ndjson", "--format", "c3d", "--out", "vicon.c3d"], cwd=folder, check=True,
                   capture_output=True)


def write_sensors(file):
    z_up = conj((0.5, -0.5, -0.5, -0.5))
    rows = ["DataRate=100.000000", "DataType=Quaternion", "version=3", "endheader", "\t".join(["time", *SENSORS])]
    for i in range(int(LENGTH * 100)):
        joints = body(i / 100 + 0.08)  # the sensors' clock is 80 ms behind
        cells = [f"{i / 100:.3f}"]
        for row, heading, mount in SENSORS.values():
            turned = (math.cos(heading / 2), 0, -math.sin(heading / 2), 0)
            q = mul(z_up, mul(turned, mul(frame(joints, row), mount)))
            cells.append(",".join(f"{part:.7f}" for part in q))
        rows.append("\t".join(cells))
    file.write_text("\n".join(rows) + "\n", encoding="utf-8")


def guide_parts():
    """The lines that work on files, and those of the live service."""
    text = GUIDE.read_text(encoding="utf-8")
    before, live = text.split("<!-- live -->")
    lines = [line for block in BLOCK.findall(before + live.split("```", 2)[2]) for line in block.splitlines() if line.startswith("chorus ")]
    return lines, BLOCK.findall(live)[0].splitlines()


class InertialGuide(unittest.TestCase):
    def test_every_line_does_what_it_says(self):
        lines, _ = guide_parts()
        self.assertGreaterEqual(len(lines), 5)
        paths = {**os.environ, "PATH": f"{BIN.resolve()}:{os.environ['PATH']}"}
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            write_tracking(folder / "walk.ndjson", wrong=True)
            write_tracking(folder / "calm.ndjson", wrong=False)
            write_sensors(folder / "suit.sto")
            write_reference(folder)
            (folder / "ann.csv").write_text("limb,begin_s,end_s\nShankLeft,14,16\n", encoding="utf-8")
            (folder / "bob.csv").write_text("limb,begin_s,end_s\nShankLeft,14.2,15.8\n", encoding="utf-8")
            for line in lines:
                with self.subTest(line=line):
                    done = subprocess.run(["bash", "-o", "pipefail", "-c", line], cwd=folder, env=paths,
                                          capture_output=True, text=True, timeout=60)
                    bad = line.startswith("chorus evaluate") and "--most 100" not in line  # a limb is in error
                    self.assertEqual(done.returncode, 1 if bad else 0, done.stderr + done.stdout)
            self.judge(json.loads((folder / "judged/evaluation.json").read_text(encoding="utf-8")))
            page = (folder / "scored/evaluation.html").read_text(encoding="utf-8")
            self.assertIn("kappa of both", page)
            whole = json.loads((folder / "whole/evaluation.json").read_text(encoding="utf-8"))
            self.assertTrue(whole["subject"]["judged"].startswith("0.0 s"), whole["subject"])
            self.assertIn("made from the take up to", json.dumps(whole))
            self.referee(json.loads((folder / "refereed/evaluation.json").read_text(encoding="utf-8")), folder)
            self.refusals(folder, paths)

    def referee(self, report, folder):
        figures = {f["key"]: f.get("value") for section in report["sections"] for f in section["figures"]}
        self.assertEqual(figures["left_shank.sensor_right"], 100)
        self.assertEqual(figures["left_shank.tracker_right"], 0)
        for limb in ("left_thigh", "left_shank", "right_thigh", "right_shank", "right_upper_arm"):
            self.assertLess(figures[f"{limb}.tracker_error"], 3, limb)
            self.assertLess(figures[f"{limb}.sensor_error"], 6, limb)
        self.assertIn("the tracker errs in 1, the sensor in 0, both in 0", report["verdict"])
        table = (folder / "refereed/evaluation.csv").read_text(encoding="utf-8")
        self.assertIn("left_shank.sensor_error", table)
        self.assertIn("left_shank.position_error", table)
        page = (folder / "refereed/evaluation.html").read_text(encoding="utf-8")
        self.assertIn("Who is right", page)
        self.assertIn("left shank: position error of the tracker", page)
        # The shank swings: the sensor shows it without a reference, and positions with one.
        self.assertGreater(figures["left_shank.faults_by_orientation"], 0.95)
        self.assertGreater(figures["left_shank.faults_by_position"], 0.95)
        self.assertNotIn("right_shank.faults_by_position", {k for k, v in figures.items() if v is not None})
        for limb in ("left_thigh", "left_shank", "right_thigh", "right_shank", "right_upper_arm"):
            self.assertLess(figures[f"{limb}.position_error"], 30, limb)

    def refusals(self, folder, paths):
        """A reference that cannot serve is refused, with what to do."""
        (folder / "other.trc").write_text(TRC_WITHOUT_NAMES, encoding="utf-8")
        (folder / "vicon.c3d").rename(folder / "inches.c3d")
        write_reference(folder, speed=0.0)  # somebody who stands
        for reference, more, said in (("vicon.c3d", [], "do not move alike"), ("other.trc", [], "other.joints.txt lists the file's names"),
                                      ("none.c3d", [], "none.c3d"), ("vicon.c3d", ["--reference-unit", "ell"], "\"ell\" is neither a unit"),
                                      ("walk.ndjson", ["--reference-unit", "mm"], "is for motion files"),
                                      ("inches.c3d", ["--reference-unit", "in"], "has bones 25.4 times as long as the tracker's")):
            done = subprocess.run(["chorus", "evaluate", "--tracking", "walk.ndjson", "--inertial", "suit.sto", "--reference", reference, *more,
                                   "--most", "100", "--out", "refused"], cwd=folder, env=paths, capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual(done.returncode, 1)
            self.assertIn(said, done.stderr)
        self.assertTrue((folder / "refused/other.joints.txt").exists())

    def judge(self, report):
        figures = {f["key"]: f for section in report["sections"] for f in section["figures"]}
        self.assertGreater(figures["left_shank.in_error"]["value"], 10)
        for limb in ("left_thigh", "right_thigh", "right_shank", "right_upper_arm"):
            self.assertLess(figures[f"{limb}.in_error"]["value"], 5, limb)
            self.assertLess(figures[f"{limb}.noise"]["value"], 10, limb)
        self.assertEqual(report["judgement"], "bad")
        clocks = report["subject"]["clocks"]
        self.assertAlmostEqual(float(re.search(r"sensors ([+-][\d.]+)", clocks).group(1)), 80, delta=12)


class RealReference(unittest.TestCase):
    """Real sensors and a real C3D of one walk (Sy et al. 2020: Xsens, Vicon; never shipped).  The tracker is what Vicon's table says of
    the joints, with noise; from 5 to 6 s its left shank swings ahead."""

    FOLDER = Path(os.environ.get("CHORUS_SHARED", ROOT.parent / "shared")) / "data/gait_imu_vicon"
    JOINTS = {"SpineBase": 0, "HipLeft": 3, "KneeLeft": 6, "AnkleLeft": 9, "FootLeft": 12, "HipRight": 15, "KneeRight": 18, "AnkleRight": 21,
              "FootRight": 24}
    WORN = {"L_UpLeg": "femur_l_imu", "R_UpLeg": "femur_r_imu", "L_LowLeg": "tibia_l_imu", "R_LowLeg": "tibia_r_imu"}

    def numbers(self, name):
        lines = (self.FOLDER / "data/sample" / name).read_text(encoding="utf-8").splitlines()
        return [[float(cell) for cell in line.split(",")] for line in lines if line[:1] in "-0123456789"]

    def write_tracker(self, file):
        """Every third row, in our axes: +y up."""
        draw = random.Random(1)
        lines = []
        for i, row in list(enumerate(self.numbers("vicon/S02-Trial-Walk-1.csv")))[::3]:
            joints = {name: [row[at + 1], row[at + 2], row[at]] for name, at in self.JOINTS.items()}
            if 5 <= i / 100 <= 6:
                knee, ankle = joints["KneeLeft"], joints["AnkleLeft"]
                joints["AnkleLeft"] = [knee[0] + (ankle[1] - knee[1]), knee[1] - (ankle[0] - knee[0]), ankle[2]]
            ns = str(1795246200000000000 + i * 10_000_000)
            placed = {name: {axis: round(p[k] + draw.gauss(0, 0.005), 4) for k, axis in enumerate("xyz")} | {"state": "Tracked"}
                      for name, p in joints.items()}
            lines.append(json.dumps({"@type": "Frame", "sequence": i + 1, "capturedNanoseconds": ns, "source": "fusion", "space": "WorldSpace",
                                     "sensors": ["s1"], "bodies": [{"bodyId": 1, "capturedNanoseconds": ns, "joints": placed}]}))
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")

    def write_suit(self, file):
        tables = {sensor: self.numbers(f"imu/S02-Trial-Walk-1-{name}.csv") for name, sensor in self.WORN.items()}
        rows = ["DataRate=100.000000", "DataType=Quaternion", "version=3", "endheader", "\t".join(["time", *tables])]
        for i in range(min(map(len, tables.values()))):
            rows.append("\t".join([f"{i / 100:.3f}", *(",".join(f"{part:.6f}" for part in table[i][:4]) for table in tables.values())]))
        file.write_text("\n".join(rows) + "\n", encoding="utf-8")

    def test_positions_and_orientations_of_a_real_walk(self):
        if not self.FOLDER.is_dir():
            self.skipTest("runs where ../shared/data stands beside the checkout")
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            self.write_tracker(folder / "walk.ndjson")
            self.write_suit(folder / "suit.sto")
            done = subprocess.run([BIN / "chorus", "evaluate", "--tracking", "walk.ndjson", "--inertial", "suit.sto", "--from-start", "--same-clock",
                                   "--reference", self.FOLDER / "S02-Trial-Walk-1-vicon.c3d", "--most", "100", "--out", "real"],
                                  cwd=folder, capture_output=True, text=True, timeout=120, check=False)
            self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
            report = json.loads((folder / "real/evaluation.json").read_text(encoding="utf-8"))
        figures = {f["key"]: f.get("value") for section in report["sections"] for f in section["figures"]}
        for limb in ("left_shank", "right_shank"):
            self.assertLess(figures[f"{limb}.position_error"], 25, limb)
            self.assertLess(figures[f"{limb}.tracker_error"], 3, limb)
            self.assertLess(figures[f"{limb}.sensor_error"], 12, limb)
        self.assertGreater(figures["left_shank.faults_by_orientation"], 0.95)
        self.assertGreater(figures["left_shank.faults_by_position"], 0.95)
        self.assertEqual(figures["left_shank.sensor_right"], 100)


class LiveService(unittest.TestCase):
    """The lines of "Live" run on free ports until the slipped sensor is told; it slips later, and the recording is longer, than printed."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        printed = ("8080", "8081", "8091", "8092")
        first = free_ports(len(printed))
        self.ports = {port: str(first + i) for i, port in enumerate(printed)}
        self.paths = {**os.environ, "PATH": f"{BIN.resolve()}:{os.environ['PATH']}", "XDG_STATE_HOME": self.folder.name}
        self.started = []

    def adapted(self, line):
        # On a busy machine every sensor is calibrated later, and one that slipped before is told of never.
        line = line.replace("slips_after_s=20", "slips_after_s=40").replace("--seconds 30", "--seconds 50")
        return re.sub(r"\b80\d\d\b", lambda port: self.ports[port.group(0)], line)

    def start(self, line):
        process = subprocess.Popen(["bash", "-c", "exec " + line.removesuffix("&")], cwd=self.folder.name, env=self.paths,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.terminate)
        self.started.append(process)

    def said(self, line, until, patience=PATIENCE_S):
        """The output of the line, once it contains the text."""
        end = time.monotonic() + patience
        while True:
            done = subprocess.run(["bash", "-c", line], cwd=self.folder.name, env=self.paths, capture_output=True, text=True,
                                  timeout=patience, check=False)
            if (done.returncode == 0 and re.search(until, done.stdout)) or time.monotonic() > end:
                return done.stdout + done.stderr
            time.sleep(0.3)

    def test_a_slipped_sensor_is_told(self):
        _, lines = guide_parts()
        patterns = iter((r"left forearm off by \d+ deg for \d+ s", '"state": *"off"', '"ForearmLeft"', '"heading"'))
        for line in map(self.adapted, lines):
            if line.startswith("chorus record"):  # once there is something to record
                self.said(f"curl -sf http://127.0.0.1:{self.ports['8080']}/frame", "Skeleton")
                self.said(f"curl -sf http://127.0.0.1:{self.ports['8091']}/orientations", "Orientations")
            if line.endswith("&"):
                self.start(line)
            elif line.startswith("chorus evaluate"):
                self.started[-1].wait(PATIENCE_S)
                self.assertIn("left forearm", self.said(line, "left forearm", 20))
            else:
                pattern = next(patterns)
                self.assertRegex(self.said(line, pattern), pattern)
        self.conforms("evaluation", "LimbEvaluation")
        self.conforms("evaluation/segments", "ErrorSegment")
        report = json.loads((Path(self.folder.name) / "live/evaluation.json").read_text(encoding="utf-8"))
        figures = {f["key"]: f["value"] for section in report["sections"] for f in section["figures"]}
        self.assertGreater(figures["left_forearm.in_error"], 5)
        self.assertLess(figures["right_forearm.in_error"], 5)

    def conforms(self, path, name):
        """What is served as Turtle conforms to the shapes."""
        url = f"http://127.0.0.1:{self.ports['8092']}/{path}"
        turtle = subprocess.run(["curl", "-s", "-H", "Accept: text/turtle", url], capture_output=True, text=True, check=True).stdout
        done = subprocess.run(["node", str(ROOT / "tests/support/conforms.mjs"), url, name], input=turtle, capture_output=True, text=True,
                              cwd=ROOT / "tests", check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr + turtle)


if __name__ == "__main__":
    unittest.main()
