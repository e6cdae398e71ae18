"""chorus discover finds what chorus init announced, with a real avahi-daemon in a network of its own; and says plainly what is
missing.  The parts with Avahi run as root where avahi-daemon and avahi-utils are installed (tests/run.sh --workshop installs them)."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

BIN = Path(os.environ["CHORUS_BIN"]).resolve()
NEEDED = ("avahi-daemon", "avahi-browse", "dbus-daemon", "unshare", "ip")

BUS = """<!DOCTYPE busconfig PUBLIC "-//freedesktop//DTD D-Bus Bus Configuration 1.0//EN"
 "http://www.freedesktop.org/standards/dbus/1.0/busconfig.dtd">
<busconfig><type>system</type><listen>unix:path={folder}/bus</listen><auth>EXTERNAL</auth><policy context="default">
<allow own="*"/><allow send_destination="*"/><allow receive_sender="*"/><allow user="*"/></policy></busconfig>"""
CONFIG = "[server]\nhost-name=sensor-1\nuse-ipv6=no\nallow-interfaces=d0\n"

# A network with one interface, a bus, and the daemon; all of them end with the script.
HOST = r"""
set -eu
cd {folder}
ip link set lo up
ip link add d0 type veth peer d1
ip addr add 10.9.0.1/24 dev d0
ip link set d0 up
ip link set d1 up
mkdir -p services /etc/avahi /run/avahi-daemon
mount --bind {folder} /etc/avahi
{bin}/chorus init sensor --id s1 --out {folder}/sensor.json --announce {folder}/services --no-tls
export DBUS_SYSTEM_BUS_ADDRESS=unix:path={folder}/bus
dbus-daemon --config-file={folder}/bus.conf --nofork & bus=$!
trap 'kill $bus $daemon 2>/dev/null || true' EXIT
daemon=$bus
for i in $(seq 50); do [ -S bus ] && break; sleep 0.1; done
avahi-daemon --no-drop-root --no-chroot --no-rlimits --no-proc-title -f {folder}/avahi.conf & daemon=$!
for i in $(seq 20); do
  if {bin}/chorus discover --json > found.json; then break; fi
  sleep 0.5
done
{bin}/chorus init fusion --discover --out fusion.json
kill $daemon; wait $daemon || true
{bin}/chorus discover 2> without.txt && exit 1
exit 0
"""


class Discovery(unittest.TestCase):
    def test_without_avahi_it_says_what_to_install(self):
        with tempfile.TemporaryDirectory() as folder:
            os.symlink(shutil.which("sh"), Path(folder) / "sh")
            done = subprocess.run([BIN / "chorus", "discover"], capture_output=True, text=True, timeout=30, check=False,
                                  env={"PATH": folder})
            self.assertEqual(done.returncode, 1)
            self.assertIn("apt install avahi-daemon avahi-utils", done.stderr)

    @unittest.skipUnless(os.geteuid() == 0 and all(shutil.which(name) for name in NEEDED),
                         f"runs as root where these are installed: {', '.join(NEEDED)}")
    def test_what_init_announces_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "bus.conf").write_text(BUS.format(folder=folder))
            Path(folder, "avahi.conf").write_text(CONFIG)
            done = subprocess.run(["unshare", "-n", "-m", "bash", "-c", HOST.format(folder=folder, bin=BIN)], capture_output=True,
                                  text=True, timeout=60, check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            found = json.loads(Path(folder, "found.json").read_text())
            self.assertEqual([(each["id"], each["url"]) for each in found], [("s1", "http://10.9.0.1:8081/")])
            self.assertIn("http://10.9.0.1:8081/", Path(folder, "fusion.json").read_text())
            self.assertIn("is not running on this host", Path(folder, "without.txt").read_text())


if __name__ == "__main__":
    unittest.main()
