"""What arms and legs tell of the clocks and turns of two cells: real takes of eight cameras, four of which are one cell and four another.

Usage: CHORUS_EIGHT_VIEWS=views python3 tests/bench/site/limb_clocks.py     (tests/bench/camera/totalcapture_views.py makes the views)

All eight cameras have one clock and published places, so the true offset and turn are 0.  Joints are triangulated from published places, not
fused, and averaged over five frames.  Printed: how two cells differ, and what windows of 1.5 s say, as long as it takes to walk through 1.5 m.
"""
import json
import math
import os
import pathlib
import statistics

HZ, WINDOW, TOO_FAR_M, TURN_OUTLIER_M = 30, 45, 0.10, 0.2
LANDMARKS = dict(zip(("sl", "sr", "el", "er", "wl", "wr", "hl", "hr", "kl", "kr", "al", "ar"), (11, 12, 13, 14, 15, 16, 23, 24, 25, 26, 27, 28)))
CORE, LIMBS = ("sl", "sr", "hl", "hr"), ("el", "er", "wl", "wr", "kl", "kr", "al", "ar")
CELLS = (("cam1", "cam3", "cam5", "cam7"), ("cam2", "cam4", "cam6", "cam8"))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def sights(take, cameras, name):
    """Of each frame: the camera's place, and the direction of each joint that it is sure of."""
    camera, turn = cameras[name]["K"], cameras[name]["camera_from_world"]["R"]
    shift = cameras[name]["camera_from_world"]["t_m"]
    eye = [-sum(turn[k][i] * shift[k] for k in range(3)) for i in range(3)]
    for frame in json.loads((take / f"{name}.json").read_text())["frames"]:
        found = {}
        for joint, index in LANDMARKS.items():
            u, v, sure = frame["image"][index] if frame["image"] else (0, 0, 0)
            if sure >= 0.5:
                ray = ((u - camera[0][2]) / camera[0][0], (v - camera[1][2]) / camera[1][1], 1.0)
                world = [sum(turn[k][i] * ray[k] for k in range(3)) for i in range(3)]
                found[joint] = [x / math.hypot(*world) for x in world]
        yield eye, found


def solved(matrix, right):
    rows = [row[:] + [value] for row, value in zip(matrix, right)]
    for i in range(3):
        best = max(range(i, 3), key=lambda r: abs(rows[r][i]))
        rows[i], rows[best] = rows[best], rows[i]
        for r in (r for r in range(3) if r != i):
            factor = rows[r][i] / rows[i][i]
            rows[r] = [x - factor * y for x, y in zip(rows[r], rows[i])]
    return [rows[i][3] / rows[i][i] for i in range(3)]


def off_ray(point, ray):
    aside = [p - e for p, e in zip(point, ray[0])]
    along = dot(aside, ray[1])
    return math.hypot(*(a - along * d for a, d in zip(aside, ray[1])))


def nearest(rays):
    """The point nearest to three rays or more, without those that pass it by 0.1 m."""
    while len(rays) >= 3:
        matrix, right = [[0.0] * 3 for _ in range(3)], [0.0] * 3
        for eye, way in rays:
            for i in range(3):
                row = [(i == k) - way[i] * way[k] for k in range(3)]
                matrix[i] = [a + b for a, b in zip(matrix[i], row)]
                right[i] += dot(row, eye)
        point = solved(matrix, right)
        worst = max(rays, key=lambda ray: off_ray(point, ray))
        if off_ray(point, worst) < TOO_FAR_M:
            return point
        rays = [ray for ray in rays if ray is not worst]
    return None


def bodies(take, cameras, names):
    return [{joint: nearest([(eye, found[joint]) for eye, found in views if joint in found]) for joint in LANDMARKS}
            for views in zip(*(sights(take, cameras, name) for name in names))]


def series(body_list):
    """The middle of the body, and each limb from there; means over five frames, none where one is missing."""
    middle = [[statistics.fmean(body[j][i] for j in CORE) for i in range(3)] if all(body[j] for j in CORE) else None for body in body_list]
    raw = {"middle": middle} | {j: [[a - b for a, b in zip(body[j], m)] if m and body[j] else None for body, m in zip(body_list, middle)]
                                for j in LANDMARKS}
    return {key: [[statistics.fmean(x) for x in zip(*five)] if all(five := places[k:k + 5]) else None for k in range(len(places) - 4)]
            for key, places in raw.items()}


