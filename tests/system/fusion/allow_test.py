"""VRPN, NatNet and DTrack's command channel answer loopback and the listed addresses, and no others."""

import re
import socket
import subprocess
import unittest

from rig import Process, Rig, free_port, wait_for

PATIENCE_S = 2.0


def own_address():
    """An IPv4 address of this host that is not loopback; None when there is none."""
    shown = subprocess.run(["hostname", "-I"], capture_output=True, text=True, check=False).stdout
    return next((word for word in shown.split() if re.fullmatch(r"[\d.]+", word)), None)


def heard(kind, end, words):
    """What an output answers to these bytes; empty when it does not answer."""
    with socket.socket(socket.AF_INET, kind) as client:
        client.settimeout(PATIENCE_S)
        try:
            client.connect(end)
            client.send(words)
            return client.recv(100)
        except OSError:
            return b""


@unittest.skipUnless(own_address(), "runs on hosts with an address beside loopback")
class Allow(Rig):
    def served(self, allow):
        ports = {name: free_port() for name in ("vrpn", "natnet", "dtrack")}
        outputs = {"vrpn.enabled": "true", "vrpn.address": "0.0.0.0", "vrpn.port": ports["vrpn"], "vrpn.allow": allow,
                   "natnet.enabled": "true", "natnet.address": "0.0.0.0", "natnet.command_port": ports["natnet"], "natnet.allow": allow,
                   "dtrack.enabled": "true", "dtrack.source_port": 0, "dtrack.command.enabled": "true",
                   "dtrack.command.address": "0.0.0.0", "dtrack.command.port": ports["dtrack"], "dtrack.command.allow": allow}
        options = [word for key, value in outputs.items() for word in ("--set", f"outputs.{key}={value}")]
        self.fusion_process = Process("chorus-fusion", "--port", str(free_port()), "--set", "viewer_dir=", *options)
        self.processes.append(self.fusion_process)
        wait_for("it is ready", lambda: "fusion server ready" in self.fusion_process.text())
        return ports

    def answers(self, host, ports):
        return {"vrpn": bool(heard(socket.SOCK_STREAM, (host, ports["vrpn"]), b"vrpn: ver. 07.35  0\0\0\0\0\0")),
                "natnet": bool(heard(socket.SOCK_DGRAM, (host, ports["natnet"]), b"\0\0\0\0")),
                "dtrack": bool(heard(socket.SOCK_STREAM, (host, ports["dtrack"]), b"dtrack2 get status active\0"))}

    def test_by_default_only_this_host_is_answered(self):
        ports = self.served("[]")
        everybody = dict.fromkeys(ports, True)
        self.assertEqual(self.answers("127.0.0.1", ports), everybody)
        self.assertEqual(self.answers(own_address(), ports), dict.fromkeys(ports, False))
        for key in ("outputs.vrpn.allow", "outputs.natnet.allow", "outputs.dtrack.command.allow"):
            wait_for("the log says what to change", lambda key=key: f"is not listed; add it to {key}" in self.fusion_process.text())

    def test_who_is_listed_is_answered(self):
        ports = self.served(f'["{own_address()}/31"]')
        self.assertEqual(self.answers(own_address(), ports), dict.fromkeys(ports, True))


if __name__ == "__main__":
    unittest.main()
