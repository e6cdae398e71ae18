"""Every link in our Markdown files has a target, and every path that a document names in backticks exists."""

import re
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SKIPPED = {"node_modules", "build", "var", ".git"}
HISTORY = "docs/decisions/"  # decisions may name files that were only planned or have been moved
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
NAMED = re.compile(r"`((?:common|docs|deploy|fusion-server|proto|services|tests)/[^`\s]*)`")
CODE_BLOCK = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)
HEADING = re.compile(r"^#+\s+(.*)$", re.MULTILINE)


def anchors(text):
    """The fragments that a Markdown file offers, spelt as on GitHub and the like."""
    plain = (re.sub(r"[^\w\- ]", "", heading.replace("`", "").lower()) for heading in HEADING.findall(text))
    return {heading.strip().replace(" ", "-") for heading in plain}


def exists(path):
    """True for a file or folder that is there, a `{a,b}` pattern if all that it names is there, a `*` pattern if it matches anything."""
    choices = re.fullmatch(r"(.*)\{(.*)\}(.*)", str(path))
    if choices:
        before, inside, after = choices.groups()
        return all(exists(Path(before + choice.strip() + after)) for choice in inside.split(","))
    if "*" in str(path):
        return any(ROOT.glob(str(path.relative_to(ROOT))))
    return path.exists()


def broken(file, root):
    """(link, reason) for every broken link in the file."""
    text = file.read_text(encoding="utf-8")
    prose = CODE_BLOCK.sub("", text)
    for link in LINK.findall(prose):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, fragment = link.partition("#")
        target = (file.parent / path).resolve() if path else file
        if not target.exists():
            yield link, "there is no such file"
        elif fragment and target.suffix == ".md" and fragment not in anchors(target.read_text(encoding="utf-8")):
            yield link, "there is no such heading"
    if HISTORY in file.as_posix():
        return
    for name in NAMED.findall(prose):
        if "<" in name or "..." in name or "…" in name or "NNNN" in name:
            continue
        if not exists(root / name.rstrip("/.,")):
            yield name, "there is no such file"


def markdown_files(root):
    return [file for file in sorted(root.rglob("*.md")) if not SKIPPED & set(file.relative_to(root).parts)]


class OurDocuments(unittest.TestCase):
    def test_lead_nowhere_wrong(self):
        files = markdown_files(ROOT)
        self.assertGreater(len(files), 5)
        found = [f"{file.relative_to(ROOT)}: {link}: {reason}" for file in files for link, reason in broken(file, ROOT)]
        self.assertEqual(found, [])


class BrokenDocuments(unittest.TestCase):
    def found(self, text):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "a.md"
            file.write_text("# A `b` heading\n" + text)
            return [link for link, _ in broken(file, Path(folder))]

    def test_are_caught(self):
        self.assertEqual(self.found("[x](missing.md)"), ["missing.md"])
        self.assertEqual(self.found("[x](a.md#nowhere)"), ["a.md#nowhere"])
        self.assertEqual(self.found("see `common/magic/wand.h`"), ["common/magic/wand.h"])

    def test_good_ones_are_not(self):
        self.assertEqual(self.found("[x](a.md#a-b-heading) [y](https://example.org/z) `other/path`"), [])
        self.assertEqual(self.found("```\n[x](missing.md)\n```\n"), [])


if __name__ == "__main__":
    unittest.main()
