#!/usr/bin/env python3
"""Learns the weights of PostureCues (fusion-server/facing/posture.h) from real recordings.

    tests/learn/posture_weights.py [FOLDER]     default: $CHORUS_SHARED/data, else ../shared/data

Recordings that may be shipped, of people who face one sensor: Labanotation (MIT), KERAAL (BSD-2),
UI-PRMD (PDDL), Azure Kinect (MIT).  The front is known from the labels.  A logistic regression
without constant on offsets along the front is fitted to (offsets, front) and, implicitly, to (-offsets, rear):
reversing the direction changes the sign and nothing else, and offsets do not depend on the labels
(docs/papers/sides.md). SHARES gives each collection its weight, of which all its recordings get equal parts, whatever their length.
Prints the weights, and for each collection the number of frames and the percentage of them that weights learned from the
other collections get right.
"""

import csv
import glob
import gzip
import math
import os
import sys

CUES = {"knees": 0.05, "wrists": 0.10, "elbows": 0.05, "lean": 0.15}  # [m]; from this offset on, a cue counts fully
SHARES = {"labanotation": 7, "keraal": 2, "azure": 1, "ui-prmd": 10}
RIDGE = 0.02
UPRIGHT, LYING = math.cos(math.radians(45)), math.cos(math.radians(75))  # tilt of the trunk, see upright_share()
KINECT = (
    "SpineBase SpineMid Neck Head ShoulderLeft ElbowLeft WristLeft HandLeft ShoulderRight ElbowRight WristRight HandRight "
    "HipLeft KneeLeft AnkleLeft FootLeft HipRight KneeRight AnkleRight FootRight SpineShoulder HandTipLeft ThumbLeft "
    "HandTipRight ThumbRight"
).split()


def labanotation(folder):
    for path in sorted(glob.glob(f"{folder}/kinect2_labanotation/**/*.csv", recursive=True)):
        frames = []
        for row in csv.reader(open(path)):
            values = [float(value) for value in row if value]
            if len(values) < 101:
                continue
            frames.append({name: values[1 + 4 * i : 4 + 4 * i] for i, name in enumerate(KINECT) if values[4 + 4 * i] > 0})
        yield frames


def keraal(folder):
    for path in glob.glob(f"{folder}/keraal_kinect2_optical/G3-Kinect*.txt"):
        rows = [[float(value) for value in line.split()] for line in open(path)]
        yield [{name: row[7 * i : 7 * i + 3] for i, name in enumerate(KINECT)} for row in rows if len(row) == 175]


def azure(folder):
    centre = {"SpineBase": "PELVIS", "SpineShoulder": "SPINE_CHEST"}
    sides = {
        part + side: f"{part}_{side}".upper()
        for part in ("Shoulder", "Elbow", "Wrist", "Hip", "Knee", "Ankle")
        for side in ("Left", "Right")
    }
    frames = []
    for row in csv.DictReader(gzip.open(f"{folder}/azure_kinect_pymocapviewer/azure_positions.csv.gz", "rt"), delimiter=";"):
        place = lambda name: [float(row[f"{name} ({axis})"]) * factor for axis, factor in zip("xyz", (-0.001, -0.001, 0.001))]
        frames.append({ours: place(name) for ours, name in (centre | sides).items() if float(row[f"{name} (c)"]) > 0})
    yield frames[::6]


UI_JOINTS = (
    "SpineBase SpineMid SpineShoulder Neck Head HeadTip CollarLeft ShoulderLeft ElbowLeft WristLeft CollarRight ShoulderRight "
    "ElbowRight WristRight HipLeft KneeLeft AnkleLeft FootLeft HipRight KneeRight AnkleRight FootRight"
).split()
UI_PARENTS = [-1, 0, 1, 2, 3, 4, 2, 6, 7, 8, 2, 10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20]


def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(len(b[0]))] for i in range(3)]


