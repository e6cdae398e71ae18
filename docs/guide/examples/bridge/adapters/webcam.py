#!/usr/bin/env python3
"""Any webcam with MediaPipe's landmarks, pushed as pixels: rays, no depth.  Not run here: see README.md.

usage: webcam.py URL [camera number] [focal length in pixels, from a calibration]
"""
import sys
from pathlib import Path

import cv2

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from chorus_push import Pusher, now_ns  # noqa: E402
from depth_landmarks import Landmarker  # noqa: E402

url = sys.argv[1]
video = cv2.VideoCapture(int(sys.argv[2]) if len(sys.argv) > 2 else 0)
width, height = int(video.get(cv2.CAP_PROP_FRAME_WIDTH)), int(video.get(cv2.CAP_PROP_FRAME_HEIGHT))
focal = float(sys.argv[3]) if len(sys.argv) > 3 else 0.9 * width  # a guess, wrong by a tenth or two
camera = {"width": width, "height": height, "fx": focal, "fy": focal, "cx": width / 2, "cy": height / 2}
pusher = Pusher(url, {"name": "webcam", "layout": "mediapipe_33", "intrinsics": camera, "pixelSigma": 0.005 * width})
landmarks_in = Landmarker()
while True:
    alive, image = video.read()
    captured = now_ns()  # time of arrival; the exposure was one or two frames earlier
    if not alive:
        break
    landmarks = landmarks_in(cv2.cvtColor(image, cv2.COLOR_BGR2RGB))
    pusher.push([{"id": 1, "pixels": landmarks}] if landmarks else [], captured)
