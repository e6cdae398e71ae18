#!/usr/bin/env python3
"""The rooms with unit tests whose files differ from a revision, one a line.

usage: changed_rooms.py [BASE]    BASE is a revision; default: HEAD~1
"""
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
# Folders whose unit tests have another name.
ALIAS = {"device/bridge": "push", "device/camera": "camera", "device/simulated": "simulated_device", "services/sensor": "sensor_service"}


def room_of(path, rooms):
    """The room that a file belongs to; None for files that no unit test compiles."""
    parts = pathlib.PurePosixPath(path).parts
    if parts[:2] == ("tests", "unit"):
        return parts[2] if len(parts) > 3 and parts[2] in rooms else None
    if parts[:1] not in (("common",), ("fusion-server",), ("services",)):
        return None
    for folder, room in ALIAS.items():
        if folder in path and room in rooms:
            return room
    return next((part for part in reversed(parts[:-1]) if part in rooms), None)


def changed_rooms(paths, rooms):
    return sorted({room for path in paths if (room := room_of(path, rooms))})


def main(base):
    rooms = {folder.name for folder in (ROOT / "tests/unit").iterdir() if folder.is_dir()}
    changed = subprocess.run(["git", "diff", "--name-only", base], cwd=ROOT, capture_output=True, text=True, check=True)
    print("\n".join(changed_rooms(changed.stdout.split(), rooms)))


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "HEAD~1")
