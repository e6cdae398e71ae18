"""With a full disk, POST /recordings/ reports it by its status and reveals no paths."""

import os
import subprocess
import unittest

import sensor_process
from sensor_process import Sensor, temporary_folder


def in_a_mount_namespace(folder):
    """Runs a command so that `folder` is a full file system: it holds only one inode, its root."""
    return ["unshare", "-rm", "sh", "-c", f'mount -t tmpfs -o size=64k,nr_inodes=1 none "{folder}" && exec "$@"', "sh"]


def may_mount():
    with temporary_folder() as folder:
        return subprocess.run([*in_a_mount_namespace(folder), "true"], capture_output=True).returncode == 0


@unittest.skipUnless(may_mount(), "runs where a mount namespace may be made (root, or user namespaces)")
class FullDisk(unittest.TestCase):
    def test_it_is_unavailable(self):
        folder = temporary_folder()
        self.addCleanup(folder.cleanup)
        sensor = Sensor("--set", f"recording.folder={folder.name}", "--set", "recording.min_free_mb=0",
                        before=in_a_mount_namespace(folder.name))
        self.addCleanup(sensor.stop)
        answer = sensor.get("/recordings/", method="POST")
        self.assertEqual(answer.status, 503, answer.text)
        self.assertEqual(answer.type, "application/problem+json")
        self.assertIn("full", answer.json["detail"])
        self.assertNotIn(os.path.basename(folder.name), answer.text)
        sensor.wait_for("/frame", 200)


if __name__ == "__main__":
    assert sensor_process.SENSOR
    unittest.main()
