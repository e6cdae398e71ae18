"""MediaPipe's landmarks, lifted with the depth that a camera measured at their pixels.

Depth is that of the body's surface.  Where something hides a landmark, the camera measured the depth of that instead: landmarks
whose depth is far from the body's are left out, and so are landmarks without a depth.
"""
import statistics

REACH = 2  # the patch around a pixel has this many pixels to each side
BODY_DEPTH_M = 0.8  # nothing of a person is farther than this from its middle, along the view
HIPS_AND_SHOULDERS = (11, 12, 23, 24)


def patch_depth(depth, u, v):
    """Median of the valid depths around a pixel, or None.  `depth`: rows of numbers, 0 for no measurement."""
    rows = range(max(0, v - REACH), min(len(depth), v + REACH + 1))
    found = [depth[row][column] for row in rows
             for column in range(max(0, u - REACH), min(len(depth[row]), u + REACH + 1)) if depth[row][column] > 0]
    return statistics.median(found) if found else None


def lift(landmarks, depth, metres, camera):
    """[x, y, z, visibility] or None for each (u, v, visibility); axes: right, down, ahead.

    depth: rows of raw numbers, aligned with the image; metres: of one such number; camera: fx, fy, cx, cy [px].
    """
    depths = [patch_depth(depth, round(u), round(v)) for u, v, _ in landmarks]
    trunk = [depths[i] for i in HIPS_AND_SHOULDERS if depths[i] is not None]
    if not trunk:
        return [None] * len(landmarks)
    middle = statistics.median(trunk)
    points = []
    for (u, v, visibility), raw in zip(landmarks, depths):
        if raw is None or abs(raw - middle) * metres > BODY_DEPTH_M:
            points.append(None)
            continue
        z = float(raw * metres)
        points.append([(u - camera["cx"]) / camera["fx"] * z, (v - camera["cy"]) / camera["fy"] * z, z, float(visibility)])
    return points


class Landmarker:
    """The person in an RGB image as (u, v, visibility) in pixels; None when there is none."""

    def __init__(self):
        import mediapipe

        self.pose = mediapipe.solutions.pose.Pose(model_complexity=1)

    def __call__(self, image):
        height, width = image.shape[:2]
        found = self.pose.process(image).pose_landmarks
        if found is None:
            return None
        return [(one.x * width, one.y * height, min(1.0, max(0.0, one.visibility))) for one in found.landmark]
