#!/usr/bin/env python3
"""A made-up tracker: a person who walks about, as a camera on a ring around the room would measure it, pushed to a sensor.

usage: synthetic_walk.py URL [--camera 0/3] [--layout kinect_v2_25|coco_17] [--seconds S] [--rate HZ] [--clock-off S] [--token T]

Start one per sensor with cameras 0/3, 1/3, 2/3: all see the same person, because the walk depends on the time of day alone.
"""
import argparse
import math
import random
import time

from chorus_push import Pusher

RADIUS, HEIGHT, PITCH = 3.0, 1.6, math.radians(13)  # of the ring of cameras [m]
NOISE = 0.01  # [m]
# Where joints are in a standing person [m]: to the person's left, up, and forward.
MIDDLE = {"SpineBase": (0, .95, 0), "SpineMid": (0, 1.2, 0), "SpineShoulder": (0, 1.43, 0), "Neck": (0, 1.5, .01),
          "Head": (0, 1.64, .03), "nose": (0, 1.63, .12)}
SIDES = {"Shoulder": (.19, 1.42, 0), "Elbow": (.23, 1.13, 0), "Wrist": (.24, .88, .02), "Hand": (.24, .81, .03),
         "HandTip": (.24, .73, .04), "Thumb": (.21, .79, .06), "Hip": (.09, .93, 0), "Knee": (.1, .5, .02),
         "Ankle": (.1, .09, -.02), "Foot": (.11, .03, .12), "Eye": (.03, 1.67, .1), "Ear": (.07, 1.64, .03)}
KINECT = ["SpineBase", "SpineMid", "Neck", "Head", "ShoulderLeft", "ElbowLeft", "WristLeft", "HandLeft", "ShoulderRight", "ElbowRight",
          "WristRight", "HandRight", "HipLeft", "KneeLeft", "AnkleLeft", "FootLeft", "HipRight", "KneeRight", "AnkleRight", "FootRight",
          "SpineShoulder", "HandTipLeft", "ThumbLeft", "HandTipRight", "ThumbRight"]
COCO = ["nose", *(part + side for part in ("Eye", "Ear", "Shoulder", "Elbow", "Wrist", "Hip", "Knee", "Ankle") for side in ("Left", "Right"))]
LAYOUTS = {"kinect_v2_25": KINECT, "coco_17": COCO}


def path(t):
    """Where the person is on the floor, x and z [m]: a curve that seldom comes back to itself."""
    return 0.9 * math.sin(0.53 * t) + 0.3 * math.sin(0.29 * t + 1), 0.9 * math.sin(0.41 * t + 0.7) + 0.3 * math.cos(0.23 * t)


def person(t):
    """Every joint in the room [m]: y up, the floor at 0."""
    x, z = path(t)
    dx, dz = (b - a for a, b in zip(path(t - 0.01), path(t + 0.01)))
    facing = math.atan2(dx, dz)
    stride = math.sin(2 * math.pi * 0.9 * t)
    swing = {"Elbow": .06, "Wrist": .18, "Hand": .21, "HandTip": .23, "Thumb": .21, "Knee": -.12, "Ankle": -.24, "Foot": -.24}
    still = dict(MIDDLE)
    for name, (left, up, forward) in SIDES.items():
        step = stride * swing.get(name, 0)
        still[name + "Left"], still[name + "Right"] = (left, up, forward + step), (-left, up, forward - step)
    c, s = math.cos(facing), math.sin(facing)
    return {name: (x + left * c + forward * s, up, z - left * s + forward * c) for name, (left, up, forward) in still.items()}


class Camera:
    """Place `index` of `count` on the ring, looking at the middle and down.  Its axes: left, up, ahead."""

    def __init__(self, index, count):
        yaw = 2 * math.pi * index / count
        self.at = (-RADIUS * math.sin(yaw), HEIGHT, -RADIUS * math.cos(yaw))
        self.cy, self.sy, self.cp, self.sp = math.cos(yaw), math.sin(yaw), math.cos(PITCH), math.sin(PITCH)

    def turned(self, x, y, z):
        """A direction of the room in the camera's axes."""
        left, level = x * self.cy - z * self.sy, x * self.sy + z * self.cy
        return left, y * self.cp + level * self.sp, -y * self.sp + level * self.cp

    def seen(self, point):
        exact = self.turned(*(a - b for a, b in zip(point, self.at)))
        return [round(value + random.gauss(0, NOISE), 4) for value in exact]

    def floor(self):
        return [*self.turned(0, 1, 0), HEIGHT]


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("url")
    options.add_argument("--camera", default="0/3")
    options.add_argument("--layout", default="kinect_v2_25", choices=LAYOUTS)
    options.add_argument("--seconds", type=float, default=math.inf)
    options.add_argument("--rate", type=float, default=30)
    options.add_argument("--clock-off", type=float, default=0, help="how far this program's clock is ahead [s]")
    options.add_argument("--token")
    chosen = options.parse_args()
    index, count = (int(part) for part in chosen.camera.split("/"))
    camera = Camera(index, count)
    off = int(chosen.clock_off * 1e9)
    hello = {"name": f"synthetic walk {index}", "layout": chosen.layout, "axes": "left up ahead", "floor": camera.floor()}
    pusher = Pusher(chosen.url, hello, chosen.token, clock=lambda: time.time_ns() + off)
    end = time.monotonic() + chosen.seconds
    while time.monotonic() < end:
        captured = time.time_ns()
        joints = person(captured / 1e9 % 86400)
        points = [[*camera.seen(joints[name]), 1.0] for name in LAYOUTS[chosen.layout]]
        pusher.push([{"id": 1, "points": points}], captured + off)
        time.sleep(max(0.0, 1 / chosen.rate - (time.time_ns() - captured) / 1e9))
    pusher.close()


if __name__ == "__main__":
    main()
