"""Replaces a runner (proto/runner.md) in tests that need immediate answers: one person, with all landmarks in the centre of the red part of
the picture. Without red there is nobody.

    stand_in_runner.py [--model NAME] [--die-after N] [--lie] [--silent]
"""

import argparse
import json
import sys

LANDMARKS = 17
SIDE = 64


def middle_of_red(width, height, rgb):
    red = [i for i in range(width * height) if rgb[3 * i] > 180 and rgb[3 * i + 1] < 80 and rgb[3 * i + 2] < 80]
    if not red:
        return None
    return [sum(i % width + 0.5 for i in red) / len(red), sum(i // width + 0.5 for i in red) / len(red)]


def say(message):
    sys.stdout.write(json.dumps(message) + "\n")
    sys.stdout.flush()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--model", default="")
    parser.add_argument("--die-after", type=int, default=0)
    parser.add_argument("--lie", action="store_true")
    parser.add_argument("--silent", action="store_true")
    options = parser.parse_args()
    if options.silent:
        sys.stdin.buffer.read()
        return 0
    print(f"looking with {options.model or 'no model'}", file=sys.stderr, flush=True)
    say({"type": "hello", "version": 1, "name": "stand-in", "layout": "coco_17", "pixelSigma": 1, "image": {"maxSide": SIDE}})
    answered = 0
    while header := sys.stdin.buffer.readline():
        image = json.loads(header)
        rgb = sys.stdin.buffer.read(image["bytes"])
        if options.die_after and answered == options.die_after:
            print("the stand-in has had enough", file=sys.stderr, flush=True)
            return 3
        place = middle_of_red(image["width"], image["height"], rgb)
        bodies = [{"id": 1, "pixels": [[*place, 0.9]] * LANDMARKS}] if place else []
        say({"type": "frame", "sequence": image["sequence"] + options.lie, "captured": image["captured"], "bodies": bodies})
        answered += 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
