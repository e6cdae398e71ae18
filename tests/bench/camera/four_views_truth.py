#!/usr/bin/env python3
"""Makes triangulated.json of a folder with landmarks of several cameras: where the person was, with sides that agree.

    tests/bench/camera/four_views_truth.py tests/data/pose2sim_mediapipe            writes triangulated.json there
    tests/bench/camera/four_views_truth.py FOLDER --against published.trc           compares with a published triangulation

A network that sees a person from behind or from the side exchanges left and right, of the whole person, of the arms or of
the legs, in one camera and for many pictures.  A triangulation of such labels lies between both sides.  Here the sides are
chosen for all cameras together:

1. For each picture and each of the groups head, arms and legs, every combination of cameras whose labels are exchanged is
   triangulated.  Its cost is the robust reprojection error of the group, a little for every exchanged label, and from
   picture to picture the way that the joints would have moved; the cheapest sequence is found by Viterbi's algorithm.
   That a whole combination and its opposite fit equally well is decided by the movement and by the labels together.
2. Each landmark's path is fitted to its rays: robust weights (Geman-McClure), and a standard deviation of acceleration
   that a person's limbs reach.  A landmark that fewer than two cameras see within --within pixels has no place.
"""

import argparse
import itertools
import json
import math
from pathlib import Path

GROUPS = {"head": [(1, 4), (2, 5), (3, 6), (7, 8), (9, 10)],
          "arms": [(11, 12), (13, 14), (15, 16), (17, 18), (19, 20), (21, 22)],
          "legs": [(23, 24), (25, 26), (27, 28), (29, 30), (31, 32)]}
DECIDING = {"head": [(7, 8), (2, 5)], "arms": [(11, 12), (13, 14), (15, 16)], "legs": [(23, 24), (25, 26), (27, 28)]}
PIXEL = 12.0  # Standard deviation of a landmark, whose place on a limb differs between views.
STEP_M = 0.05  # A joint's step between pictures at 60 Hz: a wrist at 3 m/s.
EXCHANGED = 0.5  # Cost of a label that is not believed.
CHANGED = 2.0  # Cost of a camera that changes its mind: exchanges last for many pictures.
MOST_COST = 9.0  # Of one residual: three standard deviations.
ACCELERATION = 40.0  # [m/s2] of a limb, standard deviation.


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def solve(matrix, right):
    """Solves a small symmetric positive system; None where it is singular."""
    n = len(right)
    rows = [list(matrix[i]) + [right[i]] for i in range(n)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda r: abs(rows[r][i]))
        if abs(rows[pivot][i]) < 1e-12:
            return None
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for r in range(i + 1, n):
            by = rows[r][i] / rows[i][i]
            for c in range(i, n + 1):
                rows[r][c] -= by * rows[i][c]
    out = [0.0] * n
    for i in reversed(range(n)):
        out[i] = (rows[i][n] - sum(rows[i][c] * out[c] for c in range(i + 1, n))) / rows[i][i]
    return out


class Camera:
    """A pinhole camera; its landmarks are undistorted once, as directions with depth one."""

    def __init__(self, stated):
        self.focal = stated["K"][0][0]
        self.matrix = stated["K"]
        self.distortion = stated["distortion_k1k2p1p2k3"]
        self.turn = stated["camera_from_world"]["R"]
        self.shift = stated["camera_from_world"]["t_m"]

    def undistorted(self, pixel):
        k1, k2, p1, p2, k3 = self.distortion
        x0 = (pixel[0] - self.matrix[0][2]) / self.matrix[0][0]
        y0 = (pixel[1] - self.matrix[1][2]) / self.matrix[1][1]
        x, y = x0, y0
        for _ in range(10):
            r = x * x + y * y
            radial = 1 + r * (k1 + r * (k2 + r * k3))
            x = (x0 - 2 * p1 * x * y - p2 * (r + 2 * x * x)) / radial
            y = (y0 - p1 * (r + 2 * y * y) - 2 * p2 * x * y) / radial
        return x, y

    def seen(self, point):
        """The place in the picture at depth one, and the depth."""
        depth = dot(self.turn[2], point) + self.shift[2]
        if depth < 0.1:
            return 0.0, 0.0, 0.1
        return ((dot(self.turn[0], point) + self.shift[0]) / depth, (dot(self.turn[1], point) + self.shift[1]) / depth, depth)

    def off(self, point, ray):
        """Distance in pixels between a point and where the camera saw it."""
        x, y, _ = self.seen(point)
        return self.focal * math.hypot(x - ray[0], y - ray[1])

    def equations(self, point, ray):
        """Two rows of the linear triangulation in pixels, for the depth of `point`: (coefficients, right side)."""
        depth = self.seen(point)[2] if point else 3.0
        by = self.focal / depth
        for axis in (0, 1):
            row = [by * (self.turn[axis][c] - ray[axis] * self.turn[2][c]) for c in range(3)]
            yield row, by * (ray[axis] * self.shift[2] - self.shift[axis])


def add(matrix, right, row, value, weight):
    for i in range(3):
        right[i] += weight * row[i] * value
        for k in range(3):
            matrix[i][k] += weight * row[i] * row[k]


