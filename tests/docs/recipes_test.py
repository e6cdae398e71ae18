"""Every file, folder and table that a recipe in CONTRIBUTING names exists, and every page of docs/how is listed in its index."""

import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PATH = re.compile(r"`((?:common|services|fusion-server|proto|tests|deploy|docs)/[A-Za-z0-9_./-]*)`")
BUILT = ("build/",)
RECIPES = 14
IN_WORDS = "Fourteen"


def recipes():
    text = (ROOT / "CONTRIBUTING.md").read_text()
    parts = re.split(r"^## ", text, flags=re.MULTILINE)
    return {part.splitlines()[0]: part for part in parts if part.startswith("Recipe: ")}


class Recipes(unittest.TestCase):
    def test_there_are_all_of_them(self):
        self.assertEqual(len(recipes()), RECIPES, sorted(recipes()))
        self.assertIn(f"{IN_WORDS} recipes", (ROOT / "docs/how/README.md").read_text(), "the index states another number")

    def test_each_names_files_that_exist(self):
        for name, text in recipes().items():
            paths = PATH.findall(text)
            self.assertGreaterEqual(len(paths), 2, f"{name} names no files")
            for path in paths:
                # A test of ctest is named like a path: docs/config_keys_test, golden/openapi_test.
                exists = (ROOT / path).exists() or (ROOT / "tests" / f"{path}.py").exists()
                self.assertTrue(exists, f"{name}: {path} does not exist")

    def test_tables_that_it_names_are_in_the_files_that_it_names(self):
        for name, text in recipes().items():
            files = [ROOT / path for path in PATH.findall(text) if (ROOT / path).is_file()]
            files += [ROOT / path.replace(".h", ".cpp") for path in PATH.findall(text) if path.endswith(".h") and (ROOT / path.replace(".h", ".cpp")).is_file()]
            source = "\n".join(file.read_text() for file in files)
            for table in re.findall(r"`(k[A-Z][A-Za-z]*|for_each_output|OutputsConfig|READERS)`", text):
                self.assertTrue(re.search(rf"\b{table}\b", source), f"{name}: {table} is in none of its files")

    def test_pages_of_how_are_listed(self):
        index = (ROOT / "docs/how/README.md").read_text()
        for page in (ROOT / "docs/how").glob("*.md"):
            if page.name != "README.md":
                self.assertIn(f"({page.name})", index, "a page that nobody finds")

    def test_files_that_the_index_calls_deciding_exist(self):
        rows = [line for line in (ROOT / "docs/how/README.md").read_text().splitlines() if line.startswith("| ") and line.count("|") >= 5]
        for row in rows:
            for path in re.findall(r"`((?:common|services|fusion-server|tests|deploy)/[A-Za-z0-9_./-]+)`", row.split("|")[-2]):
                self.assertTrue((ROOT / path).exists(), f"{path} is not there: {row[:80]}")

    def test_pages_of_how_name_files_that_exist(self):
        sources = {p.name for room in ("common", "fusion-server", "services", "tests") for p in (ROOT / room).rglob("*.h")}
        for page in (ROOT / "docs/how").glob("*.md"):
            for header in re.findall(r"`(?:[a-z_/-]*/)?([a-z_]+\.h)`", page.read_text()):
                self.assertTrue(header in sources, f"{page.name} names {header}, which is not there")


if __name__ == "__main__":
    unittest.main()
