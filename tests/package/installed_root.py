"""Makes the packages, installs them without network into a fresh Debian root, and checks: the dependencies, the files, that the services
answer, and what upgrade, roll-back, removal and purge leave. By hand, as root: tests/run.sh --workshop

  CHORUS_PACKAGES=DIR   a folder that deploy/make-packages.sh has made; otherwise it is made
  CHORUS_ROOT=FILE      a tar of a root (mmdebstrap --variant=standard bookworm FILE); otherwise it is made and kept in var/
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = Path(os.environ.get("CHORUS_PACKAGES", ROOT / "var/packages"))
ROOT_TAR = Path(os.environ.get("CHORUS_ROOT", ROOT / "var/debian-standard.tar"))
MOST_FOR_A_SENSOR_MB = 40.0


def run(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, **options)


class Root(unittest.TestCase):
    """A fresh root for each test, with the packages in /packages."""
    packages, tar = PACKAGES, ROOT_TAR

    @classmethod
    def setUpClass(cls):
        if "CHORUS_PACKAGES" not in os.environ:
            run(ROOT / "deploy/make-packages.sh")
        cls.make_tar("--variant=standard")

    @classmethod
    def make_tar(cls, *options):
        if not cls.tar.exists():
            cls.tar.parent.mkdir(exist_ok=True)
            run("mmdebstrap", *options, "bookworm", cls.tar)

    def setUp(self):
        self.root = Path(tempfile.mkdtemp(prefix="chorus-root."))
        self.addCleanup(shutil.rmtree, self.root, ignore_errors=True)
        run("tar", "-C", self.root, "-xf", self.tar, "--exclude=./dev/*")
        (self.root / "usr/sbin/policy-rc.d").write_text("#!/bin/sh\nexit 101\n")  # a root that is not booted starts nothing
        (self.root / "usr/sbin/policy-rc.d").chmod(0o755)
        run("cp", "-r", self.packages, self.root / "packages")

    def inside(self, command, check=True, beside=None):
        """Runs a script in the root, with a network of its own: loopback only.  With `beside`, only as long as that script outside the
        root, which finds the root's folder in $0 and shares the network."""
        script = ("mount --make-rprivate / && mount -t proc proc $0/proc && mount -t tmpfs dev $0/dev && "
                  "for d in null zero urandom random; do touch $0/dev/$d; mount --bind /dev/$d $0/dev/$d; done; ip link set lo up; "
                  + ('chroot "$0" bash -c "$1" & exec bash -c "$2" "$0"' if beside else 'exec chroot "$0" bash -c "$1"'))
        done = subprocess.run(["unshare", "--mount", "--net", "--pid", "--fork", "bash", "-c", script, str(self.root), command, beside or ""],
                              capture_output=True, text=True, check=False,
                              env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "LC_ALL": "C.UTF-8", "DEBIAN_FRONTEND": "noninteractive"})
        if check:
            self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}")
        return done.stdout + done.stderr

    def sizes(self):
        """Installed packages and their size [MB]."""
        rows = self.inside("dpkg-query -W -f '${db:Status-Status} ${Package} ${Installed-Size}\\n'").splitlines()
        return {row.split()[1]: int(row.split()[2]) / 1024 for row in rows if row.startswith("installed ")}

    def install(self, *packages):
        before = self.sizes()
        self.inside(f"/packages/install.sh {' '.join(packages)}")
        after = self.sizes()
        brought = {name: size for name, size in after.items() if name not in before}
        own = {name for name in brought if name.startswith("chorus-")}
        others = sum(size for name, size in brought.items() if name not in own)
        print(f"\n{' '.join(packages)}: {len(brought) - len(own)} packages besides ours, {others:.1f} MB; "
              f"ours {sum(brought[name] for name in own):.1f} MB", file=sys.stderr)
        return brought, others

    def exists(self, path):
        return os.path.lexists(self.root / path.lstrip("/"))


