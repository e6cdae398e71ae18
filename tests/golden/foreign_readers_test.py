"""rapper, serdi and rdflib read everything in proto/golden/perfect and good, and our own vocabulary and shapes.

usage: foreign_readers_test.py PROTO_FOLDER.  Exit code 77: none of the three is installed.
"""
import pathlib
import shutil
import subprocess
import sys

proto = pathlib.Path(sys.argv[1])
TURTLE = sorted(proto.glob("golden/perfect/*.ttl")) + sorted(proto.glob("golden/good/*.ttl"))
TURTLE += [proto / "vocab/chorus.ttl", proto / "shapes.ttl", proto / "golden/manifest.ttl"]
NTRIPLES = sorted(proto.glob("golden/perfect/*.nt"))
BASE = "http://localhost/"
failures = []


def check(what, command):
    run = subprocess.run(command, capture_output=True, text=True)
    complaints = [line for line in run.stderr.splitlines() if "error" in line.lower() or "warning" in line.lower()]
    if run.returncode != 0 or complaints:
        failures.append(f"{what}: exit code {run.returncode} {complaints[:3]}")
    return run.stdout


def read_with_rapper():
    for path in TURTLE:
        check(f"rapper {path.name}", ["rapper", "-i", "turtle", "-c", str(path), BASE])
    for path in NTRIPLES:
        check(f"rapper {path.name}", ["rapper", "-i", "ntriples", "-c", str(path), BASE])


def read_with_serdi():
    for path in TURTLE:
        check(f"serdi {path.name}", ["serdi", "-e", "-i", "turtle", str(path), BASE])
    for path in NTRIPLES:
        check(f"serdi {path.name}", ["serdi", "-e", "-i", "ntriples", str(path)])


def read_with_rdflib(rdflib):
    from rdflib.compare import isomorphic

    for path in sorted(proto.glob("golden/perfect/*.ttl")):
        turtle = rdflib.Graph().parse(str(path), format="turtle", publicID=BASE)
        twin = path.with_suffix(".nt")
        if twin.exists() and not isomorphic(turtle, rdflib.Graph().parse(str(twin), format="nt")):
            failures.append(f"rdflib: {path.name} and {twin.name} are different graphs")
        if path.name.endswith(".arvida.ttl"):
            check_arvida_paths(rdflib, path, turtle)


def check_arvida_paths(rdflib, path, graph):
    """The property paths used by published ARVIDA clients give exactly one value each (wire format of the profile)."""
    spatial = "http://vocab.arvida.de/2015/06/spatial/vocab#"
    query = """
      PREFIX spatial: <%s> PREFIX vom: <http://vocab.arvida.de/2015/06/vom/vocab#>
      PREFIX maths: <http://vocab.arvida.de/2015/06/maths/vocab#>
      SELECT ?joint (COUNT(*) AS ?rows) WHERE {
        ?joint a spatial:SpatialRelationship ; spatial:sourceCoordinateSystem ?s ; spatial:targetCoordinateSystem ?t ;
          spatial:translation/vom:quantityValue ?p ; spatial:timestamp/vom:quantityValue/vom:numericalValue ?time .
        ?p maths:x ?x ; maths:y ?y ; maths:z ?z ; vom:unit vom:meter .
        OPTIONAL { ?joint spatial:rotation/vom:quantityValue ?q . ?q maths:x ?qx ; maths:y ?qy ; maths:z ?qz ; maths:w ?qw }
      } GROUP BY ?joint""" % spatial
    rows = {str(row.joint): int(row.rows) for row in graph.query(query)}
    tracked = set(graph.subjects(rdflib.URIRef(spatial + "translation"), None))
    if len(rows) != len(tracked) or any(count != 1 for count in rows.values()):
        failures.append(f"{path.name}: {len(tracked)} joints with a position, the client's path finds {rows}")
    if "empty" not in path.name and not tracked:
        failures.append(f"{path.name}: no joint has a position")


used = []
if shutil.which("rapper"):
    used.append("rapper")
    read_with_rapper()
if shutil.which("serdi"):
    used.append("serdi")
    read_with_serdi()
try:
    import rdflib as found_rdflib
except ImportError:
    found_rdflib = None
if found_rdflib:
    used.append("rdflib")
    read_with_rdflib(found_rdflib)

missing = sorted({"rapper", "serdi", "rdflib"} - set(used))
if missing:
    print("not installed, so not asked:", ", ".join(missing), "(packages raptor2-utils, serdi, python3-rdflib)")
print(f"{len(TURTLE)} Turtle and {len(NTRIPLES)} N-Triples documents read by {', '.join(used) or 'nobody'}")
for failure in failures:
    print("FAILED:", failure)
sys.exit(1 if failures else 0 if used else 77)
