"""A workshop of separate hosts, from the packages: three sensor hosts, a fusion host and a client, each a fresh Debian root with a network
and processes of its own, joined by a switch that delays every frame by 20 ms and more, loses 2 % and reorders (bad_switch.py); two sensor
hosts have wrong clocks.  Follows the commands of docs/guide/workshop.md to a registered, fused tracker behind TLS,
then does things wrong once.  By hand, as root: tests/run.sh --workshop

Stand-ins: the wrong clocks are the key `clock` in /etc/default/chorus-sensor; `systemctl` starts what the unit's ExecStart says, since a root that is not booted has no systemd; ssh is nsenter; the time of
these hosts is the machine's, so that chrony has nothing to do.  CHORUS_PACKAGES and CHORUS_ROOT as in installed_root.py.
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

import installed_root  # not `from ... import`: its tests must not run here
from installed_root import PACKAGES, ROOT, ROOT_TAR

GUIDE = (ROOT / "docs/guide/workshop.md").read_text(encoding="utf-8")
SYSTEMCTL = r"""#!/bin/bash
# What systemd does with our units, as far as these tests need it.
task=$1 unit=${2%.service}
[[ $unit == chorus-* ]] || exit 0
pid=/run/$unit.pid
case $task in
  restart|start)
    [[ ! -e $pid ]] || { kill $(cat $pid); while kill -0 $(cat $pid) 2>/dev/null; do sleep 0.05; done; }
    kind=${unit#chorus-}
    [[ -e /etc/chorus/$kind.json ]] || exit 0
    install -d -o chorus -g chorus -m 750 /var/lib/chorus/$kind /run/$unit
    command=$(sed -n 's/^ExecStart=//p' /lib/systemd/system/$unit.service)
    OPTIONS=; . /etc/default/$unit
    setsid setpriv --reuid chorus --regid chorus --clear-groups -- $(eval echo "$command") >>/var/log/$unit.log 2>&1 </dev/null &
    echo $! > $pid ;;
  stop) kill $(cat $pid); rm -f $pid ;;
  reload) kill -HUP $(cat $pid) ;;