def triangulated(cameras, rays, weights, point=None):
    matrix = [[0.0] * 3 for _ in range(3)]
    right = [0.0] * 3
    for camera, ray, weight in zip(cameras, rays, weights):
        for row, value in camera.equations(point, ray):
            add(matrix, right, row, value, weight)
    return solve(matrix, right)


def point_and_cost(cameras, rays):
    """The point that most cameras agree on, and the sum of truncated squares of its residuals."""
    best = None
    for pair in itertools.combinations(range(len(cameras)), 2):
        weights = [1.0 if i in pair else 0.0 for i in range(len(cameras))]
        point = triangulated(cameras, rays, weights)
        for _ in range(3):
            if point is None:
                break
            offs = [camera.off(point, ray) / PIXEL for camera, ray in zip(cameras, rays)]
            point = triangulated(cameras, rays, [1.0 / (1.0 + off * off / MOST_COST) ** 2 for off in offs], point)
        if point is None:
            continue
        offs = [camera.off(point, ray) / PIXEL for camera, ray in zip(cameras, rays)]
        cost = sum(min(MOST_COST, off * off) for off in offs)
        if best is None or cost < best[1]:
            best = point, cost
    return best or ([0.0, 0.0, 1.0], MOST_COST * len(cameras))


def sides_of(cameras, rays, group):
    """For each picture the cameras whose labels of this group are exchanged: a tuple of booleans."""
    states = list(itertools.product((False, True), repeat=len(cameras)))
    before = None
    back = []
    for picture in rays:
        points, own = {}, {}
        for state in states:
            cost, place = EXCHANGED * sum(state), []
            for pair in DECIDING[group]:
                for side in (0, 1):
                    seen = [picture[c][pair[side != state[c]]] for c in range(len(cameras))]
                    point, error = point_and_cost(cameras, seen)
                    place.append(point)
                    cost += error
            points[state], own[state] = place, cost
        if before is None:
            total = own
            back.append({})
        else:
            total, chosen = {}, {}
            for state in states:
                def through(last):
                    step = sum(min(MOST_COST, math.dist(a, b) ** 2 / STEP_M ** 2) for a, b in zip(before[1][last], points[state]))
                    return before[0][last] + step + CHANGED * sum(a != b for a, b in zip(last, state))
                chosen[state] = min(states, key=through)
                total[state] = own[state] + through(chosen[state])
            back.append(chosen)
        before = total, points
    state = min(before[0], key=before[0].get)
    out = [state]
    for chosen in reversed(back[1:]):
        state = chosen[state]
        out.append(state)
    return out[::-1]


def path_of(cameras, rays, rate, begin):
    """The path of a landmark that fits all of its rays: iteratively reweighted, banded least squares."""
    count = len(rays)
    path = begin
    steadiness = (rate * rate / ACCELERATION) ** 2
    bend = (1.0, -2.0, 1.0)
    for _ in range(12):
        matrices = [[[0.0] * 3 for _ in range(3)] for _ in range(count)]
        rights = [[0.0] * 3 for _ in range(count)]
        for t, picture in enumerate(rays):
            for camera, ray in zip(cameras, picture):
                off = camera.off(path[t], ray) / PIXEL
                weight = 1.0 / PIXEL ** 2 / (1.0 + off * off / MOST_COST) ** 2
                for row, value in camera.equations(path[t], ray):
                    add(matrices[t], rights[t], row, value, weight)
        size = 3 * count
        band = [[0.0] * 7 for _ in range(size)]  # band[i][d]: coefficient (i, i + d)
        right = [value for each in rights for value in each]
        for t in range(count):
            for i in range(3):
                for k in range(i, 3):
                    band[3 * t + i][k - i] += matrices[t][i][k]
        for t in range(1, count - 1):
            for a in range(3):
                for b in range(a, 3):
                    for axis in range(3):
                        band[3 * (t - 1 + a) + axis][3 * (b - a)] += steadiness * bend[a] * bend[b]
        path = solve_band(band, right)
    return path


