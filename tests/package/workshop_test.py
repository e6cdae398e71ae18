"""deploy/workshop.sh does on each host what its guide says, in that order, and reports errors in an inventory."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOKEN = "0123456789abcdef"
# Replaces ssh: records host and command, stores what arrived on stdin, and answers like a host.
FAKE_SSH = """#!/bin/bash
echo "$1 | $2" >> "$NOTES/commands"
case $2 in
  *"tar -C /var/tmp"*) tar -tf - >> "$NOTES/sent.$1" ;;
  *"install.sh --list"*) [[ "$1" == *has-one* ]] || echo "chorus-sensor_$([[ "$1" == *board* ]] && echo arm64 || echo amd64).deb" ;;
  "cat /etc/chorus/sensor.json") printf '// http://x\\n{"http": {"tls": {"key": "k"}, "tokens": [{"token": "%s", "role": "read"}]}}' '""" + TOKEN + """' ;;
  *"test -e /etc/chorus/tls/host.crt") [[ "$1" == *has-one* ]] ;;
  "dpkg --print-architecture") [[ "$1" == *board* ]] && echo arm64 || echo amd64 ;;
  hostname) echo "name-of-${1#*@}" ;;
  "cat /etc/chorus/ca/ca.crt") echo "AUTHORITY" ;;
  *"chorus init certificate"*) echo "CERTIFICATE ${2#*certificate }" ;;
  *"tar -C /etc/chorus --no-same-owner"*) cat > "$NOTES/certificate.$1" ;;
  "cat /etc/chorus/fusion.json") cat "$NOTES/kept" 2>/dev/null || echo '"s1" "s2" "s3"' ;;
  *"init sensor"*) [[ "$1" != *full* ]] || { echo "/etc/chorus/sensor.json: No space left on device" >&2; exit 1; } ;;
  *"sensors-from"*|*"conf.d/chorus.conf &&"*) cat >> "$NOTES/input.$1" ;;
  "id -u") [[ "$1" != *away* ]] || exit 255; [[ "$1" == *guest* ]] && echo 1000 || echo 0 ;;
  "chorus doctor") [[ "$1" != *ill* ]] || exit 1; [[ "$1" != *bare* ]] || exit 127; [[ "$1" != *away* ]] || exit 255 ;;
  *"apt-get"*) [[ "$1" != *away* ]] || exit 255 ;;