def differences(one, other, key):
    """(sd per axis [m], correlation after 0.1, 0.27, 0.5, 1, 2 s) of two cells."""
    variance, after = [], {lag: [] for lag in (3, 8, 15, 30, 60)}
    for axis in range(3):
        off = [a[axis] - b[axis] if a and b else None for a, b in zip(one[key], other[key])]
        mean = statistics.fmean(x for x in off if x is not None)
        off = [x - mean if x is not None else None for x in off]
        variance.append(statistics.fmean(x * x for x in off if x is not None))
        for lag, values in after.items():
            values.append(statistics.fmean(x * y for x, y in zip(off, off[lag:]) if x is not None and y is not None) / variance[-1])
    return math.sqrt(statistics.fmean(variance)), [statistics.fmean(values) for values in after.values()]


def clock_of_window(one, other, keys, begin, lasts_s, every=3):
    """The offset [ms] that the window gives; what each instant says beyond the one before it, as in joint_terms.cpp."""
    top = bottom = 0.0
    kept = math.exp(-every / HZ / lasts_s)
    for key in keys:
        before = None
        for k in range(begin, begin + WINDOW, every):
            seen = [cell[key][k + i] for cell in (one, other) for i in (-1, 0, 1)]
            if not all(seen):
                before = None
                continue
            off = [a - b for a, b in zip(seen[1], seen[4])]
            speed = [(a - b + c - d) * HZ / 4 for a, b, c, d in zip(seen[2], seen[0], seen[5], seen[3])]
            if before:
                new = [[x - kept * y for x, y in zip(now, then)] for now, then in zip((off, speed), before)]
                top += dot(*new)
                bottom += dot(new[1], new[1])
            before = off, speed
    return -1e3 * top / bottom if bottom else None


def turn_of_window(one, other, begin):
    """The turn [deg] about the vertical between both cells' limbs."""
    sine = cosine = 0.0
    for key in LIMBS:
        for a, b in zip(one[key][begin:begin + WINDOW], other[key][begin:begin + WINDOW]):
            if a and b and math.dist(a[:2], b[:2]) < TURN_OUTLIER_M:
                sine += b[0] * a[1] - b[1] * a[0]
                cosine += dot(a[:2], b[:2])
    return math.degrees(math.atan2(sine, cosine)) if cosine else None


def main():
    for take in sorted(pathlib.Path(os.environ["CHORUS_EIGHT_VIEWS"]).iterdir()):
        cameras = {each["camera"]: each for each in json.loads((take / "cameras.json").read_text())}
        one, other = (series(bodies(take, cameras, names)) for names in CELLS)
        limbs = [differences(one, other, key) for key in LIMBS]
        middle = differences(one, other, "middle")
        rms = math.sqrt(statistics.fmean(sd * sd for sd, _ in limbs))
        print(f"{take.name}: middle {1e3 * middle[0]:.0f} mm per axis, correlation {' '.join(f'{x:.2f}' for x in middle[1])}; limbs "
              f"{1e3 * rms:.0f} mm, {' '.join(f'{statistics.fmean(x):.2f}' for x in zip(*(lags for _, lags in limbs)))} after 0.1 0.27 0.5 1 2 s")
        begins = range(1, len(one["middle"]) - WINDOW - 1, WINDOW)
        for name, keys, lasts in (("middle", ("middle",), 2.0), ("limbs", LIMBS, 0.35)):
            clocks = [c for c in (clock_of_window(one, other, keys, begin, lasts) for begin in begins) if c is not None]
            print(f"  clock by the {name}: rms {math.sqrt(statistics.fmean(c * c for c in clocks)):.1f} ms, median "
                  f"{statistics.median(map(abs, clocks)):.1f}, mean {statistics.fmean(clocks):.1f}; {len(clocks)} windows")
        turns = [t for t in (turn_of_window(one, other, begin) for begin in begins) if t is not None]
        print(f"  turn by the limbs: sd {statistics.pstdev(turns):.1f} deg, mean {statistics.fmean(turns):.1f}")


if __name__ == "__main__":
    main()
