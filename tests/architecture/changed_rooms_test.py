"""CI runs the address sanitizer over the rooms that a change touches: which ones these are."""
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
from changed_rooms import changed_rooms, room_of  # noqa: E402

ROOMS = {folder.name for folder in (ROOT / "tests/unit").iterdir() if folder.is_dir()}


class ChangedRooms(unittest.TestCase):
    def test_a_file_belongs_to_the_room_whose_tests_compile_it(self):
        for path, room in (("common/http/answer.cpp", "http"), ("fusion-server/core/world.h", "core"), ("services/ctl/line/console.cpp", "ctl"),
                           ("services/sensor/device/bridge/push_desk.cpp", "push"), ("services/sensor/sensor_host.cpp", "sensor_service"),
                           ("tests/unit/http/uri_test.cpp", "http"), ("README.md", None), ("tests/system/rig.py", None),
                           ("common/CMakeLists.txt", None)):
            self.assertEqual(room_of(path, ROOMS), room, path)

    def test_each_room_is_named_once(self):
        self.assertEqual(changed_rooms(["common/net/a.h", "common/net/b.h", "docs/x.md", "common/base/c.h"], ROOMS), ["base", "net"])


if __name__ == "__main__":
    unittest.main()
