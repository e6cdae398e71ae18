"""tests/skipped.py names what was skipped and why."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from skipped import skipped  # noqa: E402

LOG = """
1/4 Testing: a/gtest
1/4 Test: a/gtest
[ RUN      ] Bvh.Real
tests/bvh_test.cpp:150: Skipped
runs where /data is there
[  SKIPPED ] Bvh.Real (0 ms)
[  SKIPPED ] 1 test, listed below:
2/4 Testing: b/unittest
2/4 Test: b/unittest
test_the_sensor (__main__.Proxy.test_the_sensor)
It passes a proxy. ... skipped 'runs where nginx is installed (Debian: nginx)'
OK (skipped=1)
3/4 Testing: c/silent
3/4 Test: c/silent
OK (skipped=1)
4/4 Testing: d/passes
4/4 Test: d/passes
OK
"""


class Skipped(unittest.TestCase):
    def test_says_who_waits_for_what(self):
        self.assertEqual([*skipped(LOG)], [("a/gtest", "runs where /data is there"),
                                           ("b/unittest", "runs where nginx is installed (Debian: nginx)"),
                                           ("c/silent", "does not say")])


if __name__ == "__main__":
    unittest.main()