class Installed(Root):
    def test_a_sensor_host_is_small_and_answers_within_a_minute(self):
        begun = time.monotonic()
        brought, others = self.install("chorus-sensor")
        self.assertLessEqual(others, MOST_FOR_A_SENSOR_MB)
        self.assertEqual([name for name in brought if re.search("opencv|pcl|gdal", name)], [])
        self.inside("chorus init sensor --id s1 --device simulated")
        text = self.inside(
            "mkdir -p /var/lib/chorus/sensor && chown chorus: /var/lib/chorus/sensor;"
            "runuser -u chorus -- chorus-sensor --config /etc/chorus/sensor.json --log-level warn & sleep 2;"
            'token=$(grep -o \'"token": "[0-9a-f]*", "role": "read"\' /etc/chorus/sensor.json | cut -d\\" -f4);'
            "curl -s -o /dev/null -w 'stranger %{http_code}\\n' http://127.0.0.1:8081/frame;"
            "curl -s -o /dev/null -w 'health %{http_code}\\n' http://127.0.0.1:8081/healthz;"
            "curl -s -o /dev/null -w 'reader %{http_code}\\n' -H \"Authorization: Bearer $token\" http://127.0.0.1:8081/frame;"
            "chorus doctor; true" if self.exists("/usr/bin/curl") else
            "mkdir -p /var/lib/chorus/sensor && chown chorus: /var/lib/chorus/sensor;"
            "runuser -u chorus -- chorus-sensor --config /etc/chorus/sensor.json --log-level warn & sleep 2; chorus doctor; true")
        took = time.monotonic() - begun
        print(f"from install.sh to answers: {took:.0f} s", file=sys.stderr)
        self.assertLess(took, 60)
        self.assertIn("ok     chorus-sensor: answers at http://127.0.0.1:8081/", text)
        self.assertIn("ok     token of chorus-sensor: is taken", text)
        self.assertIn("WRONG  clock", text, "nothing keeps the time in this root")

    def test_everything_is_where_it_belongs(self):
        self.install("chorus-fusion")
        for path in ("/usr/bin/chorus", "/usr/bin/chorus-fusion", "/lib/systemd/system/chorus-fusion.service", "/etc/default/chorus-fusion",
                     "/usr/share/chorus/viewer/index.html", "/usr/share/chorus/viewer/node_modules/three/build/three.module.min.js",
                     "/usr/share/chorus/viewer/panels/cockpit.js", "/usr/share/chorus/clients/chorus.py", "/usr/share/chorus/clients/Chorus.cs",
                     "/usr/share/chorus/viewer/node_modules/preact/dist/preact.mjs",
                     "/usr/share/chorus/viewer/node_modules/htm/dist/htm.mjs",
                     "/usr/share/chorus/viewer/node_modules/qrcode-generator/dist/qrcode.mjs",
                     "/usr/share/doc/chorus-fusion/examples/fusion.json", "/usr/share/man/man8/chorus-fusion.8",
                     "/usr/share/bash-completion/completions/chorus", "/etc/chorus", "/var/lib/chorus"):
            with self.subTest(path):
                self.assertTrue(self.exists(path) or self.exists(path + ".gz"))
        self.assertTrue(self.exists("/etc/systemd/system/multi-user.target.wants/chorus-fusion.service"), "it starts at boot")
        self.assertEqual(self.inside("stat -c '%a %U %G' /etc/chorus /var/lib/chorus").split("\n")[:2],
                         ["751 root chorus", "750 chorus chorus"])
        said = self.inside("chorus init fusion --sensor s1=http://127.0.0.1:8081/; "
                           "runuser -u chorus -- chorus-fusion --check --config /etc/chorus/fusion.json")
        self.assertIn("The configuration is good.", said)
        self.assertNotIn("viewer cannot be served", said)
        self.assertIn("exists and is not overwritten", self.inside("chorus init fusion", check=False))
        self.assertIn("apt install chorus-tools", self.inside("chorus fuse x --out y", check=False))

    def test_the_tools_bring_the_other_commands(self):
        self.install("chorus-tools")
        self.assertIn("fuse", self.inside("chorus --help"))
        self.assertEqual(self.inside("ldd /usr/libexec/chorus/chorus | grep 'not found'; true"), "")

    def another_version(self, version):
        """The sensor's package, as if built from a later commit."""
        for name in ("common", "sensor"):
            deb = next((self.root / "packages").glob(f"chorus-{name}_*.deb"))
            self.inside(f"dpkg-deb -R /packages/{deb.name} /tmp/{name} && cd /tmp/{name}/DEBIAN && "
                        f"sed -i 's/^Version: .*/Version: {version}/; s/chorus-common (= [^)]*)/chorus-common (= {version})/' control && "
                        f"echo '# newer' >> ../etc/default/chorus-sensor 2>/dev/null; "
                        f"dpkg-deb -b /tmp/{name} /tmp/chorus-{name}-new.deb")
        return "/tmp/chorus-common-new.deb /tmp/chorus-sensor-new.deb"

    def version(self):
        return self.inside("dpkg-query -W -f '${Version}' chorus-sensor")

    def test_upgrade_and_roll_back_keep_what_is_the_users(self):
        self.install("chorus-sensor")
        first = self.version()
        self.inside("chorus init sensor --id mine --device simulated; echo 'OPTIONS=\"--log-level warn\"' > /etc/default/chorus-sensor;"
                    "mkdir -p /var/lib/chorus/sensor/recordings && touch /var/lib/chorus/sensor/recordings/walk")
        self.inside("cd /etc/chorus && chmod 750 . && mkdir -m 750 tls && touch token tls/ca.crt && chmod 644 token tls/ca.crt")
        self.inside(f"dpkg --force-confdef --force-confold -i {self.another_version('99.0')}")
        self.assertEqual(self.version(), "99.0")
        self.assertEqual(self.inside("cd /etc/chorus && stat -c '%a %U %G' . token tls tls/ca.crt").split("\n")[:4],
                         ["751 root chorus", "640 root chorus", "751 root root", "644 root root"], "the opened folder opens no file")
        self.inside("/packages/install.sh chorus-sensor=" + first + " chorus-common=" + first)
        self.assertEqual(self.version(), first)
        self.assertIn("--log-level warn", self.inside("cat /etc/default/chorus-sensor"))
        self.assertIn('"mine"', self.inside("cat /etc/chorus/sensor.json"))
        self.assertTrue(self.exists("/var/lib/chorus/sensor/recordings/walk"))

    def test_removing_keeps_state_and_purging_does_not(self):
        self.install("chorus-sensor")
        announced = "/etc/avahi/services/chorus-sensor.service"
        self.inside("mkdir -p /etc/avahi/services; chorus init sensor --device simulated; mkdir -p /var/lib/chorus/sensor && touch /var/lib/chorus/sensor/x")
        self.assertTrue(self.exists(announced))
        self.inside("apt-get -y remove chorus-sensor")
        self.assertFalse(self.exists(announced), "a sensor that is gone is not announced")
        self.install("chorus-sensor")
        self.assertTrue(self.exists(announced), "and is again when it is back")
        self.inside("apt-get -y remove chorus-sensor")
        self.assertFalse(self.exists("/usr/bin/chorus-sensor"))
        for kept in ("/etc/chorus/sensor.json", "/var/lib/chorus/sensor/x", "/etc/default/chorus-sensor"):
            self.assertTrue(self.exists(kept), kept)
        self.inside("dpkg --purge chorus-sensor")
        for gone in ("/etc/chorus/sensor.json", "/var/lib/chorus/sensor", "/etc/default/chorus-sensor", announced, announced + ".removed"):
            self.assertFalse(self.exists(gone), gone)
        self.inside("dpkg --purge chorus-common")
        for gone in ("/etc/chorus", "/var/lib/chorus", "/usr/bin/chorus"):
            self.assertFalse(self.exists(gone), gone)


if __name__ == "__main__":
    if os.geteuid() != 0:
        sys.exit("installed_root: this needs root")
    unittest.main(verbosity=2)
