#!/usr/bin/env python3
"""ZED cameras with the ZED SDK's body tracking.  Not run here: see README.md.

usage: zed.py URL
"""
import math
import sys
from pathlib import Path

import pyzed.sl as sl

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from chorus_push import Pusher  # noqa: E402

zed = sl.Camera()
init = sl.InitParameters()
init.coordinate_units = sl.UNIT.METER
init.coordinate_system = sl.COORDINATE_SYSTEM.RIGHT_HANDED_Y_UP
if zed.open(init) != sl.ERROR_CODE.SUCCESS:
    sys.exit("the camera cannot be opened")
standing = sl.PositionalTrackingParameters()
standing.set_as_static = True
zed.enable_positional_tracking(standing)
tracking = sl.BodyTrackingParameters()
tracking.enable_tracking = True
tracking.body_format = sl.BODY_FORMAT.BODY_38
zed.enable_body_tracking(tracking)
pusher = Pusher(sys.argv[1], {"name": "ZED", "layout": "zed_38", "axes": "right up back"})
bodies, runtime = sl.Bodies(), sl.BodyTrackingRuntimeParameters()


def landmark(place, confidence):
    if not all(math.isfinite(value) for value in place):
        return None
    return [*(float(value) for value in place), min(1.0, max(0.0, float(confidence) / 100))]


while zed.grab() == sl.ERROR_CODE.SUCCESS:
    zed.retrieve_bodies(bodies, runtime)
    captured = zed.get_timestamp(sl.TIME_REFERENCE.IMAGE).get_nanoseconds()
    pusher.push([{"id": body.id, "points": [landmark(*one) for one in zip(body.keypoint, body.keypoint_confidence)]}
                 for body in bodies.body_list], captured)
