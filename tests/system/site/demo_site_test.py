"""deploy/demo.sh --site with the newly built programs: accounts, TLS, two cells, and one id for who walks through both."""
import os
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tests/support"))
from ports import free_ports, is_listening  # noqa: E402

PORTS = 9
SECONDS = 30  # a lap takes 15.7 s


class DemoOfASite(unittest.TestCase):
    def test_a_person_in_two_cells_is_one(self):
        port = free_ports(PORTS)
        done = subprocess.run(["deploy/demo.sh", "--site", "--bin", os.environ["CHORUS_BIN"], "--port", str(port), "--seconds",
                               str(SECONDS)], cwd=ROOT, capture_output=True, text=True, timeout=200)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("delivered: one id in both cells", done.stdout)
        self.assertEqual([p for p in range(port, port + PORTS) if is_listening(p)], [])


if __name__ == "__main__":
    unittest.main()
