#!/usr/bin/env python3
"""Orbbec cameras with MediaPipe's landmarks, lifted with measured depth.  Not run here: see README.md.

usage: orbbec.py URL
"""
import sys
from pathlib import Path

import numpy
from pyorbbecsdk import Config, OBAlignMode, OBFormat, OBSensorType, Pipeline

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from chorus_push import Pusher, now_ns  # noqa: E402
from depth_landmarks import Landmarker, lift  # noqa: E402

pipeline = Pipeline()
config = Config()
colors = pipeline.get_stream_profile_list(OBSensorType.COLOR_SENSOR)
config.enable_stream(colors.get_video_stream_profile(1280, 0, OBFormat.RGB, 30))
config.enable_stream(pipeline.get_stream_profile_list(OBSensorType.DEPTH_SENSOR).get_default_video_stream_profile())
config.set_align_mode(OBAlignMode.SW_MODE)  # depth as the colour camera sees it
pipeline.start(config)
inner = pipeline.get_camera_param().rgb_intrinsic
camera = {"fx": inner.fx, "fy": inner.fy, "cx": inner.cx, "cy": inner.cy}
pusher = Pusher(sys.argv[1], {"name": "Orbbec", "layout": "mediapipe_33", "axes": "right down ahead"})
landmarks_in = Landmarker()
while True:
    frames = pipeline.wait_for_frames(100)
    captured = now_ns()  # time of arrival
    color = frames.get_color_frame() if frames else None
    depth = frames.get_depth_frame() if frames else None
    if color is None or depth is None:
        continue
    image = numpy.frombuffer(color.get_data(), dtype=numpy.uint8).reshape(color.get_height(), color.get_width(), 3)
    raw = numpy.frombuffer(depth.get_data(), dtype=numpy.uint16).reshape(depth.get_height(), depth.get_width())
    landmarks = landmarks_in(image)
    points = lift(landmarks, raw, depth.get_depth_scale() / 1000, camera) if landmarks else None
    pusher.push([{"id": 1, "points": points}] if points else [], captured)
