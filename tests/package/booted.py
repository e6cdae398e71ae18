"""Boots a Debian root with the packages under systemd, in a container, and checks what only an init can show: both services start at boot in
their sandboxes and tell when they are ready; the sensor is restarted when it is killed or stands still; configuration, state and
registration are there after a reboot.
By hand, as root: tests/run.sh --workshop.  Left out where the kernel lets systemd-nspawn boot nothing.

CHORUS_PACKAGES and CHORUS_ROOT as in installed_root.py.
"""

import json
import os
import shutil
import subprocess
import sys
import time
import unittest
from pathlib import Path

import installed_root


UNITS = ("chorus-sensor", "chorus-fusion")
# Where the sensor stands, as a walk would have left it in the state of the fusion server.
PLACE = '{"sensors": {"b1": {"x": 0.5, "y": 1.2, "z": -2, "qx": 0, "qy": 0, "qz": 0, "qw": 1}}}'


def wait_for(what, holds, patience=60.0):
    until = time.monotonic() + patience
    while time.monotonic() < until:
        if holds():
            return
        time.sleep(0.1)
    raise AssertionError(f"not within {patience:.0f} s: {what}")


class Machine:
    """A booted root, until it is switched off."""

    def __init__(self, root):
        self.root, self.nspawn, self.leader = root, None, None

    def boot(self):
        self.nspawn = subprocess.Popen(["systemd-nspawn", "--quiet", "-D", str(self.root), "--boot", "--register=no", "--keep-unit", "--private-network",
                                        "--console=pipe"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.leader = None
        wait_for("it boots", lambda: self.nspawn.poll() is not None or self.find_leader(), 30)
        if self.nspawn.poll() is not None:
            raise unittest.SkipTest("systemd-nspawn boots nothing here: " + self.nspawn.stdout.read()[-300:])
        wait_for("it is up", lambda: self.do("systemctl is-system-running").strip() in ("running", "degraded"))

    def find_leader(self):
        children = Path(f"/proc/{self.nspawn.pid}/task/{self.nspawn.pid}/children").read_text().split()
        self.leader = next((pid for pid in children if "systemd" in Path(f"/proc/{pid}/cmdline").read_text()
                            and "nspawn" not in Path(f"/proc/{pid}/cmdline").read_text()), None)
        return self.leader

    def do(self, command):
        done = subprocess.run(["nsenter", "-t", self.leader, "-a", "--", "bash", "-c", command], capture_output=True, text=True, check=False,
                              env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "LC_ALL": "C.UTF-8"})
        return done.stdout + done.stderr

    def show(self, name, unit="chorus-sensor"):
        return self.do(f"systemctl show --value -p {name} {unit}").strip()

    def pid(self, unit="chorus-sensor"):
        return int(self.show("MainPID", unit))

    def active(self, unit="chorus-sensor"):
        return self.do(f"systemctl is-active {unit}").strip() == "active" and self.pid(unit) > 0

    def both_active(self):
        return all(self.active(unit) for unit in UNITS)

    def off(self):
        if self.nspawn is None:
            return
        if self.nspawn.poll() is None:
            if self.leader:
                self.do("systemctl poweroff")
            try:
                self.nspawn.wait(30 if self.leader else 1)
            except subprocess.TimeoutExpired:
                self.nspawn.kill()
                self.nspawn.wait()
        self.nspawn.stdout.close()


@unittest.skipUnless(shutil.which("systemd-nspawn"), "runs where systemd-nspawn is installed (Debian: systemd-container)")
class Booted(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        installed_root.Installed.setUpClass()
        cls.maker = installed_root.Installed()
        cls.maker.setUp()
        cls.addClassCleanup(cls.maker.doCleanups)
        cls.maker.install(*UNITS)
        cls.maker.inside("chorus init sensor --id b1 --device simulated && "
                         "token=$(sed -n 's/.*\"token\": \"\\([0-9a-f]*\\)\", \"role\": \"read\".*/\\1/p' /etc/chorus/sensor.json) && "
                         "chorus init fusion --sensor b1=http://127.0.0.1:8081/,$token && "
                         "install -d -o chorus -g chorus -m 750 /var/lib/chorus/fusion && "
                         f"echo '{PLACE}' > /var/lib/chorus/fusion/registration.json && chown chorus: /var/lib/chorus/fusion/registration.json && "
                         "rm -r /packages && rm -f /usr/sbin/policy-rc.d")
        cls.machine = Machine(cls.maker.root)
        cls.addClassCleanup(cls.machine.off)  # before it boots, which can fail halfway
        cls.machine.boot()
        wait_for("the services are up", cls.machine.both_active)

    def test_1_both_are_ready_and_shut_in(self):
        said = self.machine.do("chorus doctor")
        self.assertIn("ok     chorus-sensor: answers at", said)
        self.assertIn("ok     token of chorus-fusion: is taken", said)
        self.assertIn("ok     sensor b1: answers at", said)
        for unit in UNITS:
            with self.subTest(unit):
                self.assertEqual(self.machine.show("WatchdogUSec", unit), "20s")
                self.assertEqual(self.machine.show("NRestarts", unit), "0")
                status = self.machine.do(f"cat /proc/{self.machine.pid(unit)}/status")
                self.assertIn("CapEff:\t0000000000000000", status)
                self.assertIn("NoNewPrivs:\t1", status)
                self.assertIn("Seccomp:\t2", status)
                self.assertRegex(self.machine.do(f"systemd-analyze --no-pager security {unit}"), r"Overall exposure level .*: [01]\.\d OK")
                self.assertEqual(self.machine.do(f"systemd-analyze verify {unit}.service"), "")

    def test_2_it_is_restarted_when_killed(self):
        before, begun = self.machine.pid(), time.monotonic()
        self.machine.do(f"kill -9 {before}")
        wait_for("it is back", lambda: self.machine.active() and self.machine.pid() != before)
        print(f"\nkilled, and back after {time.monotonic() - begun:.1f} s", file=sys.stderr)

    def test_3_the_watchdog_ends_what_stands_still(self):
        before, begun = self.machine.pid(), time.monotonic()
        self.machine.do(f"kill -STOP {before}")
        wait_for("it is back", lambda: self.machine.active() and self.machine.pid() != before, 90)
        print(f"\nstopped, and back after {time.monotonic() - begun:.1f} s", file=sys.stderr)
        self.assertIn("watchdog", self.machine.do("journalctl -u chorus-sensor").lower())

    def fused(self):
        """The server has the sensor's place, and a frame of it."""
        said = self.machine.do("CHORUS_TOKEN=$(grep -o '[0-9a-f]\\{32\\}' /etc/chorus/fusion.json | head -1) chorus status --json || true")
        told = json.loads(said) if said.startswith("{") else {}
        return "b1" in told.get("registration", {}).get("sensors", {}) and "b1" in str((told.get("frame") or {}).get("sensors"))

    def test_4_a_reboot_keeps_what_was_there(self):
        config = self.machine.do("cat /etc/chorus/sensor.json; touch /var/lib/chorus/sensor/kept")
        self.machine.off()
        self.machine.boot()
        wait_for("the services are up by themselves", self.machine.both_active)
        wait_for("b1 is in the fused frames at its place", self.fused)
        self.assertEqual(self.machine.do("cat /var/lib/chorus/fusion/registration.json | tr -d ' \\n' | grep -c b1").strip(), "1")
        self.assertEqual(self.machine.do("cat /etc/chorus/sensor.json"), config)
        self.assertEqual(self.machine.do("stat -c %U /var/lib/chorus/sensor; cd /var/lib/chorus/sensor; ls kept").split(), ["chorus", "kept"])
        self.assertIn("ok     token of chorus-sensor: is taken", self.machine.do("chorus doctor"))


if __name__ == "__main__":
    if os.geteuid() != 0:
        sys.exit("booted: this needs root")
    unittest.main(verbosity=2)
