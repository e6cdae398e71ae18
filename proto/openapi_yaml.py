"""Writes openapi.yaml from openapi.json, for people and tools that prefer it; with --check, only says whether it is current.

The JSON is the source: it is what the services serve, and the standard library reads it. Usage: openapi_yaml.py [--check]
"""
import json
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).parent
HEADER = "# Generated from openapi.json by openapi_yaml.py; edit that.\n"
PLAIN = re.compile(r"[A-Za-z_/$][A-Za-z0-9_./{}$-]*")
WORDS = {"true", "false", "null", "yes", "no", "on", "off", "y", "n"}


def scalar(value):
    """JSON scalars are YAML scalars; a simple word may go without quotes."""
    if isinstance(value, str) and PLAIN.fullmatch(value) and value.lower() not in WORDS and "{" not in value:
        return value
    return json.dumps(value, ensure_ascii=False)


def lines(value, indent):
    pad = "  " * indent
    if isinstance(value, dict) and value:
        for key, item in value.items():
            name = scalar(key) if not key.isdigit() else f'"{key}"'
            yield from entry(f"{pad}{name}:", item, indent)
    elif isinstance(value, list) and value:
        for item in value:
            inner = list(lines(item, indent + 1)) if isinstance(item, (dict, list)) and item else None
            if inner is None:
                yield f"{pad}- {scalar(item)}"
            else:
                yield f"{pad}- {inner[0].lstrip()}"
                yield from inner[1:]


def entry(start, item, indent):
    if isinstance(item, (dict, list)) and item:
        yield start
        yield from lines(item, indent + 1)
    else:
        yield f"{start} {scalar(item)}"


def main():
    document = json.loads((HERE / "openapi.json").read_text(encoding="utf-8"))
    text = HEADER + "\n".join(lines(document, 0)) + "\n"
    target = HERE / "openapi.yaml"
    if sys.argv[1:] == ["--check"]:
        if target.read_text(encoding="utf-8") != text:
            sys.exit("openapi.yaml is not what openapi.json says: run proto/openapi_yaml.py")
        return
    target.write_text(text, encoding="utf-8")


main()