def solve_band(band, right):
    """Cholesky's decomposition of a symmetric band; three values for each instant."""
    n, width = len(right), len(band[0])
    for i in range(n):
        for d in range(1, width):
            if i + d >= n:
                break
            by = band[i][d] / band[i][0]
            for e in range(d, width):
                if i + e < n:
                    band[i + d][e - d] -= by * band[i][e]
            right[i + d] -= by * right[i]
    out = [0.0] * n
    for i in reversed(range(n)):
        out[i] = (right[i] - sum(band[i][d] * out[i + d] for d in range(1, width) if i + d < n)) / band[i][0]
    return [out[3 * t:3 * t + 3] for t in range(n // 3)]


def other_side():
    out = {}
    for group, pairs in GROUPS.items():
        for a, b in pairs:
            out[a], out[b] = (b, group), (a, group)
    return out


def truth_of(folder, within):
    stated = json.loads((folder / "cameras.json").read_text())
    cameras = [Camera(each) for each in stated]
    views = [json.loads((folder / f"{each['camera']}.json").read_text()) for each in stated]
    rays = [[[camera.undistorted(landmark) for landmark in view["frames"][t]["image"]] for camera, view in zip(cameras, views)]
            for t in range(len(views[0]["frames"]))]
    sides = {group: sides_of(cameras, rays, group) for group in GROUPS}
    others = other_side()
    columns, offs = [], []
    for landmark in range(33):
        other, group = others.get(landmark, (landmark, "head"))
        seen = [[picture[c][other if sides[group][t][c] else landmark] for c in range(len(cameras))] for t, picture in enumerate(rays)]
        begin = [point_and_cost(cameras, picture)[0] for picture in seen]
        path = path_of(cameras, seen, views[0]["fps"], begin)
        agree = [sum(camera.off(point, ray) < within for camera, ray in zip(cameras, picture)) for point, picture in zip(path, seen)]
        columns.append([[round(x, 3) for x in point] if count >= 2 else None for point, count in zip(path, agree)])
        offs += [camera.off(point, ray) for point, picture in zip(path, seen) for camera, ray in zip(cameras, picture)]
    return {"names": [each["camera"] for each in stated], "sides": sides, "frames": [list(row) for row in zip(*columns)],
            "reprojection": sorted(offs)[len(offs) // 2], "rate": views[0]["fps"]}


def read_trc(path):
    lines = path.read_text().split("\n")
    names = [name for name in lines[3].split("\t")[2:] if name.strip()]
    rows = [[float(x) if x else math.nan for x in line.split("\t")[2:2 + 3 * len(names)]] for line in lines[5:] if line.strip()]
    # y up to z up
    return [{name: (row[3 * i + 2], row[3 * i], row[3 * i + 1]) for i, name in enumerate(names)} for row in rows]


PUBLISHED = {"LShoulder": 11, "RShoulder": 12, "LElbow": 13, "RElbow": 14, "LWrist": 15, "RWrist": 16, "LHip": 23, "RHip": 24, "LKnee": 25,
             "RKnee": 26, "LAnkle": 27, "RAnkle": 28}


def compare(frames, published):
    for name, landmark in PUBLISHED.items():
        offs = sorted(math.dist(row[landmark], other[name]) for row, other in zip(frames, published) if row[landmark])
        other = {11: 12, 13: 14, 15: 16, 23: 24, 25: 26, 27: 28}
        mirror = {**other, **{b: a for a, b in other.items()}}[landmark]
        exchanged = sum(math.dist(row[mirror], seen[name]) < math.dist(row[landmark], seen[name]) for row, seen in zip(frames, published) if row[landmark])
        print(f"{name}: median {1000 * offs[len(offs) // 2]:.0f} mm, 95 % {1000 * offs[int(0.95 * len(offs))]:.0f}, worst {1000 * offs[-1]:.0f}; "
              f"nearer to the other side in {exchanged} of {len(offs)}")


def checks(frames, rate):
    for a, b, name in [(23, 24, "hips"), (11, 12, "shoulders"), (23, 25, "left thigh"), (24, 26, "right thigh"), (25, 27, "left shank"),
                       (26, 28, "right shank"), (11, 13, "left upper arm"), (12, 14, "right upper arm"), (13, 15, "left forearm"), (14, 16, "right forearm")]:
        lengths = sorted(math.dist(row[a], row[b]) for row in frames if row[a] and row[b])
        print(f"{name}: {lengths[0]:.3f} to {lengths[-1]:.3f} m, median {lengths[len(lengths) // 2]:.3f}, of {len(lengths)} pictures")
    lowest = min(row[i][2] for row in frames for i in (27, 28, 29, 30, 31, 32) if row[i])
    fastest = max((math.dist(a[i], b[i]) * rate, i) for a, b in zip(frames, frames[1:]) for i in range(33) if a[i] and b[i])
    missing = sum(point is None for row in frames for point in row)
    print(f"lowest foot {lowest:.3f} m; fastest landmark {fastest[1]} at {fastest[0]:.1f} m/s; {missing} places missing")


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("folder", type=Path)
    options.add_argument("--within", type=float, default=40.0, help="pixels within which two cameras must see a landmark")
    options.add_argument("--against", type=Path, help="a .trc of the same take; nothing is written")
    options = options.parse_args()
    found = truth_of(options.folder, options.within)
    for group, sides in found["sides"].items():
        for c, name in enumerate(found["names"]):
            exchanged = [t for t, state in enumerate(sides) if state[c]]
            if exchanged:
                print(f"{group} of {name}: exchanged in {len(exchanged)} pictures of {len(sides)}: {exchanged}")
    print(f"reprojection error: {found['reprojection']:.1f} px, median over landmarks, cameras and pictures")
    checks(found["frames"], found["rate"])
    if options.against:
        return compare(found["frames"], read_trc(options.against))
    method = ("robust triangulation of all cameras' landmarks, sides chosen for all cameras and pictures together "
              "(tests/bench/camera/four_views_truth.py)")
    (options.folder / "triangulated.json").write_text(json.dumps({"units": "m", "world": "z up, floor near z = 0", "method": method,
                                                                  "frames": found["frames"]}, separators=(",", ":")) + "\n")


if __name__ == "__main__":
    main()
