#!/usr/bin/env python3
"""Makes a folder that `chorus import pose2sim` reads of one take of eight real cameras with Vicon truth.

    tests/bench/camera/totalcapture_views.py --landmarks blazeposeall/S1/freestyle2 --calibration Orientation/calibration.txt \\
        --truth totalcapture_dataset/positions/S1/freestyle2/gt_skel_gbl_pos.txt --out views/S1-freestyle2
    chorus-bench camera --only eight-views-vicon    reads CHORUS_EIGHT_VIEWS=views

The data (TotalCapture's cameras, BlazePose's landmarks) has no licence: it is measured, and never becomes part of the project.
Every second video frame is taken, 30 Hz; landmarks come --lag video frames after the truth, 2 unless stated.
"""

import argparse
import ast
import json
import struct
from pathlib import Path

VIDEO_HZ = 60
SIZE = (1920, 1080)
INCH = 0.0254
# Vicon's joint for each of the landmarks that both have.
TRUTH = {11: "LeftArm", 12: "RightArm", 13: "LeftForeArm", 14: "RightForeArm", 15: "LeftHand", 16: "RightHand",
         23: "LeftUpLeg", 24: "RightUpLeg", 25: "LeftLeg", 26: "RightLeg", 27: "LeftFoot", 28: "RightFoot"}


def read_npy(path):
    """(frames, 33, 10) 32-bit floats as nested tuples of 10."""
    data = path.read_bytes()
    size = struct.unpack_from("<H", data, 8)[0]
    head = ast.literal_eval(data[10:10 + size].decode())
    frames, landmarks, channels = head["shape"]
    if head["descr"] != "<f4" or head["fortran_order"] or (landmarks, channels) != (33, 10):
        raise SystemExit(f"{path}: expected 32-bit floats of shape (frames, 33, 10), found {head}")
    rows = list(struct.iter_unpack("<10f", data[10 + size:]))
    return [rows[33 * i:33 * (i + 1)] for i in range(frames)]


def z_up(point):
    """TotalCapture's world has y up, cameras.json z."""
    x, y, z = point
    return [x, -z, y]


def cameras(path):
    """In calibration.txt: bounds, fx fy cx cy, distortion, three rows of R, t; camera = R world + t."""
    lines = path.read_text().split("\n")
    count = int(lines[0].split()[0])
    out = []
    for c in range(count):
        block = [[float(x) for x in line.split()] for line in lines[1 + 7 * c:8 + 7 * c]]
        fx, fy, cx, cy = block[1]
        out.append({"camera": f"cam{c + 1}", "width": SIZE[0], "height": SIZE[1],
                    "K": [[fx, 0, cx], [0, fy, cy], [0, 0, 1]],
                    "distortion_k1k2p1p2k3": [block[2][0], 0, 0, 0, 0],
                    "camera_from_world": {"R": [z_up(row) for row in block[3:6]], "t_m": block[6]}})
    return out


def view(rows, name, lag):
    frames = []
    for index in range(lag, len(rows), 2):
        landmarks = rows[index]
        found = any(mark[5] or mark[6] for mark in landmarks)
        frames.append({"t_s": round((index - lag) / VIDEO_HZ, 6),
                       "image": [[round(m[5] * SIZE[0], 2), round(m[6] * SIZE[1], 2), round(max(0.0, min(1.0, m[8])), 3)] for m in landmarks]
                       if found else None,
                       "world": [[round(v, 4) for v in m[:3]] for m in landmarks] if found else None})
    return {"camera": name, "fps": VIDEO_HZ // 2, "frames": frames}


def truth(path):
    lines = path.read_text().split("\n")
    names = lines[0].split()
    frames = []
    for line in lines[1::2]:
        points = [[float(v) * INCH for v in cell.split()] for cell in line.strip().split("\t") if cell.strip()]
        if len(points) != len(names):
            continue
        of = dict(zip(names, points))
        frames.append([z_up(of[TRUTH[i]]) if i in TRUTH else None for i in range(33)])
    return {"units": "m", "world": "z up", "method": "Vicon", "frames": frames}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--landmarks", type=Path, required=True, help="folder with one .npy per camera, named by cam1 to cam8")
    parser.add_argument("--calibration", type=Path, required=True)
    parser.add_argument("--truth", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--orientations", type=Path, help="gt_skel_gbl_ori.txt of the take, for chorus-bench inertial")
    parser.add_argument("--lag", type=int, default=2, help="video frames by which landmarks come after the truth")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    lenses = cameras(options.calibration)
    for lens in lenses:
        name = lens["camera"]
        files = sorted(options.landmarks.glob(f"*{name}.npy"))
        if len(files) != 1:
            raise SystemExit(f"{options.landmarks}: expected one *{name}.npy, found {len(files)}")
        (options.out / f"{name}.json").write_text(json.dumps(view(read_npy(files[0]), name, options.lag)))
    (options.out / "cameras.json").write_text(json.dumps(lenses))
    if options.orientations:
        (options.out / "gt_skel_gbl_ori.txt").write_text(options.orientations.read_text())
    (options.out / "triangulated.json").write_text(json.dumps(truth(options.truth)))


if __name__ == "__main__":
    main()
