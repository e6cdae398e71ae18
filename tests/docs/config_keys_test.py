"""Every key that a program reads is in its file in deploy/config and explained there, and every key there is read."""

import json
import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# Which code reads which configuration file.
READERS = {
    "fusion.json": ["fusion-server/server", "fusion-server/outputs", "fusion-server/outlet", "fusion-server/vrpn", "fusion-server/dtrack",
                    "fusion-server/natnet", "fusion-server/trackd", "fusion-server/osc", "fusion-server/mxtp", "fusion-server/mqtt", "common/service",
                    "common/client", "common/workplace/prop.cpp"],
    "sensor.json": ["services/sensor", "common/service"],
    "evaluation.json": ["services/evaluation", "common/service/http_config.cpp", "common/service/log_config.cpp", "common/client"],
    "ergonomics.json": ["services/ergonomics", "common/service/http_config.cpp", "common/service/log_config.cpp", "common/client"],
}
# Read by a function of those folders that this program does not call: read_followed(), since its tracker needs no id.
UNASKED = {"ergonomics.json": {"id"}}
READ = re.compile(r"""(?:(?:\.|->)(?:read(?:_ms|_s|_deg|_choice)?|child|items)\(|\bread_\w+\(\w+,|\bvisit\(|\bDeviceKind\{|\bread_mb\(|\bread_count\()\s*"([A-Za-z0-9_]+)\"""")
KEY_LINE = re.compile(r'^\s*"([A-Za-z0-9_]+)"\s*:')
UNITS = {"read_ms": "_ms", "read_s": "_s", "read_deg": "_deg"}
READ_UNIT = re.compile(r"""(?:\.|->)(read_ms|read_s|read_deg)\(\s*"([A-Za-z0-9_]+)\"""")


def without_comments(text):
    """JSON with // comments, none of them inside a string."""
    return re.sub(r'("(?:\\.|[^"\\])*")|//[^\n]*', lambda match: match.group(1) or "", text)


def keys_in(value):
    if isinstance(value, dict):
        for key, inner in value.items():
            yield key
            yield from keys_in(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from keys_in(inner)


def keys_shown_in_comments(text):
    """Optional keys that a file shows commented out: // "pose": { "x_m": 0 }"""
    return {key for comment in re.findall(r'^\s*//(.*)$', text, re.MULTILINE)
            for key in re.findall(r'"([A-Za-z0-9_]+)":\s*(?:[-\d"{[]|true|false)', comment)}


def source_of(folders):
    """Of folders, or of single files of rooms that read more for others."""
    return "\n".join(file.read_text(encoding="utf-8") for folder in folders
                     for file in ([ROOT / folder] if folder.endswith(".cpp") else sorted((ROOT / folder).rglob("*.cpp"))))


def unexplained(text):
    """Keys that have a value and no explanation. A comment explains the keys below it, down to the next empty line or closing brace, or the
    key on whose line it ends."""
    explained = False
    found = []
    for line in text.splitlines():
        bare = line.strip()
        if bare.startswith("//"):
            explained = True
        elif KEY_LINE.match(line):
            if not explained and "//" not in line and not bare.endswith("{"):
                found.append(KEY_LINE.match(line).group(1))
        elif bare == "" or bare.startswith("}"):
            explained = False
    return found


class ConfigFiles(unittest.TestCase):
    def each(self):
        for name, folders in READERS.items():
            file = ROOT / "deploy/config" / name
            self.assertTrue(file.exists(), f"deploy/config/{name} is missing")
            yield name, file.read_text(encoding="utf-8"), source_of(folders)

    def test_name_every_key_that_is_read_and_no_other(self):
        for name, text, source in self.each():
            with self.subTest(name):
                read = set(READ.findall(source)) - UNASKED.get(name, set())
                self.assertGreater(len(read), 10)
                written = set(keys_in(json.loads(without_comments(text))))
                self.assertEqual(read - written - keys_shown_in_comments(text), set(), "read by the program, not in the file")
                self.assertEqual((written | keys_shown_in_comments(text)) - read, set(), "in the file, read by nothing")

    def test_explain_every_key(self):
        for name, text, _ in self.each():
            with self.subTest(name):
                self.assertEqual(unexplained(text), [])

    def test_keys_carry_the_unit_they_are_read_in(self):
        for name, _, source in self.each():
            with self.subTest(name):
                wrong = [key for reader, key in READ_UNIT.findall(source) if not key.removesuffix("_s" if reader == "read_deg" else "").endswith(UNITS[reader])]
                self.assertEqual(wrong, [])


class TheCheckItself(unittest.TestCase):
    def test_strips_comments_but_not_urls(self):
        text = '{\n// a "comment"\n"url": "http://127.0.0.1/", // more\n"x": "\\"//"\n}'
        self.assertEqual(json.loads(without_comments(text)), {"url": "http://127.0.0.1/", "x": '"//'})

    def test_finds_keys_in_code_and_in_lists(self):
        self.assertEqual(READ.findall('r.read_ms("gap_ms", x, a, b); root->child("quality"); r.has("no")'),
                         ["gap_ms", "quality"])
        self.assertEqual(set(keys_in({"a": [{"b": 1}], "c": {"d": 2}})), {"a", "b", "c", "d"})

    def test_finds_what_is_not_explained(self):
        self.assertEqual(unexplained('{\n// why\n"a": 1,\n\n"b": 2,\n"c": 3 // here\n}'), ["b"])
        self.assertEqual(unexplained('{\n// why\n"a": {\n"b": 1\n},\n"c": {\n"d": 1\n}\n}'), ["d"])

    def test_finds_keys_that_are_shown_in_comments(self):
        self.assertEqual(keys_shown_in_comments('// "pose": { "x_m": -1 }\n// "otto": the paper'), {"pose", "x_m"})


if __name__ == "__main__":
    unittest.main()
