"""chorus export as users run it: every number of TRC, CSV and C3D equals that of the fused frames, read with nothing but Python's standard
library; all kinds of sources; errors say what to do."""

import csv
import io
import json
import struct
import tempfile
import unittest
from pathlib import Path

from fused_source import CAMERAS, FakeFusion, chorus, frames_with_bodies, fused_lines


def read_c3d(data):
    """(labels, rate, frames of points (x, y, z, fourth word)) after the C3D user guide: Intel, floats."""
    start = (data[0] - 1) * 512
    assert data[1] == 0x50 and data[start + 3] == 84
    groups, values, at = {}, {}, start + 4
    while data[at]:
        length, group = abs(struct.unpack_from("b", data, at)[0]), struct.unpack_from("b", data, at + 1)[0]
        name = data[at + 2:at + 2 + length].decode()
        link = at + 2 + length
        if group < 0:
            groups[-group] = name
        else:
            dimensions = data[link + 4:link + 4 + data[link + 3]]
            values[f"{groups[group]}:{name}"] = (dimensions, data[link + 4 + data[link + 3]:])
        at = link + struct.unpack_from("<H", data, link)[0]
    check_header(data, values)
    points, first, last = struct.unpack_from("<H", data, 2)[0], *struct.unpack_from("<HH", data, 6)
    (width, count), text = values["POINT:LABELS"]
    labels = [text[i * width:(i + 1) * width].decode().strip() for i in range(count)]
    begin = (struct.unpack_from("<H", data, 16)[0] - 1) * 512
    frames = [[struct.unpack_from("<4f", data, begin + 16 * (f * points + p)) for p in range(points)]
              for f in range(last - first + 1)]
    return labels, struct.unpack_from("<f", data, 20)[0], frames


def opensim_row(line, markers):
    """The fields of a row as OpenSim splits it: an empty one at its end does not count, and their number must be right."""
    fields = line.split("\t")
    fields = fields[:-1] if fields[-1] == "" else fields
    assert len(fields) == 2 + 3 * markers, f"expected {2 + 3 * markers} fields, found {len(fields)}"
    return fields


def check_header(data, values):
    """What py-c3d checks in every file before it reads a point: header and parameters agree."""
    def number(name, form):
        return struct.unpack_from(form, values[name][1])[0]
    points, samples = struct.unpack_from("<HH", data, 2)
    scale, = struct.unpack_from("<f", data, 12)
    samples_a_channel, = struct.unpack_from("<H", data, 18)
    rate, = struct.unpack_from("<f", data, 20)
    assert points == number("POINT:USED", "<H"), "inconsistent point count"
    assert scale == number("POINT:SCALE", "<f"), "inconsistent scale factor"
    assert rate == number("POINT:RATE", "<f"), "inconsistent frame rate"
    assert samples_a_channel == number("ANALOG:RATE", "<f") / rate, "inconsistent analog rate"
    assert samples == number("ANALOG:USED", "<H") * samples_a_channel, "inconsistent analog count"


