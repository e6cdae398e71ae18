"""Our tree keeps the rules; artificial trees that break one are detected, so the check is known to work."""

import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from include_rules import ROW_OF, violations  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]


def messages_for(files):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = Path(folder) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return [str(violation) for violation in violations(folder)]


class OurTree(unittest.TestCase):
    def test_keeps_every_rule(self):
        self.assertEqual([str(violation) for violation in violations(ROOT)], [])

    def test_every_folder_of_code_has_a_row(self):
        rooms = {f"{top}/{folder.name}"
                 for top in ("common", "fusion-server", "services")
                 for folder in (ROOT / top).iterdir() if folder.is_dir() and any(folder.rglob("*.h"))}
        self.assertEqual(rooms - set(ROW_OF), set())


class BrokenRules(unittest.TestCase):
    def assert_caught(self, file, text, fragment):
        caught = messages_for({file: text})
        self.assertTrue(any(fragment in message for message in caught), caught)

    def test_a_clean_file_is_not_complained_about(self):
        self.assertEqual(messages_for({"common/body/a.cpp": '#include "common/geometry/rotation.h"\n'}), [])

    def test_a_source_that_hides_what_its_header_lacks(self):
        header = {"common/body/a.h": "#pragma once\n"}
        for text in ('#include <vector>\n#include "common/body/a.h"\n', ""):
            caught = messages_for(header | {"common/body/a.cpp": text})
            self.assertTrue(any("before its own header" in message for message in caught), caught)
        self.assertEqual(messages_for(header | {"common/body/a.cpp": '#include "common/body/a.h"\n#include <vector>\n'}), [])

    def test_upward_include(self):
        self.assert_caught("common/base/a.cpp", '#include "common/time/timestamp.h"\n', "below or beside")

    def test_include_of_a_neighbour(self):
        self.assert_caught("common/time/a.cpp", '#include "common/geometry/plane.h"\n', "below or beside")

    def test_room_without_a_row(self):
        self.assert_caught("common/magic/a.cpp", "", "in no row")
        self.assert_caught("common/body/a.cpp", '#include "common/magic/wand.h"\n', "in no row")

    def test_stage_includes_stage(self):
        self.assert_caught("fusion-server/fusion/a.cpp", '#include "fusion-server/align/aligner.h"\n', "flow only")
        self.assert_caught("fusion-server/registration/a.cpp", '#include "fusion-server/fusion/fuse.h"\n',
                           "align only")
        self.assertEqual(
            messages_for({"fusion-server/registration/a.cpp": '#include "fusion-server/align/aligner.h"\n'}), [])

    def test_judge_feeds_the_judged(self):
        for room in ("fusion", "pipeline", "core", "rest", "server"):
            self.assert_caught(f"fusion-server/{room}/a.cpp", '#include "common/synthetic/scene.h"\n', "judges")

    def test_the_client_stands_below_every_service(self):
        for above in ("common/exporters/take.h", "common/record/recorder.h", "fusion-server/wire/registration_file.h"):
            self.assert_caught("common/client/a.cpp", f'#include "{above}"\n', "below or beside")
        self.assertEqual(messages_for({"services/sensor/a.cpp": '#include "common/client/followers.h"\n'}), [])
        self.assert_caught("fusion-server/core/a.cpp", '#include "common/client/followers.h"\n', "no socket")

    def test_stage_with_side_effects(self):
        for header in ("<boost/asio/post.hpp>", "<serd/serd.h>", "<nlohmann/json.hpp>", "<thread>", "<mutex>",
                       "<iostream>", "<fstream>"):
            self.assert_caught("fusion-server/align/a.cpp", f"#include {header}\n", "stages are pure")
        self.assert_caught("fusion-server/align/a.cpp", "auto t = std::chrono::steady_clock::now();\n", "clock")
        self.assert_caught("fusion-server/align/a.cpp", '#include "common/resource/node.h"\n', "wire forms")

    def test_core_knows_no_socket(self):
        for room in ("core", "pipeline"):
            self.assert_caught(f"fusion-server/{room}/a.cpp", '#include "common/http/server.h"\n', "no socket")
        self.assert_caught("fusion-server/status/sensor_status.h", '#include "common/http/server.h"\n', "no socket")

    def test_core_links_no_socket(self):
        cmake = "chorus_library(NAME {} SRCS a.cpp DEPS {})\n".format
        tree = {"common/net/CMakeLists.txt": cmake("net", "chorus::base"),
                "fusion-server/pipeline/CMakeLists.txt": cmake("pipeline", "chorus::net"),
                "fusion-server/core/CMakeLists.txt": cmake("core", "chorus::pipeline")}
        self.assertTrue(any("links common/net" in message for message in messages_for(tree)))

    def test_http_knows_no_resource(self):
        self.assert_caught("common/http/a.cpp", '#include "common/resource/node.h"\n', "below or beside")
        self.assert_caught("common/http/a.cpp", 'auto link = "<http://www.w3.org/ns/ldp#Resource>";\n', "linked data")

    def test_tracker_protocols_know_no_http(self):
        for room in ("outlet", "vrpn", "dtrack", "natnet"):
            self.assert_caught(f"fusion-server/{room}/a.cpp", '#include "common/http/server.h"\n', "not HTTP")
            cmake = "chorus_library(NAME {} SRCS a.cpp DEPS {})\n".format
            tree = {"common/http/CMakeLists.txt": cmake("http", "chorus::base"),
                    f"fusion-server/{room}/CMakeLists.txt": cmake(room, "chorus::http")}
            self.assertTrue(any("links common/http" in message for message in messages_for(tree)))

    def test_services_meet_over_http_only(self):
        self.assert_caught("services/sensor/a.cpp", '#include "fusion-server/fusion/fuse.h"\n', "over HTTP")
        self.assert_caught("fusion-server/server/a.cpp", '#include "services/sensor/service.h"\n', "over HTTP")

    def test_asio_and_point_clouds_stay_behind_their_doors(self):
        self.assert_caught("common/http/server.cpp", "#include <boost/asio/post.hpp>\n", "asio.h")
        self.assertEqual(messages_for({"common/net/asio.h": "#pragma once\n#include <boost/asio/post.hpp>\n"}), [])
        self.assert_caught("fusion-server/registration/icp.h", "#include <pcl/point_types.h>\n", ".cpp files only")
        self.assert_caught("common/synthetic/depth.h", "#include <opencv2/core.hpp>\n", ".cpp files only")

    def test_includes_what_is_not_linked(self):
        cmake = "chorus_library(NAME {} SRCS a.cpp {})\n".format
        tree = {"common/base/CMakeLists.txt": cmake("base", ""),
                "common/geometry/CMakeLists.txt": cmake("geometry", "DEPS chorus::base"),
                "common/body/CMakeLists.txt": cmake("body", "PRIVATE chorus::geometry"),
                "common/body/a.cpp": '#include "common/base/units.h"\n#include "common/geometry/plane.h"\n'}
        self.assertEqual(messages_for(tree), [])
        tree["common/body/CMakeLists.txt"] = cmake("body", "DEPS chorus::base")
        self.assertTrue(any("does not link common/geometry" in message for message in messages_for(tree)))

    def test_form(self):
        self.assert_caught("common/base/long.cpp", "\n" * 401, "401 lines")
        self.assert_caught("common/base/long.cpp", "int f(\n    int x) {\n" + "  x += 1;\n" * 38 + "}\n", "function of 41 lines")
        self.assertEqual(messages_for({"common/base/short.cpp": "int f(\n    int x) {\n" + "  x += 1;\n" * 37 + "}\n"}), [])
        self.assert_caught("common/base/string_utils.cpp", "", "says nothing")
        self.assert_caught("common/base/guard.h", "int x;\n", "#pragma once")


if __name__ == "__main__":
    unittest.main()
