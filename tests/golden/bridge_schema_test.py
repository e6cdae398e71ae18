"""proto/bridge.schema.json accepts the golden messages of proto/golden/bridge, refuses malformed ones, and names all existing
layouts.

usage: bridge_schema_test.py PROTO_FOLDER
"""
import json
import pathlib
import re
import sys

from json_schema import fits

proto = pathlib.Path(sys.argv[1])
schema = json.loads((proto / "bridge.schema.json").read_text(encoding="utf-8"))
page = (proto / "bridge.md").read_text(encoding="utf-8")
failures = []
checked = 0

for path in sorted((proto / "golden/bridge").glob("*.jsonl")):
    for line in path.read_text(encoding="utf-8").splitlines():
        checked += 1
        message = json.loads(line)
        if not fits(message, schema, schema):
            failures.append(f"{path.name} does not fit: {line[:100]}")
        for key in schema["$defs"][message["type"].capitalize()]["required"]:
            if fits({k: v for k, v in message.items() if k != key}, schema, schema):
                failures.append(f"{path.name} without {key} still fits")

for refused in json.loads((proto / "golden/bridge/refused.json").read_text(encoding="utf-8")):
    checked += 1
    if refused["form"] == fits(refused["line"], schema, schema):
        failures.append(f"{json.dumps(refused['line'])[:100]}: form is {'fine' if refused['form'] else 'wrong'} by the schema")

for block in re.findall(r"```json\n(.*?)```", page, re.DOTALL):
    checked += 1
    if not fits(json.loads(block), schema, schema):
        failures.append(f"an example of bridge.md does not fit: {block[:100]}")

table = set(re.findall(r"`([a-z0-9_]+_\d\d)`", page.split("## 5.")[1].split("## 6.")[0]))
if table != set(schema["$defs"]["Hello"]["properties"]["layout"]["enum"]):
    failures.append("bridge.md and the schema name different layouts")

for failure in failures:
    print("FAILED:", failure)
print(f"{checked} messages checked")
sys.exit(1 if failures or checked < 30 else 0)
