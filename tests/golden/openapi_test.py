"""proto/openapi.json: its references resolve, it has every path of proto/README.md and of the sources, README.md has every path of it, openapi.yaml is generated from it, and its schemas
accept the golden JSON and refuse it if anything required is missing.

usage: openapi_test.py PROTO_FOLDER
"""
import json
import pathlib
import re
import subprocess
import sys

from json_schema import fits, resolve

proto = pathlib.Path(sys.argv[1])
document = json.loads((proto / "openapi.json").read_text(encoding="utf-8"))
failures = []


def references(node):
    if isinstance(node, dict):
        if "$ref" in node:
            yield node["$ref"]
        node = node.values()
    if not isinstance(node, (str, int, float, bool, type(None))):
        for item in node:
            yield from references(item)


for reference in references(document):
    try:
        resolve(document, reference)
    except KeyError:
        failures.append(f"{reference} leads nowhere")

readme = (proto / "README.md").read_text(encoding="utf-8")
table = readme.split("## 2. Resources")[1].split("## 3.")[0]
for line in table.splitlines():
    if line.startswith("| `/"):
        for path in re.findall(r"`(/[^`]*)`", line.split("|")[1]):
            if path not in document["paths"]:
                failures.append(f"{path} of README.md is not in openapi.json")

paths_told = set(re.findall(r"`(/[^`]*)`", table))
failures += [f"{path} of openapi.json is not in section 2 of README.md" for path in sorted(set(document["paths"]) - paths_told)]

# What services answer: the literal patterns that their sources give to http::Router.
ROUTE = re.compile(r'(?:\.|->)(get|live|action|dialogue)\(\s*(?:(?:http::)?Method::(\w+),\s*)?(one)?(?: \+ )?(?:"(/[^"]*)")?')
routes = 0
for source in sorted(f for room in ("common/service", "fusion-server", "services") for f in (proto.parent / room).rglob("*.cpp")):
    if "services/ctl/" in source.as_posix() or "node_modules" in source.parts:  # a client
        continue
    text = source.read_text(encoding="utf-8")
    one = re.search(r'const std::string one = "(/[^"]*)"', text)
    for kind, method, first, rest in ROUTE.findall(text):
        path = (one.group(1) if first and one else "") + rest
        if not path:
            continue
        routes += 1
        if kind == "dialogue" and f"`{path}`" in readme:  # a WebSocket, which OpenAPI has no word for
            continue
        if (method or "get").lower() not in document["paths"].get(path, {}):
            failures.append(f"{source.relative_to(proto.parent)} answers {method or 'GET'} {path}, which is not in openapi.json")
if routes < 80:
    failures.append(f"only {routes} patterns were found in the sources: has http::Router changed?")

schema = {"$ref": "#/components/schemas/Frame"}
for path in sorted(proto.glob("golden/perfect/*.json*")):
    frame = json.loads(path.read_text(encoding="utf-8"))
    if not fits(frame, schema, document):
        failures.append(f"{path.name} does not fit the schema of a frame")
    for key in document["components"]["schemas"]["Frame"]["required"]:
        if fits({k: v for k, v in frame.items() if k != key}, schema, document):
            failures.append(f"{path.name} without {key} still fits")

run = subprocess.run([sys.executable, str(proto / "openapi_yaml.py"), "--check"], capture_output=True, text=True)
if run.returncode != 0:
    failures.append(run.stderr.strip())

for failure in failures:
    print("FAILED:", failure)
print(f"{len(document['paths'])} paths checked")
sys.exit(1 if failures else 0)
