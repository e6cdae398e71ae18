"""The services answer as proto/openapi.json specifies: statuses and media types of every GET."""
import json
import unittest
from urllib.parse import quote

from rig import BIN, ROOT, Rig, get, get_json

DOCUMENT = json.loads((ROOT / "proto/openapi.json").read_text(encoding="utf-8"))
GETS = {path: methods["get"]["responses"] for path, methods in DOCUMENT["paths"].items() if "get" in methods}
NEVER = "application/x-none-of-ours"


def bare(headers):
    return headers.get("Content-Type", "").split(";")[0]


class Contract(Rig):
    def check(self, service, places):
        """Requests each path of {path of the document: path requested} with every media type that is offered."""
        for path, asked in places.items():
            documented = GETS[path]
            types = documented["200"].get("content", {})
            for accept in (*types, "*/*", NEVER):
                if accept == "text/event-stream":
                    continue  # such a stream never ends
                status, headers, body = get(service.url + asked.lstrip("/"), accept=accept)
                with self.subTest(path=path, accept=accept, status=status):
                    self.assertIn(str(status), documented, body[:200])
                    if status == 200:
                        self.assertIn(bare(headers), types)
                        if accept in types:
                            self.assertEqual(bare(headers), accept)

    def test_fusion_keeps_it(self):
        sensor = self.sensor(0)
        fusion = self.fusion({"s1": sensor.url}, viewer_dir=str(ROOT / "services/viewer"))
        plain = {path: path for path in GETS if "{" not in path and not path.startswith("/images/")}
        self.check(fusion, plain | {"/sensors/{id}": "/sensors/s1", "/sensors/{id}/frame": "/sensors/s1/frame",
                                    "/frames/{seq}": f"/frames/{get_json(fusion.url + 'frame')['sequence']}"})
        self.check(fusion, {"/sensors/{id}": "/sensors/none", "/frames/{seq}": "/frames/1", "/recordings/{name}": "/recordings/none"})
        for at, expected in (("yesterday", 400), ("2001-01-01T00:00:00Z", 410)):
            status = get(fusion.url + "frame?at=" + quote(at))[0]
            self.assertEqual(status, expected, at)
            self.assertIn(str(status), GETS["/frame"])
        for query, expected in (("?limit=0", 400), ("?limit=3&after=a", 200)):
            status = get(fusion.url + "recordings/" + query)[0]
            self.assertEqual(status, expected, query)
            self.assertIn(str(status), GETS["/recordings/"])

    def test_a_sensor_keeps_it(self):
        sensor = self.sensor(0, images="true")
        self.check(sensor, {path: path for path in GETS if "{" not in path and path not in
                            ("/sensors/", "/registration", "/viewer/")})


if __name__ == "__main__":
    assert BIN.exists(), f"build chorus-fusion first ({BIN})"
    unittest.main(verbosity=2)
