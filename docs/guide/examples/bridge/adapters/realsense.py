#!/usr/bin/env python3
"""Intel RealSense with MediaPipe's landmarks, lifted with measured depth.  Not run here: see README.md.

usage: realsense.py URL
"""
import sys
from pathlib import Path

import numpy
import pyrealsense2 as rs

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from chorus_push import Pusher, now_ns  # noqa: E402
from depth_landmarks import Landmarker, lift  # noqa: E402

config = rs.config()
config.enable_stream(rs.stream.depth, 640, 480, rs.format.z16, 30)
config.enable_stream(rs.stream.color, 640, 480, rs.format.rgb8, 30)
pipeline = rs.pipeline()
profile = pipeline.start(config)
metres = profile.get_device().first_depth_sensor().get_depth_scale()
inner = profile.get_stream(rs.stream.color).as_video_stream_profile().get_intrinsics()
camera = {"fx": inner.fx, "fy": inner.fy, "cx": inner.ppx, "cy": inner.ppy}
align = rs.align(rs.stream.color)
pusher = Pusher(sys.argv[1], {"name": "RealSense", "layout": "mediapipe_33", "axes": "right down ahead"})
landmarks_in = Landmarker()
while True:
    frames = align.process(pipeline.wait_for_frames())
    color, depth = frames.get_color_frame(), frames.get_depth_frame()
    if not color or not depth:
        continue
    # With global time, the default, stamps are milliseconds of this computer's clock at mid-exposure.
    is_global = color.get_frame_timestamp_domain() == rs.timestamp_domain.global_time
    captured = int(color.get_timestamp() * 1e6) if is_global else now_ns()
    landmarks = landmarks_in(numpy.asanyarray(color.get_data()))
    points = lift(landmarks, numpy.asanyarray(depth.get_data()), metres, camera) if landmarks else None
    pusher.push([{"id": 1, "points": points}] if points else [], captured)
