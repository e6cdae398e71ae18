"""Makes the container image of chorus-sensor and runs it as its configuration says: by its user, without capabilities, on a read-only root,
with a network of its own.  By hand, as root: tests/run.sh --workshop

  CHORUS_PACKAGES=DIR   as in installed_root.py
  CHORUS_IMAGES=DIR     a folder in which deploy/make-image.sh has made it; otherwise it is made
"""

import hashlib
import json
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest
from pathlib import Path

import installed_root
from installed_root import PACKAGES, ROOT, run

MOST_MB = 60.0


class Image(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        installed_root.Installed.setUpClass()
        images = Path(os.environ.get("CHORUS_IMAGES", ROOT / "var/images"))
        if "CHORUS_IMAGES" not in os.environ:
            run(ROOT / "deploy/make-image.sh", "chorus-sensor", "--packages", PACKAGES, "--out", images)
        cls.archive = images / "chorus-sensor.tar"
        cls.folder = Path(tempfile.mkdtemp(prefix="chorus-image."))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        with tarfile.open(cls.archive) as archive:
            archive.extractall(cls.folder)
        index = json.loads((cls.folder / "index.json").read_text())
        cls.manifest = json.loads(cls.blob(index["manifests"][0]))
        cls.config = json.loads(cls.blob(cls.manifest["config"]))["config"]
        cls.root = cls.folder / "root"
        cls.root.mkdir()
        run("tar", "-C", cls.root, "-xzf", cls.path(cls.manifest["layers"][0]), "--exclude=./dev/*")

    @classmethod
    def path(cls, descriptor):
        return cls.folder / "blobs" / descriptor["digest"].replace(":", "/")

    @classmethod
    def blob(cls, descriptor):
        return cls.path(descriptor).read_bytes()

    def inside(self, command, sealed=False):
        """Runs a script in the image: first what a container runtime does, then bash as root.  Sealed: only its state may be written."""
        seal = "mount -o remount,bind,ro $0 && mount -t tmpfs -o uid=$2,mode=750 state $0$STATE_DIRECTORY && " if sealed else ""
        script = ("mount --make-rprivate / && mount --bind $0 $0 && mount -t proc proc $0/proc && mount -t tmpfs dev $0/dev && "
                  "for d in null zero urandom random; do touch $0/dev/$d; mount --bind /dev/$d $0/dev/$d; done; ip link set lo up; "
                  + seal + 'exec chroot "$0" bash -c "$1"')
        user = next(line.split(":") for line in (self.root / "etc/passwd").read_text().splitlines()
                    if line.startswith(self.config["User"] + ":"))
        done = subprocess.run(["unshare", "--mount", "--net", "--pid", "--fork", "--kill-child", "bash", "-c", script, str(self.root), command,
                               user[2]], capture_output=True, text=True, check=False, timeout=120,
                              env=dict(line.split("=", 1) for line in self.config["Env"]) | {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin"})
        return done.stdout + done.stderr

    def test_every_part_is_what_its_digest_says(self):
        for descriptor in (self.manifest["config"], *self.manifest["layers"]):
            data = self.blob(descriptor)
            self.assertEqual(hashlib.sha256(data).hexdigest(), descriptor["digest"].removeprefix("sha256:"))
            self.assertEqual(len(data), descriptor["size"])
        size = self.archive.stat().st_size / 1e6
        print(f"\nimage: {size:.0f} MB packed", file=sys.stderr)
        self.assertLess(size, MOST_MB)

    def test_it_holds_nothing_of_where_it_was_made(self):
        self.assertNotIn("file:", (self.root / "etc/apt/sources.list").read_text())
        self.assertEqual(list((self.root / "etc/chorus").iterdir()), [], "every container makes tokens of its own")

    def test_it_runs_as_it_says(self):
        start = (f"setpriv --reuid {self.config['User']} --regid chorus --clear-groups --bounding-set -all --no-new-privs -- "
                 + " ".join(self.config["Entrypoint"] + self.config["Cmd"]))
        self.assertIn("/etc/chorus/sensor.json: the configuration file cannot be read", self.inside(start))
        self.inside("chorus init sensor --id c1 --device simulated")
        said = self.inside(f"{start} 2>&1 & sleep 3; chorus doctor; touch /etc/x", sealed=True)
        self.assertIn("ok     chorus-sensor: answers at http://127.0.0.1:8081/", said)
        self.assertIn("ok     token of chorus-sensor: is taken", said)
        self.assertIn("Read-only file system", said)


if __name__ == "__main__":
    if os.geteuid() != 0:
        sys.exit("container_image: this needs root")
    unittest.main(verbosity=2)