esac
"""
INVENTORY = {"fusion": {"address": "10.0.0.10", "outputs": ["vrpn=10.0.0.20"]},
             "sensors": [{"id": "s1", "address": "10.0.0.11"},
                         {"id": "s2", "address": "10.0.0.12", "ssh": "admin@host-2", "device": "simulated"}]}


class Workshop(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "ssh").write_text(FAKE_SSH)
        (self.folder / "ssh").chmod(0o755)
        self.make_packages("packages", "amd64")

    def make_packages(self, name, architecture):
        packages = self.folder / name
        packages.mkdir()
        (packages / "SYSTEM").write_text(f"debian-12-{architecture}\n")
        (packages / f"chorus-sensor_{architecture}.deb").touch()
        (packages / "chorus-tools.deb").touch()
        (packages / "Packages").touch()
        (packages / "install.sh").write_text("#!/bin/sh\n")
        (packages / "install.sh").chmod(0o755)

    def run_it(self, task, inventory=None):
        file = self.folder / "inventory.json"
        whole = {**(inventory or INVENTORY), "packages": str(self.folder / "packages")}
        file.write_text(json.dumps(whole))
        environment = {**os.environ, "CHORUS_SSH": str(self.folder / "ssh"), "NOTES": str(self.folder)}
        return subprocess.run(["deploy/workshop.sh", str(file), task], cwd=ROOT, env=environment,
                              capture_output=True, text=True, check=False)

    def noted(self, name):
        file = self.folder / name
        return file.read_text() if file.exists() else ""

    def test_installs_the_authority_first_then_the_sensors(self):
        done = self.run_it("lay-out")
        self.assertEqual(done.returncode, 0, done.stderr)
        hosts = [line.split(" | ")[0] for line in self.noted("commands").splitlines() if "install.sh chorus" in line]
        self.assertEqual(hosts, ["root@10.0.0.10", "root@10.0.0.11", "admin@host-2"])
        self.assertIn("install.sh", self.noted("sent.admin@host-2"))
        commands = self.noted("commands")
        self.assertIn("install.sh chorus-sensor chrony", commands)
        self.assertIn("chorus init sensor --id s2 --device simulated", commands)
        self.assertIn("test -e /etc/chorus/sensor.json ||", commands, "what is there is kept")
        self.assertIn("--output vrpn=10.0.0.20", commands)

    def test_the_fusion_host_gets_every_sensor_with_its_token_and_not_on_a_command_line(self):
        self.run_it("lay-out")
        given = self.noted("input.root@10.0.0.10")
        self.assertIn(f"s1=https://10.0.0.11:8081/,{TOKEN}\n", given)
        self.assertIn(f"s2=https://10.0.0.12:8081/,{TOKEN}\n", given)
        self.assertNotIn(TOKEN, self.noted("commands"))

    def test_sensor_hosts_follow_the_time_of_the_fusion_host(self):
        self.run_it("lay-out")
        self.assertIn("server 10.0.0.10 iburst", self.noted("input.root@10.0.0.11"))
        self.assertIn("allow 10.0.0.12", self.noted("input.root@10.0.0.10"))

    def test_a_host_that_does_not_let_us_in_is_named_with_what_to_do(self):
        far = {**INVENTORY, "sensors": [{"id": "s1", "address": "10.0.0.11", "ssh": "root@away"}]}
        done = self.run_it("lay-out", far)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("ssh-copy-id", done.stderr)

    def test_a_host_of_another_architecture_gets_its_own_packages(self):
        boards = {**INVENTORY, "sensors": [*INVENTORY["sensors"], {"id": "s3", "address": "10.0.0.13", "ssh": "root@board"}]}
        done = self.run_it("lay-out", boards)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("make-packages.sh --arch arm64", done.stderr)
        self.assertNotIn("install.sh", self.noted("commands"), "no host is changed before all can be")
        self.make_packages("packages-arm64", "arm64")
        done = self.run_it("lay-out", boards)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("chorus-sensor_arm64.deb", self.noted("sent.root@board"))
        self.assertIn("chorus-sensor_amd64.deb", self.noted("sent.root@10.0.0.11"))

    def test_a_host_is_sent_only_the_packages_that_it_lacks(self):
        self.run_it("lay-out", self.with_sensor("root@has-one"))
        self.assertNotIn(".deb", self.noted("sent.root@has-one"))
        self.assertIn("root@has-one | /var/tmp/chorus-packages/install.sh chorus-sensor chrony", self.noted("commands"))
        self.assertIn("chorus-sensor_amd64.deb", self.noted("sent.admin@host-2"))
        self.assertNotIn("chorus-tools", self.noted("sent.admin@host-2"))

    def test_check_asks_every_host_and_fails_when_one_is_not_well(self):
        self.assertEqual(self.run_it("check").returncode, 0)
        self.assertEqual(self.noted("commands").count("chorus doctor"), 3)
        ill = {**INVENTORY, "fusion": {"address": "10.0.0.10", "ssh": "root@ill"}}
        done = self.run_it("check", ill)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("1 of 3 hosts are not well", done.stderr)

    def test_every_host_gets_a_certificate_of_the_fusion_host(self):
        self.run_it("lay-out")
        self.assertEqual((self.folder / "ca.crt").read_text(), "AUTHORITY\n")
        made = [line for line in self.noted("commands").splitlines() if "init certificate" in line]
        self.assertEqual([line.split(" | ")[0] for line in made], ["root@10.0.0.10"] * 3)
        self.assertIn("CERTIFICATE name-of-host-2 name-of-host-2.local 10.0.0.12 ", self.noted("certificate.admin@host-2"))
        self.assertRegex(self.noted("commands"), r"test -e /etc/chorus/ca/ca.crt \|\| .*chorus init ca", "an authority that is there is kept")

    def test_a_certificate_that_is_there_is_kept_until_it_is_renewed(self):
        has = {**INVENTORY, "sensors": [{"id": "s1", "address": "10.0.0.11", "ssh": "root@has-one"}]}
        self.run_it("lay-out", has)
        self.assertEqual(self.noted("certificate.root@has-one"), "")
        self.assertEqual(self.run_it("renew", has).returncode, 0)
        self.assertIn("10.0.0.11", self.noted("certificate.root@has-one"))
        self.assertIn("root@has-one | systemctl reload chorus-sensor", self.noted("commands"))

    def test_takes_everything_away(self):
        self.assertEqual(self.run_it("purge").returncode, 0)
        self.assertEqual(self.noted("commands").count("apt-get -q -y purge 'chorus-*'"), 3)

    def with_sensor(self, ssh, **more):
        return {**INVENTORY, "sensors": [{"id": "s1", "address": "10.0.0.11", "ssh": ssh, **more}, INVENTORY["sensors"][1]]}

    def test_a_host_that_is_away_keeps_nobody_else_from_being_removed(self):
        done = self.run_it("remove", self.with_sensor("root@away"))
        self.assertEqual(self.noted("commands").count("apt-get -q -y remove"), 3)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("root@away cannot be reached by ssh", done.stdout)
        self.assertIn("1 of 3 hosts still have something", done.stderr)

    def test_check_tells_hosts_that_are_away_or_bare_from_those_that_are_ill(self):
        self.assertIn("try ssh root@away true", self.run_it("check", self.with_sensor("root@away")).stdout)
        said = self.run_it("check", self.with_sensor("root@bare"))
        self.assertIn("Chorus is not installed on root@bare", said.stdout)
        self.assertIn("lay-out", said.stdout)

    def test_who_does_not_enter_as_root_is_told_before_anything_is_changed(self):
        for task in ("lay-out", "renew"):
            done = self.run_it(task, self.with_sensor("guest@10.0.0.11"))
            self.assertNotEqual(done.returncode, 0)
            self.assertIn("does not let us in as root", done.stderr)
        self.assertNotIn("install.sh", self.noted("commands"))

    def test_a_step_that_fails_says_where_why_and_what_to_do(self):
        done = self.run_it("lay-out", self.with_sensor("root@full"))
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("No space left", done.stderr)
        self.assertIn("stopped at root@full, writing and starting the sensor; why stands above", done.stderr)
        self.assertEqual(done.stderr.count("workshop: "), 1)

    def test_a_sensor_that_the_fusion_host_does_not_read_yet_is_named_with_its_line(self):
        (self.folder / "kept").write_text('{"sensors": [{"id": "s1"}]}')
        done = self.run_it("lay-out")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("sensor s2 is not in /etc/chorus/fusion.json", done.stdout)
        self.assertIn('{ "id": "s2", "url": "https://10.0.0.12:8081/", "token": "' + TOKEN + '" }', done.stdout)
        self.assertNotIn("sensor s1 is not", done.stdout)

    def test_cameras_get_the_package_that_they_need(self):
        self.run_it("lay-out", self.with_sensor("root@10.0.0.11", device="camera"))
        self.assertIn("root@10.0.0.11 | /var/tmp/chorus-packages/install.sh chorus-camera chrony", self.noted("commands"))

    def test_a_sensor_on_the_fusion_host_leaves_its_time_alone(self):
        done = self.run_it("lay-out", self.with_sensor("root@10.0.0.10"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("server 10.0.0.10", self.noted("input.root@10.0.0.10"))

    def test_a_missing_inventory_or_task_says_what_to_do(self):
        for words, said in ((["none.json", "check"], "write one as in docs/guide/workshop.md"), ([__file__, "lay_out"], "unknown task"),
                            ([__file__, "check"], "is no JSON")):
            done = subprocess.run([ROOT / "deploy/workshop.sh", *words], capture_output=True, text=True, check=False)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(said, done.stderr)

    def test_an_inventory_that_is_wrong_does_nothing_and_says_why(self):
        for wrong, word in (({"fusion": {}, "sensors": []}, "sensors"),
                            ({"fusion": {"address": "1"}, "sensors": []}, 'a list "sensors"'),
                            ({**INVENTORY, "sensors": [{"address": "1"}]}, '"id"'),
                            ({**INVENTORY, "sensors": [{"id": "a; rm -rf /", "address": "1"}]}, "letters"),
                            ({**INVENTORY, "sensors": [{"id": "s.1", "address": "1"}]}, "letters, digits, _ or -"),
                            ({**INVENTORY, "sensors": [{"id": "s1", "address": "1"}, {"id": "s1", "address": "2"}]}, "of its own"),
                            ({**INVENTORY, "sensors": [{"id": "s1", "address": "1"}, {"id": "s2", "address": "1"}]}, "the same host as"),
                            ({**INVENTORY, "sensors": [{"id": "s1"}]}, 'sensors[0] has no "address"'),
                            ({**INVENTORY, "sensors": ["s1"]}, "sensors[0] is no object"),
                            ({**INVENTORY, "sensors": [{"id": "s1", "address": "1", "device": "kinect"}]}, "one of bridge, camera"),
                            ({**INVENTORY, "outputs": ["vrpn=1"]}, "the file has the unknown key"),
                            ({**INVENTORY, "fusion": "10.0.0.10"}, "fusion is no object"),
                            ({**INVENTORY, "fusion": {"address": "1", "outputs": "vrpn=1"}}, "is no list"),
                            ({**INVENTORY, "fusion": {"address": "-oProxyCommand=x"}}, "letters"),
                            ({**INVENTORY, "fusion": {"address": "1", "adress": "2"}}, "unknown key"),
                            ({**INVENTORY, "fusion": {"address": "1", "outputs": ["vrpn=$(x)"]}}, "of the form")):
            with self.subTest(word):
                done = self.run_it("lay-out", wrong)
                self.assertNotEqual(done.returncode, 0)
                self.assertIn(word, done.stderr)
        self.assertEqual(self.noted("commands"), "")


if __name__ == "__main__":
    unittest.main()
