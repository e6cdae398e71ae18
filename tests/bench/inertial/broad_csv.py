#!/usr/bin/env python3
"""Turns trials of BROAD (Laidig et al., Data 2021, CC BY 4.0; data_mat/*.mat) into the csv.gz that `chorus-bench inertial` reads.

broad_csv.py OUT FILE.mat...    Standard library only: a reader of MAT version 5 for real arrays, compressed or not."""

import array
import gzip
import struct
import sys
import zlib
from pathlib import Path

KINDS = {1: "b", 2: "B", 3: "h", 4: "H", 5: "i", 6: "I", 7: "f", 9: "d", 12: "q", 13: "Q"}
COMPRESSED, MATRIX = 15, 14
COLUMNS = [("imu_gyr", 3), ("imu_acc", 3), ("imu_mag", 3), ("opt_quat", 4), ("opt_pos", 3), ("movement", 1)]
HEAD = "t_s,gx,gy,gz,ax,ay,az,mx,my,mz,qw,qx,qy,qz,px,py,pz,movement"


def elements(buffer):
    at = 0
    while at + 8 <= len(buffer):
        kind, size = struct.unpack_from("<II", buffer, at)
        if kind >> 16:  # a small element: four bytes of content in the tag
            yield kind & 0xFFFF, buffer[at + 4:at + 4 + (kind >> 16)]
            at += 8
            continue
        yield kind, buffer[at + 8:at + 8 + size]
        at += 8 + size
        if kind != COMPRESSED:
            at += -size % 8


def arrays(buffer):
    for kind, content in elements(buffer):
        if kind == COMPRESSED:
            yield from arrays(zlib.decompress(content))
        elif kind == MATRIX:
            parts = list(elements(content))
            rows = struct.unpack_from("<i", parts[1][1])[0]
            if len(parts) < 4 or parts[3][0] not in KINDS:
                continue
            values = array.array(KINDS[parts[3][0]])
            values.frombytes(bytes(parts[3][1]))
            yield bytes(parts[2][1]).decode(), rows, values


def convert(file, out):
    found = {name: (rows, values) for name, rows, values in arrays(memoryview(file.read_bytes())[128:])}
    rate = found["sampling_rate"][1][0]
    rows = found["imu_gyr"][0]
    columns = []
    for name, width in COLUMNS:
        values = found[name][1]
        columns += [values[i * rows:(i + 1) * rows] for i in range(width)]
    with gzip.open(out / (file.stem + ".csv.gz"), "wt", compresslevel=4) as text:
        text.write(HEAD + "\n")
        for i in range(rows):
            text.write(f"{i / rate:.6g}," + ",".join(f"{float(column[i]):.7g}" for column in columns) + "\n")


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name in sys.argv[2:]:
        convert(Path(name), folder)
        print(name, flush=True)
