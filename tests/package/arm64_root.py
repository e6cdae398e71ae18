"""Makes the packages for arm64, installs them without network into a fresh Debian root of that architecture, and has the emulated sensor
serve a frame to a client outside.  By hand, as root on amd64: tests/run.sh --arm64

  CHORUS_PACKAGES_ARM64=DIR   a folder that deploy/make-packages.sh --arch arm64 has made; otherwise it is made
  CHORUS_ROOT_ARM64=FILE      a tar of an arm64 root, as CHORUS_ROOT in installed_root.py

The programs run under qemu.  Where the machine does not do that already, a user namespace has the kernel do it for this test alone, which
needs Linux 6.7.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import time
import unittest
from pathlib import Path

import installed_root  # not `from ... import`: its tests must not run here
from installed_root import MOST_FOR_A_SENSOR_MB, ROOT, run

PACKAGES = Path(os.environ.get("CHORUS_PACKAGES_ARM64", ROOT / "var/packages-arm64"))
ROOT_TAR = Path(os.environ.get("CHORUS_ROOT_ARM64", ROOT / "var/debian-important-arm64.tar"))
QEMU = "usr/bin/qemu-aarch64-static"  # in the root of deploy/package/cross-root.sh
BINFMT = Path("/proc/sys/fs/binfmt_misc")
MACHINE_ARM64 = 183  # e_machine of an ELF header, at byte 18
INSIDE = "--inside"
EMULATED_SECONDS = 60

# Asks for a frame until the sensor is up; then the emulated chorus looks at it, too.
CLIENT = """
for i in $(seq {tries}); do
  curl -sf -H 'Authorization: Bearer {token}' http://127.0.0.1:8081/frame.json && break
  sleep 1
done
echo
curl -s -o /dev/null -w 'stranger %{{http_code}}\\n' http://127.0.0.1:8081/frame
chroot $0 chorus doctor
exit 0
"""


class Arm64(installed_root.Root):
    packages, tar = PACKAGES, ROOT_TAR

    @classmethod
    def setUpClass(cls):
        # Not standard: what that adds takes emulated minutes (certificates, Python).  The check would look for the machine's own qemu.
        cls.make_tar("--variant=important", "--mode=root", "--architectures=arm64", "--skip=check/qemu")

    def test_a_sensor_host_is_small_and_serves_a_frame(self):
        brought, others = self.install("chorus-sensor")
        self.assertLessEqual(others, MOST_FOR_A_SENSOR_MB)
        self.assertEqual([name for name in brought if re.search("opencv|pcl|gdal", name)], [])
        self.assertEqual(self.inside("dpkg-query -W -f '${Architecture} ' chorus-sensor chorus-common"), "arm64 arm64 ")
        for program in ("chorus-sensor", "chorus"):
            header = (self.root / "usr/bin" / program).read_bytes()[:20]
            self.assertEqual((header[:4], int.from_bytes(header[18:20], "little")), (b"\x7fELF", MACHINE_ARM64))
            self.assertRegex(self.inside(f"{program} --version"), r"\d+\.\d+\.\d+")
        example = "/usr/share/doc/chorus-sensor/examples/sensor.json"
        self.assertIn("The configuration is good.", self.inside(f"runuser -u chorus -- chorus-sensor --check --config {example}"))

        self.inside("chorus init sensor --id s1 --device simulated; install -d -o chorus -g chorus /var/lib/chorus/sensor")
        token = re.search(r'"token": "([0-9a-f]+)", "role": "read"', (self.root / "etc/chorus/sensor.json").read_text()).group(1)
        begun = time.monotonic()
        said = self.inside("runuser -u chorus -- chorus-sensor --config /etc/chorus/sensor.json --log-level warn",
                           beside=CLIENT.format(tries=EMULATED_SECONDS, token=token))
        print(f"emulated, from start to answers: {time.monotonic() - begun:.0f} s", file=sys.stderr)
        frame = next(json.loads(line) for line in said.splitlines() if line.startswith("{"))
        self.assertEqual((frame["source"], [len(body["joints"]) for body in frame["bodies"]]), ("s1", [25]))
        self.assertIn("stranger 401", said)
        self.assertIn("ok     chorus-sensor: answers at http://127.0.0.1:8081/", said)
        self.assertIn("ok     token of chorus-sensor: is taken", said)

    def test_the_pages_are_there_and_a_camera_is_refused(self):
        self.install("chorus-sensor")
        for page in ("man/man8/chorus-sensor.8", "man/man1/chorus.1"):
            self.assertTrue(self.exists(f"/usr/share/{page}.gz"), page)
        for program in ("chorus-sensor", "chorus"):
            self.assertIn("--version", (self.root / f"usr/share/bash-completion/completions/{program}").read_text())
        self.assertIn("apt install chorus-camera", self.inside("chorus-sensor --device camera --port 0", check=False))
        self.assertIn("apt install chorus-tools", self.inside("chorus fuse x --out y", check=False))

    def test_purging_leaves_nothing(self):
        self.install("chorus-sensor")
        self.inside("chorus init sensor --device simulated; dpkg --purge chorus-sensor chorus-common")
        for gone in ("/etc/chorus", "/var/lib/chorus", "/usr/bin/chorus", "/etc/default/chorus-sensor"):
            self.assertFalse(self.exists(gone), gone)


def emulate():
    """Has the kernel run programs for arm64 with qemu, in our own namespace."""
    qemu = next((str(path) for path in (ROOT / "var/cross-arm64" / QEMU, Path("/", QEMU)) if path.exists()), None)
    if qemu is None:
        sys.exit("arm64_root: there is no qemu-aarch64-static: deploy/package/cross-root.sh true makes a root that has it")
    run("mount", "-t", "binfmt_misc", "none", BINFMT)
    magic = r"\x7fELF\x02\x01\x01\x00\x00\x00\x00\x00\x00\x00\x00\x00\x02\x00\xb7\x00"
    mask = r"\xff\xff\xff\xff\xff\xff\xff\x00\xff\xff\xff\xff\xff\xff\xff\xff\xfe\xff\xff\xff"
    (BINFMT / "register").write_text(f":qemu-aarch64:M::{magic}:{mask}:{qemu}:F")  # F: opened now, so that it need not be in the root


def again_in_a_namespace():
    """Runs this program once more, with the same users, in a user namespace of its own."""
    words = [sys.executable, "-B", __file__, INSIDE, *sys.argv[1:]]
    child = subprocess.Popen(["unshare", "--user", "--mount", "sh", "-c", 'read _ && exec "$@"', "sh", *words], stdin=subprocess.PIPE)
    own = os.readlink("/proc/self/ns/user")
    while child.poll() is None and os.readlink(f"/proc/{child.pid}/ns/user") == own:
        time.sleep(0.01)
    for kind in ("uid_map", "gid_map"):
        Path(f"/proc/{child.pid}/{kind}").write_text("0 0 65536\n")
    child.communicate(b"\n")
    return child.returncode


if __name__ == "__main__":
    if os.geteuid() != 0:
        sys.exit("arm64_root: this needs root")
    if INSIDE in sys.argv:
        sys.argv.remove(INSIDE)
        emulate()
    else:
        if "CHORUS_PACKAGES_ARM64" not in os.environ:
            run(ROOT / "deploy/make-packages.sh", "--arch", "arm64")
        if not (BINFMT / "qemu-aarch64").exists():
            sys.exit(again_in_a_namespace())
    unittest.main(verbosity=2)
