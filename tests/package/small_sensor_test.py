"""A sensor host stays small: neither its service nor the small `chorus` links libraries for pictures or point clouds.
What that saves is measured by tests/run.sh --workshop."""

import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

BIN = Path(os.environ["CHORUS_BIN"])
NEEDED = re.compile(r"\(NEEDED\)\s+Shared library: \[([^\]]+)\]")
# Names of libraries that are in every Debian root, or are small.
SMALL = ("libc", "libm", "libstdc++", "libgcc_s", "ld-linux", "libfmt", "libspdlog", "libserd-0", "libzstd", "libcrypto", "libssl", "libz", "libexpat",
         "libjpeg", "liblz4", "libcrypt")
LARGE = ("libopencv", "libpcl")


def needed(program):
    text = subprocess.run(["readelf", "-d", str(BIN / program)], capture_output=True, text=True, check=True).stdout
    return NEEDED.findall(text)


class SmallHost(unittest.TestCase):
    def test_what_every_host_gets_links_small_libraries_only(self):
        for program in ("chorus-sensor-small", "chorus-host"):
            with self.subTest(program):
                libraries = needed(program)
                self.assertGreater(len(libraries), 3)
                others = [name for name in libraries if not name.startswith(tuple(f"{small}." for small in SMALL) + ("ld-linux",))]
                self.assertEqual(others, [], "a new library: is it small, and in no package that brings a hundred others?")

    def test_the_whole_program_links_the_large_ones(self):
        for program in ("chorus", "chorus-sensor"):
            self.assertTrue([name for name in needed(program) if name.startswith(LARGE)], "then the test above sees nothing")

    def test_a_camera_is_refused_with_the_package_to_install(self):
        done = subprocess.run([str(BIN / "chorus-sensor-small"), "--device", "camera", "--port", "0"], capture_output=True, text=True,
                              check=False, timeout=20)
        self.assertEqual(done.returncode, 2)
        self.assertIn("apt install chorus-camera", done.stderr)

    def test_the_capture_page_is_refused_with_the_package_to_install(self):
        with tempfile.TemporaryDirectory() as folder:  # alone: beside the sources it would find the page
            program = shutil.copy(BIN / "chorus-sensor-small", folder)
            done = subprocess.run([program, "--device", "bridge", "--set", "device.bridge.page=true", "--port", "0"], cwd=folder,
                                  capture_output=True, text=True, check=False, timeout=20)
        self.assertEqual(done.returncode, 2)
        self.assertIn("apt install chorus-camera", done.stderr)


class SmallChorus(unittest.TestCase):
    def run_small(self, *arguments):
        return subprocess.run([str(BIN / "chorus-host"), *arguments], capture_output=True, text=True, check=False)

    def test_it_knows_the_commands_of_a_host(self):
        text = self.run_small("--help").stdout
        for command in ("init", "doctor", "status", "register", "record"):
            self.assertRegex(text, rf"\n  {command} ")
        self.assertNotRegex(text, r"\n  fuse ")

    def test_it_says_where_the_others_are(self):
        for command in ("import", "replay", "fuse", "export"):
            done = self.run_small(command, "x")
            self.assertEqual(done.returncode, 2)
            self.assertIn("apt install chorus-tools", done.stderr)


if __name__ == "__main__":
    unittest.main()