esac
"""


def run(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, **options)


def commands_of_guide():
    """The lines of the guide that users type, in order."""
    return [line.strip().split("   #")[0] for line in GUIDE.splitlines()
            if re.match(r"    (deploy/workshop\.sh|sudo sh -c)", line)]


# What the switch does to each frame: delay and jitter [ms], loss [%].
SWITCH = ("20", "5", "2")
# Clocks that are wrong [ms], so that chorus doctor names them; frames are corrected by what their answers tell.
WRONG_CLOCKS = {"sensor-2": 150, "sensor-3": -90}


class Host:
    """A Debian root with its own processes, network and host name, until it is closed."""

    def __init__(self, name, address, folder, pristine=ROOT_TAR):
        self.name, self.address, self.root = name, address, folder / name
        self.root.mkdir()
        run("tar", "-C", self.root, "-xf", pristine, "--exclude=./dev/*")
        self.write("usr/sbin/policy-rc.d", "#!/bin/sh\nexit 101\n")
        self.write("usr/local/bin/systemctl", SYSTEMCTL)
        script = ("mount --make-rprivate / && mount -t proc proc $0/proc && mount -t tmpfs dev $0/dev && mkdir $0/dev/shm && "
                  "for d in null zero urandom random; do touch $0/dev/$d; mount --bind /dev/$d $0/dev/$d; done; "
                  'hostname "$1"; ip link set lo up; exec chroot "$0" sleep infinity')
        self.keeper = subprocess.Popen(["unshare", "--mount", "--net", "--uts", "--pid", "--fork", "--kill-child", "bash", "-c", script,
                                        str(self.root), name])
        children = Path(f"/proc/{self.keeper.pid}/task/{self.keeper.pid}/children")
        while not (found := children.read_text().split()) or "sleep" not in Path(f"/proc/{found[0]}/cmdline").read_text():
            time.sleep(0.05)
        self.pid = found[0]

    def plug_in(self):
        """When the switch has given it eth0."""
        run("nsenter", "-t", self.pid, "-n", "ip", "address", "add", f"{self.address}/24", "dev", "eth0")
        run("nsenter", "-t", self.pid, "-n", "ip", "link", "set", "eth0", "up")

    def write(self, path, text):
        (self.root / path).write_text(text)
        (self.root / path).chmod(0o755)

    def enter(self):
        """The command that replaces ssh root@host."""
        return ["nsenter", "-t", self.pid, "-m", "-n", "-u", "-p", "env", "-i", "PATH=/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin",
                "LC_ALL=C.UTF-8", "DEBIAN_FRONTEND=noninteractive", "chroot", str(self.root), "bash", "-c"]

    def do(self, command, check=True, **options):
        done = subprocess.run([*self.enter(), command], capture_output=True, text=True, check=False, **options)
        if check and done.returncode != 0:
            raise AssertionError(f"{self.name}: {command}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}")
        return done.stdout + done.stderr

    def close(self):
        self.keeper.kill()
        self.keeper.wait()


class Workshop(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        installed_root.Installed.setUpClass()
        cls.folder = Path(tempfile.mkdtemp(prefix="chorus-workshop."))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        cls.hosts = {}
        for name, address in (("fusion", "10.0.0.10"), ("sensor-1", "10.0.0.11"), ("sensor-2", "10.0.0.12"), ("sensor-3", "10.0.0.13"),
                              ("client", "10.0.0.20")):
            cls.hosts[name] = Host(name, address, cls.folder)
            cls.addClassCleanup(cls.hosts[name].close)
        cls.connect()
        for name, wrong in WRONG_CLOCKS.items():
            cls.hosts[name].write("etc/default/chorus-sensor", f"OPTIONS='--set clock.offset_ms={wrong}'\n")
        cls.write_inventory()
        cls.write_ssh()
        cls.begun = time.monotonic()
        cls.said = [cls.follow(line) for line in commands_of_guide()[:2]]
        cls.laid_out_after = time.monotonic() - cls.begun

    @classmethod
    def connect(cls):
        switch = [sys.executable, "-B", Path(__file__).with_name("bad_switch.py"), *SWITCH, *(host.pid for host in cls.hosts.values())]
        cls.switch = subprocess.Popen(switch, stdout=subprocess.PIPE, text=True)
        cls.addClassCleanup(cls.switch.stdout.close)
        cls.addClassCleanup(cls.switch.wait)
        cls.addClassCleanup(cls.switch.kill)
        if cls.switch.stdout.readline() != "ready\n":
            raise AssertionError("bad_switch.py makes no devices here")
        for host in cls.hosts.values():
            host.plug_in()

    @classmethod
    def write_inventory(cls):
        """The guide's inventory, but with sensors that need no hardware: the only file that is edited."""
        text = re.search(r"\n((?:    .*\n)+)", GUIDE[GUIDE.index("`inventory.json`"):]).group(1)
        inventory = json.loads(text)
        for sensor in inventory["sensors"]:
            sensor["device"] = "simulated"
        inventory["packages"] = str(PACKAGES)
        (cls.folder / "inventory.json").write_text(json.dumps(inventory))

    @classmethod
    def write_ssh(cls):
        rows = "".join(f"  root@{host.address}|root@{name}.local) exec {' '.join(host.enter())} \"$2\" ;;\n"
                       for name, host in cls.hosts.items())
        (cls.folder / "ssh").write_text(f"#!/bin/bash\ncase $1 in\n{rows}esac\necho \"no host $1\" >&2; exit 255\n")
        (cls.folder / "ssh").chmod(0o755)

    @classmethod
    def follow(cls, line, check=False):
        """Runs a command of the guide on the host where the guide types it."""
        if line.startswith("sudo"):
            return cls.hosts["fusion"].do(line.removeprefix("sudo "), check=check)
        command = line.replace("deploy/", f"{ROOT}/deploy/").replace("inventory.json", str(cls.folder / "inventory.json"))
        done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False,
                              env={**os.environ, "CHORUS_SSH": str(cls.folder / "ssh")})
        return done.stdout + done.stderr

    def token(self):
        return re.search(r'"token": "([0-9a-f]+)", "role": "read"', (self.hosts["fusion"].root / "etc/chorus/fusion.json").read_text()).group(1)

    def client(self, *command, check=True):
        """Runs a program of this machine in the client's network; the client needs none of our packages."""
        done = subprocess.run(["nsenter", "-t", self.hosts["client"].pid, "-n", *map(str, command)], capture_output=True, text=True,
                              check=False, timeout=60)
        if check:
            self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def curl(self, path, *options, host="10.0.0.10:8080", check=True):
        return self.client("curl", "-sS", "--max-time", "10", "--cacert", self.folder / "ca.crt", "-H",
                           f"Authorization: Bearer {self.token()}", *options, f"https://{host}{path}", check=check)

    def test_1_laying_out_makes_hosts_that_are_well(self):
        print(f"\nlaid out and checked four hosts in {self.laid_out_after:.0f} s", file=sys.stderr)
        self.assertIn("laid out; next:", self.said[0], self.said[0][-3000:])
        wrong = [line for line in self.said[1].splitlines() if line.startswith("WRONG")]
        # Nothing synchronises the clock of this machine, and nobody has walked yet.
        unexpected = [line for line in wrong if not re.match("WRONG  (clock:|chorus-fusion: |sensor s[23]: its clock is)", line)]
        self.assertEqual(unexpected, [], self.said[1])
        self.assertRegex(self.said[1], "ok     sensor s1: answers at https://")
        self.assertRegex(self.said[1], r"WRONG  sensor s2: its clock is 1[2-7]\d ms ahead of ours")
        self.assertRegex(self.said[1], r"WRONG  sensor s3: its clock is (6|7|8|9|10|11)\d ms behind ours")
        self.assertEqual(self.said[1].count("ok     certificate /etc/chorus/tls/host.crt: good until"), 4)

    def test_2_a_walk_registers_the_sensors(self):
        begun = time.monotonic()
        said = self.follow(commands_of_guide()[2])
        print(f"\nregistered after {time.monotonic() - begun:.0f} s, {time.monotonic() - self.begun:.0f} s after the first command",
              file=sys.stderr)
        self.assertRegex(said.lower(), "good|provisional")

    def test_3_the_client_gets_the_tracker_by_curl_and_by_vrpn(self):
        frame = json.loads(self.curl("/frame.json"))
        self.assertEqual(len(frame["bodies"]), 1)
        contributors = {name for joint in frame["bodies"][0]["joints"].values() for name in joint.get("contributors", [])}
        self.assertEqual(contributors, {"s1", "s2", "s3"})
        looking = ("import sys; sys.path.insert(0, sys.argv[1]); from vrpn_client import VrpnClient; "
                   "poses = VrpnClient(['Body0'], 3883, '10.0.0.10', udp=False).poses(); print([next(poses)[:2] for _ in range(25)])")
        self.assertIn("('Body0', 3)", self.client("python3", "-B", "-c", looking, ROOT / "tests/system/fusion"))

    def test_3_the_wrong_clocks_are_corrected_for(self):
        for sensor, wrong in (("s2", 150), ("s3", -90)):
            offset = json.loads(self.curl(f"/sensors/{sensor}", "-H", "Accept: application/json"))["clockOffsetMilliseconds"]
            self.assertAlmostEqual(-offset, wrong, delta=15)

    def test_4_what_the_network_sees_is_sealed(self):
        self.assertIn("https://", self.client("curl", "-sS", "http://10.0.0.10:8080/frame"))
        self.assertEqual(self.client("curl", "-sS", "-o", "/dev/null", "-w", "%{http_code}", "http://10.0.0.11:8081/frame"), "400")
        self.assertEqual(self.client("curl", "-sS", "-k", "-o", "/dev/null", "-w", "%{http_code}", "https://10.0.0.10:8080/frame"), "401")
        self.assertNotEqual(subprocess.run(["nsenter", "-t", self.hosts["client"].pid, "-n", "curl", "-s", "https://10.0.0.10:8080/healthz"],
                                           capture_output=True, check=False).returncode, 0, "this machine knows no such authority")
        self.assertEqual(self.client("curl", "-sS", "--cacert", self.folder / "ca.crt", "-o", "/dev/null", "-w", "%{http_code}",
                                     "https://10.0.0.12:8081/frame"), "401")

    def test_5_certificates_are_renewed_while_everything_runs(self):
        before = (self.hosts["sensor-1"].root / "etc/chorus/tls/host.crt").read_text()
        pid = (self.hosts["fusion"].root / "run/chorus-fusion.pid").read_text()
        self.assertIn("new certificates on 4 hosts", self.follow("deploy/workshop.sh inventory.json renew"))
        self.assertNotEqual((self.hosts["sensor-1"].root / "etc/chorus/tls/host.crt").read_text(), before)
        time.sleep(2)
        self.assertEqual(len(json.loads(self.curl("/frame.json"))["bodies"]), 1)
        self.assertEqual((self.hosts["fusion"].root / "run/chorus-fusion.pid").read_text(), pid)

    def test_7_the_network_was_as_bad_as_it_should_be(self):
        self.switch.terminate()
        done = json.loads(self.switch.communicate()[0])
        print(f"\nthe switch: {done}", file=sys.stderr)
        self.assertGreater(done["carried"], 10_000)
        self.assertTrue(0.01 < done["lost"] / done["carried"] < 0.03, done)
        self.assertGreater(done["overtaken"], 100)

    def doctor(self):
        return self.hosts["fusion"].do("chorus doctor", check=False)

    def test_6_each_mistake_is_told_with_what_to_do(self):
        sensor, fusion = self.hosts["sensor-3"], self.hosts["fusion"]
        run("nsenter", "-t", sensor.pid, "-n", "ip", "link", "set", "eth0", "down")
        self.assertRegex(self.doctor(), "WRONG  sensor s3: .*(timed out|no connect|No route)")
        run("nsenter", "-t", sensor.pid, "-n", "ip", "link", "set", "eth0", "up")
        sensor.do("systemctl stop chorus-sensor")
        self.assertRegex(self.doctor(), "WRONG  sensor s3: .*Connection refused")
        sensor.do("sed -i 's/\"role\": \"read\"/\"role\": \"read\"/; s/\"token\": \"[0-9a-f]*\"/\"token\": \"aaaaaaaaaaaaaaaa\"/' "
                  "/etc/chorus/sensor.json && systemctl start chorus-sensor && sleep 1")
        self.assertIn("does not take our token", self.doctor())
        fusion.do("chorus init certificate somebody.else --out /root/wrong 2>/dev/null")
        shutil.copy(fusion.root / "root/wrong/host.crt", sensor.root / "etc/chorus/tls/host.crt")
        shutil.copy(fusion.root / "root/wrong/host.key", sensor.root / "etc/chorus/tls/host.key")
        sensor.do("chgrp chorus /etc/chorus/tls/*; systemctl reload chorus-sensor; sleep 1")
        self.assertIn("its certificate is for somebody.else", self.doctor())
        sensor.do("chorus init ca --out /root/ca 2>/dev/null; rm -r /etc/chorus/tls;"
                  "chorus init certificate 10.0.0.13 --authority /root/ca 2>/dev/null; systemctl reload chorus-sensor; sleep 1")
        self.assertIn("who is not among those in /etc/chorus/tls/ca.crt", self.doctor())


if __name__ == "__main__":
    if os.geteuid() != 0:
        sys.exit("networked_workshop: this needs root")
    unittest.main(verbosity=2)
