"""With CHORUS_ONLY_SENSOR, a system without OpenCV and PCL configures, and nothing that is then built asks for them.
Compiling it that way, for another architecture, is tested by tests/run.sh --arm64."""

import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = ("chorus-sensor-small", "chorus-host")


class OnlySensor(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.tree = Path(scratch.name)
        cls.configured = subprocess.run(
            ["cmake", "-S", str(ROOT), "-B", str(cls.tree), "--preset", "package", "-DCHORUS_ONLY_SENSOR=ON",
             "-DCMAKE_DISABLE_FIND_PACKAGE_OpenCV=ON"], cwd=ROOT, capture_output=True, text=True, check=False)

    def ninja(self, *words):
        return subprocess.run(["ninja", "-C", str(self.tree), *words], capture_output=True, text=True, check=True).stdout

    def test_the_programs_and_their_pages_need_neither_opencv_nor_pcl(self):
        self.assertEqual(self.configured.returncode, 0, self.configured.stderr)
        commands = self.ninja("-t", "commands", *PROGRAMS, "pages")
        self.assertIn("small_main.cpp", commands)
        self.assertEqual(re.findall(r".*(?:opencv|pcl_|/pcl-).*", commands), [])

    def test_the_packages_are_those_of_a_sensor_host(self):
        text = (self.tree / "CPackConfig.cmake").read_text()
        self.assertEqual(re.findall(r'CPACK_COMPONENTS_ALL "(.*)"', text), ["common;sensor"])


if __name__ == "__main__":
    unittest.main()
