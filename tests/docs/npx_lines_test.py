"""Every `npx` line of the documentation names a package, and a program in it, that the tests' lock file contains."""

import json
import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LINE = re.compile(r"^\s+npx (?P<words>.*)$", re.MULTILINE)


class NpxLines(unittest.TestCase):
    def test_the_program_is_in_the_package(self):
        packages = json.loads((ROOT / "tests/package-lock.json").read_text())["packages"]
        lines = [(page, match["words"]) for page in (ROOT / "docs").rglob("*.md")
                 for match in LINE.finditer(page.read_text())]
        self.assertTrue(lines)
        for page, words in lines:
            option, package, program, *_ = words.split()
            self.assertEqual(option, "-p", f"{page}: npx {words}")
            self.assertIn(program, packages[f"node_modules/{package}"]["bin"], f"{page}: npx {words}")


if __name__ == "__main__":
    unittest.main()
