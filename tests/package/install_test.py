"""deploy/package/install.sh says what to do before it changes anything."""

import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


class Install(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        shutil.copy(ROOT / "deploy/package/install.sh", self.folder)
        (self.folder / "chorus-sensor_1_amd64.deb").touch()
        (self.folder / "SYSTEM").write_text("another-1-amd64\n")
        (self.folder / "Packages").write_text("Package: chorus-sensor\nVersion: 1\n\nPackage: libfmt9\n")

    def refused(self, *words):
        done = subprocess.run([self.folder / "install.sh", *words], capture_output=True, text=True, check=False)
        self.assertNotEqual(done.returncode, 0)
        return done.stderr

    def test_without_a_package_it_says_how_it_is_used(self):
        self.assertIn("./install.sh chorus-sensor", self.refused())

    def test_a_package_that_is_not_there_is_answered_with_those_that_are(self):
        for wrong in ("chorus-senser", "--reinstall"):
            self.assertIn(f"no package {wrong} here; there are: chorus-sensor \n", self.refused(wrong))

    def test_the_packages_themselves_may_come_after_the_list(self):
        (self.folder / "chorus-sensor_1_amd64.deb").unlink()
        self.assertRegex(self.refused("--list", "chorus-sensor"), "run this as root|these packages are for another-1-amd64")

    def test_half_a_folder_is_refused(self):
        (self.folder / "SYSTEM").unlink()
        self.assertIn("copy again all", self.refused("chorus-sensor"))

    def test_a_version_may_be_named(self):
        self.assertRegex(self.refused("chorus-sensor=1"), "run this as root|these packages are for another-1-amd64")


if __name__ == "__main__":
    unittest.main()
