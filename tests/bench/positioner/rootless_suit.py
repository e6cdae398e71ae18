#!/usr/bin/env python3
"""Makes the stand-in for a suit's take, tests/data/suit/walk.bvh, of a person's motion: the place of its root set to zero,
angles rounded to 0.01 degrees.

    chorus import pose2sim tests/data/pose2sim_mediapipe --out rec --rays
    chorus export rec/truth.ndjson --format bvh --out motion.bvh
    tests/bench/positioner/rootless_suit.py motion.bvh tests/data/suit/walk.bvh
"""

import sys
from pathlib import Path

PLACE = 3  # The root's first channels.


def short(value):
    return f"{round(float(value), 2) + 0.0:g}"


def main():
    source, target = (Path(each) for each in sys.argv[1:])
    head, motion = source.read_text(encoding="utf-8").split("MOTION\n")
    count, step, *rows = motion.strip().split("\n")
    rows = [" ".join(["0"] * PLACE + [short(value) for value in row.split()[PLACE:]]) for row in rows]
    target.write_text("\n".join([f"{head}MOTION", count, step, *rows]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