class Export(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.at = Path(cls.folder.name)
        cls.lines = fused_lines(cls.at)
        cls.frames = frames_with_bodies(cls.lines)
        cls.ndjson = cls.at / "fused.ndjson"
        cls.ndjson.write_bytes(cls.lines)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def export(self, file_format, *more):
        """Exports from standard input to standard output, as the pipe in the guide does."""
        code, out, error = chorus("export", "-", "--format", file_format, "--out", "-", *more, feed=self.lines)
        self.assertEqual(code, 0, error)
        return out

    def joints(self, index):
        return self.frames[index]["bodies"][0]["joints"]

    def test_csv_holds_every_joint_of_every_frame(self):
        rows = list(csv.DictReader(io.StringIO(self.export("csv").decode())))
        self.assertEqual(len(rows), 25 * len(self.frames))
        for row in rows:
            joint = self.joints(int(row["frame"]))[row["joint"]]
            self.assertEqual(row["state"], joint["state"])
            self.assertEqual(row["x_m"] == "", "x" not in joint)
            for axis in "xyz" if "x" in joint else "":
                self.assertAlmostEqual(float(row[f"{axis}_m"]), joint[axis], places=6)
            if "variance" in joint:
                self.assertAlmostEqual(float(row["sd_mm"]), 1000 * joint["variance"] ** 0.5, places=3)
        self.assertEqual(rows[-1]["utc"][:23], self.frames[-1]["captured"][:23])

    def test_trc_holds_the_same_in_millimetres(self):
        lines = self.export("trc").decode().split("\n")
        names = lines[3].split("\t")[2:-1:3]
        self.assertEqual(len(names), 25)
        self.assertEqual(lines[2].split("\t")[2:5], [str(len(self.frames)), "25", "mm"])
        for index in range(len(self.frames)):
            fields = opensim_row(lines[6 + index], 25)
            self.assertAlmostEqual(float(fields[1]), index / 30, places=6)
            for name, xyz in zip(names, zip(fields[2::3], fields[3::3], fields[4::3])):
                joint = self.joints(index)[name]
                for text, axis in zip(xyz, "xyz"):
                    self.assertEqual(text == "", "x" not in joint)
                    if text:
                        self.assertAlmostEqual(float(text), 1000 * joint[axis], places=3)

    def test_c3d_holds_the_same_and_comes_back_through_import(self):
        labels, rate, frames = read_c3d(self.export("c3d"))
        self.assertEqual((rate, len(frames)), (30.0, len(self.frames)))
        for index, points in enumerate(frames):
            for label, (x, y, z, word) in zip(labels, points):
                joint = self.joints(index)[label]
                self.assertEqual(word < 0, "x" not in joint)
                if word >= 0:
                    for value, axis in zip((x, y, z), "xyz"):
                        self.assertAlmostEqual(value, 1000 * joint[axis], places=2)
        self.comes_back("c3d", 0.0002)

    def comes_back(self, file_format, metres):
        """The truth that `chorus import` reads from the file is within `metres` of the fused joints."""
        file = self.at / f"back.{file_format}"
        file.write_bytes(self.export(file_format))
        folder = self.at / f"back-{file_format}"
        self.assertEqual(chorus("import", file_format, file, "--out", folder)[0], 0)
        truth = [json.loads(line) for line in (folder / "truth.ndjson").read_text().splitlines()]
        self.assertEqual(len(truth), len(self.frames))
        for index, frame in enumerate(truth):
            for name, joint in frame["bodies"][0]["joints"].items():
                wanted = self.joints(index)[name]
                for axis in "xyz" if "x" in wanted else "":
                    self.assertAlmostEqual(joint[axis], wanted[axis], delta=metres)

    def test_bvh_comes_back_as_near_as_its_bones_allow(self):
        code, _, error = chorus("export", self.ndjson, "--format", "bvh", "--out", self.at / "walk.bvh", "--json")
        self.assertEqual(code, 0)
        promised = float(json.loads(error)["remarks"][0].split("at most ")[1].split(" mm")[0]) / 1000
        self.assertLess(promised, 0.1)
        self.comes_back("bvh", promised + 0.0002)

    def test_every_source_gives_the_same_bytes(self):
        piped = self.export("csv")
        recording = self.at / "fused.mcap"
        code, _, error = chorus("fuse", self.at / "rec", "--config", f"{CAMERAS}/fusion.json", "--registration",
                                self.at / "rec" / "registration.json", "--out", recording)
        self.assertEqual(code, 0, error)
        for source in (self.ndjson, recording):
            code, out, _ = chorus("export", source, "--format", "csv", "--out", "-")
            self.assertEqual((code, out), (0, piped), source)

    def test_a_running_server_is_listened_to(self):
        server = FakeFusion("\n".join(map(json.dumps, self.frames)).encode())
        try:
            code, out, error = chorus("export", server.url, "--seconds", "1.2", "--format", "csv", "--out", "-")
        finally:
            server.stop()
        self.assertEqual(code, 0, error)
        rows = list(csv.DictReader(io.StringIO(out.decode())))
        # The last one may have been under way when the time was over.
        self.assertGreaterEqual(len(rows) / 25, max(1, server.served - 2), "what was served is written")
        first = next(i for i, frame in enumerate(self.frames) if frame["captured"] == rows[0]["utc"])
        self.assertAlmostEqual(float(rows[0]["x_m"]), self.joints(first)["SpineBase"]["x"], places=6)

    def test_what_goes_wrong_says_what_to_do(self):
        for source, words in [
                (self.at / "rec", ["is of sensor cam0", "in its own space", "chorus fuse"]),
                (self.at / "nothing", ["no such file"]),
                (CAMERAS + "/fusion.json", ["fusion.json", "neither a recording"]),
                ("http://127.0.0.1:1/", ["is chorus-fusion running there?"])]:
            code, _, error = chorus("export", source, "--format", "csv", "--out", self.at / "x")
            self.assertEqual(code, 1, error)
            for word in words:
                self.assertIn(word, error)
        code, _, error = chorus("export", self.ndjson, "--format", "csv", "--person", "99", "--out", "-")
        self.assertEqual(code, 1)
        self.assertIn("there are: 1", error)
        code, _, error = chorus("export", self.ndjson, "--format", "fbx", "--out", "-")
        self.assertEqual(code, 2)
        code, _, error = chorus("export", self.ndjson, "--format", "csv", "--out", self.at / "no" / "folder.csv")
        self.assertEqual(code, 1)
        self.assertIn("is its folder there?", error)


if __name__ == "__main__":
    unittest.main()
