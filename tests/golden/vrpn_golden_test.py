"""proto/golden/vrpn: checks each .bin byte for byte with an encoder that shares no code with the server's.

`vrpn_golden_test.py FOLDER --write` makes the .bin files from the .json files of the same name."""
import json
import struct
import sys
import unittest
from pathlib import Path

FOLDER = Path(sys.argv[1])
SYSTEM = {"sender description": -1, "type description": -2}


def message(head, kind, payload):
    length = 24 + len(payload)  # without the padding
    ns = int(head.get("timeNanoseconds", "0"))
    fields = struct.pack(">IIIiiI", length, ns // 10**9, ns % 10**9 // 1000, head["sender"], kind, head.get("sequence", 0))
    return (fields + payload).ljust(-(-length // 8) * 8, b"\0")


def payload_of(entry):
    if "name" in entry:
        text = entry["name"].encode() + b"\0"
        return struct.pack(">I", len(text)) + text
    if "sensor" in entry:
        numbers = entry["vector"] + entry["quaternion"] + ([entry["interval"]] if "interval" in entry else [])
        return struct.pack(">ii", entry["sensor"], entry["sensor"]) + struct.pack(f">{len(numbers)}d", *numbers)
    return b""


def encode(document):
    if "cookie" in document:
        return document["cookie"].encode().ljust(24, b"\0")
    return b"".join(message(entry, SYSTEM.get(entry["type"], entry["type"]), payload_of(entry))
                    for entry in document["messages"])


class Golden(unittest.TestCase):
    def test_every_file_is_what_its_twin_says(self):
        twins = sorted(FOLDER.glob("*.json"))
        self.assertEqual({t.with_suffix(".bin") for t in twins}, set(FOLDER.glob("*.bin")))
        self.assertGreaterEqual(len(twins), 3)
        for twin in twins:
            with self.subTest(twin.name):
                self.assertEqual(encode(json.loads(twin.read_text())), twin.with_suffix(".bin").read_bytes())


if __name__ == "__main__":
    if "--write" in sys.argv:
        for twin in FOLDER.glob("*.json"):
            twin.with_suffix(".bin").write_bytes(encode(json.loads(twin.read_text())))
    else:
        unittest.main(argv=sys.argv[:1], verbosity=2)