def turn_about(axis, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return {
        "x": [[1, 0, 0], [0, c, -s], [0, s, c]],
        "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
        "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]],
    }[axis]


def ui_body(places, angles):
    """Forward kinematics: positions in the parent's frame [cm], R = Rz Rx Ry."""
    turns, joints = [], []
    for i, parent in enumerate(UI_PARENTS):
        x, y, z = angles[3 * i : 3 * i + 3]
        turn = times(times(turn_about("z", z), turn_about("x", x)), turn_about("y", y))
        place = [[0.01 * value] for value in places[3 * i : 3 * i + 3]]
        if parent >= 0:
            place = [[a[0] + b[0]] for a, b in zip(joints[parent], times(turns[parent], place))]
            turn = times(turns[parent], turn)
        turns.append(turn)
        joints.append(place)
    return {name: [row[0] for row in place] for name, place in zip(UI_JOINTS, joints)}


def ui_prmd(folder):
    for path in sorted(glob.glob(f"{folder}/uiprmd_kinect_vicon/kinect_positions/*.gz")):
        angles = path.replace("kinect_positions", "kinect_angles").replace("_positions.txt", "_angles.txt")
        rows = list(zip(gzip.open(path, "rt"), gzip.open(angles, "rt")))[::6]
        yield [ui_body(*([float(value) for value in line.split(",")] for line in row)) for row in rows]


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def middle(body, part):
    return [(x + y) / 2 for x, y in zip(body[part + "Left"], body[part + "Right"])]


def off_line(p, a, b):
    line = minus(b, a)
    length = sum(x * x for x in line)
    if length < 1e-4:
        return [0, 0, 0]
    t = min(1, max(0, sum(x * y for x, y in zip(minus(p, a), line)) / length))
    return [x - y - t * z for x, y, z in zip(p, a, line)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [x / max(math.sqrt(dot(a, a)), 1e-9) for x in a]


def left_of(body):
    left = [0.0, 0.0, 0.0]
    for part in ("Shoulder", "Hip"):
        if part + "Left" in body and part + "Right" in body:
            left = [x + y for x, y in zip(left, minus(body[part + "Left"], body[part + "Right"]))]
    return None if math.sqrt(dot(left, left)) < 0.05 else unit(left)


def hinge(off, root, middle_joint, end, left):
    """How far a limb is bent off its line [m], and the cosine between its hinge and the left."""
    axis = unit(cross(minus(middle_joint, root), minus(end, middle_joint)))
    return math.sqrt(dot(off, off)), dot(axis, left)


def offsets(body):
    """The cues for the left that the labels give, as in posture.cpp, clamped to +-1."""
    left = left_of(body)
    if left is None:
        return None
    front = unit(cross(left, [0, 1, 0]))
    trunk = minus(body["SpineShoulder"], body["SpineBase"])
    upright = min(1, max(0, (unit(trunk)[1] - LYING) / (UPRIGHT - LYING)))

    def bends(root, mid, end, weigh):
        limbs = [[body.get(part + side) for part in (root, mid, end)] for side in ("Left", "Right")]
        found = []
        for r, m, e in (limb for limb in limbs if all(limb)):
            off = off_line(m, r, e)
            found.append(weigh(off, *hinge(off, r, m, e, left)))
        return sum(found) / len(found) if found else 0.0

    def elbow(off, size, cosine):
        return upright * dot(off, front) + (1 - upright) * size * cosine * abs(cosine)

    arms = all(part + side in body for part in ("Wrist", "Shoulder") for side in ("Left", "Right"))
    hands = minus(middle(body, "Wrist"), middle(body, "Shoulder")) if arms else [0, 0, 0]
    found = {
        "knees": bends("Hip", "Knee", "Ankle", lambda off, size, cosine: size * cosine),
        "elbows": bends("Shoulder", "Elbow", "Wrist", elbow),
        "wrists": upright * dot(hands, front),
        "lean": upright * dot(trunk, front),
    }
    return [max(-1.0, min(1.0, found[cue] / full)) for cue, full in CUES.items()]


def solve(matrix, right):
    rows = [row + [value] for row, value in zip(matrix, right)]
    for i in range(len(rows)):
        pivot = max(range(i, len(rows)), key=lambda r: abs(rows[r][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for r in range(len(rows)):
            if r != i:
                factor = rows[r][i] / rows[i][i]
                rows[r] = [a - factor * b for a, b in zip(rows[r], rows[i])]
    return [row[-1] / row[i] for i, row in enumerate(rows)]


def learn(rows):
    """Newton's method on the penalised log likelihood; rows are (offsets, weight)."""
    n = len(CUES)
    total = sum(weight for _, weight in rows)
    found = [0.0] * n
    for _ in range(50):
        slope = [-RIDGE * w for w in found]
        curve = [[RIDGE if i == j else 0.0 for j in range(n)] for i in range(n)]
        for x, weight in rows:
            wrong = 1 / (1 + math.exp(sum(a * b for a, b in zip(found, x))))
            for i in range(n):
                slope[i] += weight / total * wrong * x[i]
                for j in range(n):
                    curve[i][j] += weight / total * wrong * (1 - wrong) * x[i] * x[j]
        step = solve(curve, slope)
        found = [a + b for a, b in zip(found, step)]
        if max(map(abs, step)) < 1e-9:
            break
    return found


def main():
    default = os.path.join(os.environ.get("CHORUS_SHARED", "../shared"), "data")
    folder = sys.argv[1] if len(sys.argv) > 1 else default
    readers = {"labanotation": labanotation, "keraal": keraal, "azure": azure, "ui-prmd": ui_prmd}
    rows = {}
    for name, read in readers.items():
        takes = [[x for x in map(offsets, take) if x] for take in read(folder)]
        if not takes:
            sys.exit(f"{folder} holds no recordings of {name}.")
        rows[name] = [(x, SHARES[name] / len(takes) / len(take)) for take in takes for x in take]
    weights = learn(sum(rows.values(), []))
    print("\n".join(f"{cue:8} {weight:6.2f} at {CUES[cue]} m" for cue, weight in zip(CUES, weights)))
    for name in rows:
        others = learn(sum((found for other, found in rows.items() if other != name), []))
        right = [sum(a * b for a, b in zip(others, x)) > 0 for x, _ in rows[name]]
        print(f"{name:13} {len(right):5} frames, {100 * sum(right) / len(right):.1f} % right by the others' weights")


if __name__ == "__main__":
    main()
