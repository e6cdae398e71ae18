"""Runs the real `chorus` program: functions shared by its tests."""

import os
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
BIN = Path(os.environ.get("CHORUS_BIN", "build/dev/bin"))
CAMERAS = "tests/data/pose2sim_mediapipe"


def chorus(*arguments, seconds=60):
    """Runs chorus; returns (exit code, standard output, standard error)."""
    done = subprocess.run([BIN / "chorus", *map(str, arguments)], capture_output=True, text=True, timeout=seconds)
    return done.returncode, done.stdout, done.stderr
