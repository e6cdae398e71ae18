"""Readers by others read our Turtle: rapper, serdi and rdflib; N-Triples contain the same graph."""

import shutil
import subprocess
import tempfile
import unittest

from chorus_processes import URLS, get

try:
    import rdflib
    from rdflib.compare import isomorphic
except ImportError:  # the system's python has it (python3-rdflib); others may not
    rdflib = None

PATHS = ["/", "/skeletons/", "/floor-plane", "/clock", "/ns", "/shapes"]
FUSION_PATHS = ["/registration", "/sensors/"]
CH = "https://w3id.org/chorus-tracking/ns#"


def all_turtle():
    """Everything is fetched before anything is read: a reader takes seconds on a busy machine, in which a frame's own address expires."""
    answers = []
    for base in URLS.values():
        paths = PATHS + (FUSION_PATHS if base == URLS["fusion"] else [])
        location = get(base + "/frame").headers["Content-Location"].lstrip("/")
        for path in [f"/{location}", f"/{location}?profile=arvida"] + paths:
            answers.append((base + path, get(base + path, accept="text/turtle")))
    return answers


class Readers(unittest.TestCase):
    def complaint_free(self, command, text):
        with tempfile.NamedTemporaryFile("w", suffix=".ttl") as file:
            file.write(text)
            file.flush()
            done = subprocess.run([*command, file.name], capture_output=True, text=True, timeout=30)
        noise = [line for line in done.stderr.splitlines()
                 if not line.startswith(("rapper: Parsing", "rapper: Serializing", "rapper: Parsing returned"))]
        self.assertEqual((done.returncode, noise), (0, []))

    @unittest.skipUnless(shutil.which("rapper"), "runs where rapper is installed (Debian: raptor2-utils)")
    def test_rapper(self):
        for url, answer in all_turtle():
            with self.subTest(url=url):
                self.complaint_free(["rapper", "-i", "turtle", "-c"], answer.body)

    @unittest.skipUnless(shutil.which("serdi"), "runs where serdi is installed (Debian: serdi)")
    def test_serdi(self):
        for url, answer in all_turtle():
            with self.subTest(url=url):
                self.complaint_free(["serdi", "-i", "turtle", "-e"], answer.body)

    @unittest.skipUnless(rdflib, "runs where rdflib is installed (Debian: python3-rdflib)")
    def test_rdflib_reads_the_same_graph_from_turtle_and_n_triples(self):
        for base in URLS.values():
            location = "/" + get(base + "/frame").headers["Content-Location"].lstrip("/")
            for path in [location, "/floor-plane", "/skeletons/"]:
                for _ in range(20):  # two requests: a live document may change in between
                    turtle, triples = (get(base + path, accept=a) for a in ("text/turtle", "application/n-triples"))
                    if turtle.headers["ETag"].split("-")[0] == triples.headers["ETag"].split("-")[0]:
                        break
                with self.subTest(url=base + path):
                    one = rdflib.Graph().parse(data=turtle.body, format="turtle", publicID=base + path)
                    two = rdflib.Graph().parse(data=triples.body, format="nt", publicID=base + path)
                    self.assertGreater(len(one), 2)
                    self.assertTrue(isomorphic(one, two), f"{len(one)} and {len(two)} triples")

    @unittest.skipUnless(rdflib, "runs where rdflib is installed (Debian: python3-rdflib)")
    def test_every_term_in_use_is_defined(self):
        base = URLS["fusion"]
        vocabulary = rdflib.Graph().parse(data=get(base + "/ns").body, format="turtle", publicID=base + "/ns")
        defined = {str(s) for s in vocabulary.subjects(rdflib.RDFS.label, None)}
        for url, answer in all_turtle():
            graph = rdflib.Graph().parse(data=answer.body, format="turtle", publicID=url)
            used = {str(t) for triple in graph for t in triple if str(t).startswith(CH) and str(t) != CH}
            with self.subTest(url=url):
                self.assertEqual(used - defined, set())


if __name__ == "__main__":
    unittest.main()
