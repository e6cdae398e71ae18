"""The systemd units are well-formed, and their services are sandboxed: `systemd-analyze` says OK."""

import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
UNITS = sorted((ROOT / "deploy/package").glob("*.service"))
SITE = "chorus-site"  # runs Debian's nats-server, which neither notifies systemd nor reads the state of the clock
MOST_EXPOSED = 2.0  # exposure, of ten; systemd calls values up to about 2 OK


def analyze(*arguments):
    return subprocess.run(["systemd-analyze", *arguments], capture_output=True, text=True, check=False)


def runnable(unit, folder):
    """The unit with a program and a manual page that exist before the package is installed."""
    text = re.sub(r"/usr/s?bin/(?:chorus-\w+|nats-server) [^\n]*", "/bin/true", unit.read_text(encoding="utf-8"))
    text = re.sub(r"^Documentation=.*\n", "", text, flags=re.MULTILINE)
    copy = Path(folder) / unit.name
    copy.write_text(text)
    return copy


@unittest.skipUnless(shutil.which("systemd-analyze"), "runs where systemd-analyze is installed (Debian: systemd)")
class Units(unittest.TestCase):
    def test_there_is_one_for_each_service(self):
        self.assertEqual([unit.stem for unit in UNITS], ["chorus-ergonomics", "chorus-evaluation", "chorus-fusion", "chorus-sensor", SITE])

    def test_systemd_finds_nothing_wrong(self):
        with tempfile.TemporaryDirectory() as folder:
            for unit in UNITS:
                with self.subTest(unit.name):
                    done = analyze("verify", str(runnable(unit, folder)))
                    own = [line for line in done.stderr.splitlines() if unit.name in line]
                    self.assertEqual(own, [])

    def test_the_service_is_shut_in(self):
        for unit in UNITS:
            with self.subTest(unit.name):
                done = analyze("security", "--offline=true", "--no-pager", str(unit))
                verdict = re.search(r"exposure level for \S+: ([\d.]+) (\w+)", done.stdout)
                self.assertTrue(verdict, done.stdout[-500:] + done.stderr)
                self.assertLessEqual(float(verdict[1]), MOST_EXPOSED)
                self.assertEqual(verdict[2], "OK")

    def test_an_open_unit_is_seen(self):
        with tempfile.TemporaryDirectory() as folder:
            bare = Path(folder) / "bare.service"
            bare.write_text("[Service]\nExecStart=/bin/true\nWrong=yes\n")
            self.assertIn("Wrong", analyze("verify", str(bare)).stderr)
            self.assertNotIn(" OK ", analyze("security", "--offline=true", "--no-pager", str(bare)).stdout[-80:])


class Promises(unittest.TestCase):
    """What the guide says about the units is in them."""

    def test_each_unit(self):
        for unit in UNITS:
            text = unit.read_text(encoding="utf-8")
            if unit.stem == SITE:
                for line in ("Restart=always", "User=chorus", "ProtectSystem=strict", "ConditionPathExists=/etc/chorus/site/nats-server.conf",
                             "Conflicts=nats-server.service", "After=nats-server.service"):
                    self.assertIn(f"\n{line}\n", text)
                continue
            with self.subTest(unit.name):
                for line in ("Type=notify", "WatchdogSec=20", "Restart=always", "User=chorus", "ProtectSystem=strict",
                             f"ConditionPathExists=/etc/chorus/{unit.stem.removeprefix('chorus-')}.json"):
                    self.assertIn(f"\n{line}\n", text)
                self.assertRegex(text, r"\nMemoryMax=\d+[MG]\n")
                # The state of the clock is read with adjtimex.
                self.assertRegex(text, r"\nSystemCallFilter=.*adjtimex")
                self.assertNotIn("ProtectClock", text)

    def test_a_busy_host_does_not_pause_fusion(self):
        text = (ROOT / "deploy/package/chorus-fusion.service").read_text(encoding="utf-8")
        for line in ("CPUWeight=1000", "Nice=-10"):
            self.assertIn(f"\n{line}\n", text)


if __name__ == "__main__":
    unittest.main()
