"""All of our C++ is formatted by clang-format, and the check detects code that is not."""

import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ROOMS = ("common", "fusion-server", "services", "tests")


def sources():
    for room in ROOMS:
        for path in (ROOT / room).rglob("*"):
            if path.suffix in (".h", ".cpp") and "node_modules" not in path.parts:
                yield str(path)


def complaints(files):
    run = subprocess.run(["clang-format-14", "--dry-run", f"--style=file:{ROOT / '.clang-format'}", *files],
                         capture_output=True, text=True, check=False)
    return [line for line in run.stderr.splitlines() if "clang-format-violations" in line]


class Format(unittest.TestCase):
    def test_our_tree(self):
        files = sorted(sources())
        self.assertGreater(len(files), 500)
        self.assertEqual(complaints(files), [], "run clang-format -i on these files")

    def test_what_is_not_formatted_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            crooked = Path(folder) / "a.cpp"
            crooked.write_text("int  f( ){return 1 ;}\n")
            self.assertTrue(complaints([str(crooked)]))


if __name__ == "__main__":
    unittest.main()
