"""A header includes, itself or by way of our other headers, what it uses of the standard library and of Eigen.

The compiler cannot tell: every file is compiled with a precompiled header that has all of these.
"""

import re
import tempfile
import unittest
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOPS = ("common", "fusion-server", "services", "tests")

# What a header of CMakeLists.txt's precompiled header is included for.
USE_OF = {
    "Eigen/Geometry": r"\bEigen::",
    "algorithm": r"\bstd::(any_of|all_of|none_of|clamp|copy|copy_n|count_if|fill|find|find_if|lower_bound|max_element|min_element|"
                 r"nth_element|remove_if|reverse|rotate|sort|stable_sort|transform|unique|upper_bound|ranges::\w+)\b",
    "array": r"\bstd::array\b",
    "chrono": r"\bstd::chrono\b",
    "cmath": r"\bstd::(acos|asin|atan|atan2|cbrt|ceil|cos|exp|fabs|floor|hypot|isfinite|isnan|log|lround|pow|round|sin|sqrt|tan)\b",
    "functional": r"\bstd::(function|reference_wrapper)\b",
    "map": r"\bstd::(multi)?map\b",
    "memory": r"\bstd::(unique_ptr|shared_ptr|weak_ptr|make_unique|make_shared)\b",
    "optional": r"\bstd::(optional|nullopt)\b",
    "string": r"\bstd::(string|to_string)\b",
    "string_view": r"\bstd::string_view\b",
    "vector": r"\bstd::vector\b",
}


def precompiled():
    text = (ROOT / "CMakeLists.txt").read_text()
    return re.findall(r"<([^>]+)>", re.search(r"target_precompile_headers\(chorus_pch PRIVATE([^)]*)\)", text)[1])


class Tree:
    def __init__(self, root):
        self.root = Path(root)
        self.text = cache(lambda name: (self.root / name).read_text(encoding="utf-8"))
        self.exists = cache(lambda name: (self.root / name).is_file())
        self.direct = cache(lambda name: re.findall(r'^#include ["<]([^">]+)[">]', self.text(name), re.MULTILINE))

    def headers(self):
        return sorted(str(path.relative_to(self.root)) for top in TOPS for path in (self.root / top).rglob("*.h")
                      if "node_modules" not in path.parts)

    def included(self, name):
        found, todo = set(), [name]
        while todo:
            for include in self.direct(todo.pop()):
                if include in found:
                    continue
                found.add(include)
                if self.exists(include):
                    todo.append(include)
        return found

    def missing(self):
        for name in self.headers():
            code, included = re.sub(r"//[^\n]*", "", self.text(name)), self.included(name)
            for header, use in USE_OF.items():
                given = any(i.startswith("Eigen/") for i in included) if header.startswith("Eigen/") else header in included
                if not given and (used := re.search(use, code)):
                    yield f"{name} uses {used[0]} and does not include <{header}>"


class Headers(unittest.TestCase):
    def test_include_what_the_precompiled_header_would_hide(self):
        self.assertEqual(list(Tree(ROOT).missing()), [])

    def test_the_table_has_every_precompiled_header(self):
        self.assertEqual(sorted(USE_OF), sorted(precompiled()))

    def test_a_forgotten_one_is_found_also_behind_another_header(self):
        with tempfile.TemporaryDirectory() as folder:
            room = Path(folder) / "common/a"
            room.mkdir(parents=True)
            (room / "first.h").write_text("#include <vector>\n// std::map\n")
            (room / "second.h").write_text('#include "common/a/first.h"\nstd::vector<int> numbers();\nstd::string name();\n')
            self.assertEqual(list(Tree(folder).missing()), ["common/a/second.h uses std::string and does not include <string>"])


if __name__ == "__main__":
    unittest.main()
