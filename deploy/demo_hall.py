"""Two cells of three simulated sensors each, and somebody who walks round and round through both: where everything stands.

The scene has its origin in the middle of the hall.  Cell a stands on its left and its world is the scene's; cell b stands on the right,
and its world is turned by a quarter and elsewhere, as it would be after a walk of its own.  The cells see 2 m of the hall in common.
Used by deploy/demo_site.py and by tests/system/site.
"""
import json
import math
import pathlib

SITE = "hall"
CELLS = ("a", "b")
SENSORS_PER_CELL = 3
ASIDE_M = 3.5       # how far from the middle the sensors stand; they see 4.5 m
BETWEEN_M = 1.2     # between two sensors of a cell
HEIGHT_M, PITCH_DEG = 1.6, 13.0
SCENE = {"path": "circle", "reach_m": 2.0, "speed_m_per_s": 0.8}
B_TURNED_DEG, B_MOVED_M = 90.0, (4.0, 0.0, -1.0)  # the scene in cell b's world


def multiplied(p, q):
    """Hamilton product of quaternions (x, y, z, w)."""
    (ax, ay, az, aw), (bx, by, bz, bw) = p, q
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def turned(degrees, axis):
    half = math.radians(degrees) / 2
    return tuple(math.sin(half) * a for a in axis) + (math.cos(half),)


def rotated(q, v):
    x, y, z, _ = multiplied(multiplied(q, (*v, 0.0)), (-q[0], -q[1], -q[2], q[3]))
    return x, y, z


def combined(outer, inner):
    """outer after inner; each is (place, quaternion)."""
    moved = rotated(outer[1], inner[0])
    return tuple(a + b for a, b in zip(outer[0], moved)), multiplied(outer[1], inner[1])


def inverse(pose):
    q = (-pose[1][0], -pose[1][1], -pose[1][2], pose[1][3])
    return tuple(-v for v in rotated(q, pose[0])), q


def world_from_scene(cell):
    if cell == "a":
        return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)
    return B_MOVED_M, turned(B_TURNED_DEG, (0, 1, 0))


def sensor_places():
    """{"a1": (settings of its pose, its pose in the scene)} of all six, looking at the middle of the hall."""
    places = {}
    for cell, side in zip(CELLS, (-1, 1)):
        for i in range(SENSORS_PER_CELL):
            x, z = side * ASIDE_M, BETWEEN_M * (i - 1)
            yaw = 90.0 if side < 0 else -90.0
            settings = {"x_m": x, "y_m": HEIGHT_M, "z_m": z, "yaw_deg": yaw, "pitch_deg": PITCH_DEG}
            turn = multiplied(turned(yaw, (0, 1, 0)), turned(PITCH_DEG, (1, 0, 0)))
            places[f"{cell}{i + 1}"] = settings, ((x, HEIGHT_M, z), turn)
    return places


def keys_of(pose):
    return dict(zip(("x", "y", "z", "qx", "qy", "qz", "qw"), (*pose[0], *pose[1])))


def registration(cell):
    """Where the sensors of a cell stand in its world, as the file registration.file."""
    outer = world_from_scene(cell)
    return {"sensors": {name: keys_of(combined(outer, pose)) for name, (_, pose) in sensor_places().items() if name[0] == cell}}


def places(sigma_m=0.03, sigma_deg=0.3):
    """Where the cells stand in the site, as the file site.places; the site's space is the scene."""
    turn = math.radians(sigma_deg) ** 2
    covariance = [0.0] * 36
    for i in range(6):
        covariance[7 * i] = turn if i < 3 else sigma_m ** 2
    return {"cells": {cell: {**keys_of(inverse(world_from_scene(cell))), "covariance": covariance} for cell in CELLS}}


def write(folder):
    folder = pathlib.Path(folder)
    for cell in CELLS:
        (folder / f"{cell}.registration.json").write_text(json.dumps(registration(cell), indent=1))
    (folder / "places.json").write_text(json.dumps(places(), indent=1))


def sensor_arguments(name, port, folder):
    """The options of chorus-sensor for one of the six; writes its configuration into the folder."""
    settings, _ = sensor_places()[name]
    simulated = {"scene": SCENE, "pose": settings}
    config = {"id": name, "http": {"port": port}, "device": {"kind": "simulated", "simulated": simulated}}
    file = pathlib.Path(folder) / f"{name}.json"
    file.write_text(json.dumps(config, indent=1))
    return ["--config", str(file)]


def fusion_arguments(cell, port, sensor_ports, folder):
    """The options of chorus-fusion for one of the cells, beside its section "site"."""
    folder = pathlib.Path(folder)
    sensors = [{"id": name, "url": f"http://127.0.0.1:{p}/"} for name, p in sensor_ports.items()]
    options = {"title": f"Cell {cell}", "http.port": port, "sensors": json.dumps(sensors), "site.places": folder / "places.json",
               "site.url": f"http://127.0.0.1:{port}/", "registration.file": folder / f"{cell}.registration.json",
               "registration.auto": "false", "state_dir": folder / f"state-{cell}"}
    return [word for key, value in options.items() for word in ("--set", f"{key}={value}")]
