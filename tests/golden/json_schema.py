"""The part of JSON Schema that our documents use."""
import re

TYPES = {"object": dict, "array": list, "string": str, "boolean": bool, "number": (int, float), "integer": int, "null": type(None)}


def resolve(document, reference):
    node = document
    for part in reference.removeprefix("#/").split("/"):
        node = node[part]
    return node


def fits(value, schema, document):
    """`document`: the document that the schema's references point into."""
    if "$ref" in schema:
        rest = {key: item for key, item in schema.items() if key != "$ref"}
        return fits(value, {**resolve(document, schema["$ref"]), **rest}, document)
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    checks = [
        "type" not in schema or isinstance(value, TYPES[schema["type"]]),
        "const" not in schema or value == schema["const"],
        "enum" not in schema or value in schema["enum"],
        "oneOf" not in schema or sum(fits(value, one, document) for one in schema["oneOf"]) == 1,
        "pattern" not in schema or (isinstance(value, str) and re.search(schema["pattern"], value) is not None),
        "minimum" not in schema or (number and value >= schema["minimum"]),
        "maximum" not in schema or (number and value <= schema["maximum"]),
    ]
    if isinstance(value, list):
        checks += [schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value))]
        checks += [fits(item, schema.get("items", {}), document) for item in value]
    if isinstance(value, dict):
        known = schema.get("properties", {})
        checks += [key in value for key in schema.get("required", [])]
        checks += [fits(item, known.get(key, schema.get("additionalProperties", {})), document) for key, item in value.items()]
        checks += [fits(key, schema.get("propertyNames", {}), document) for key in value]
    return all(checks)
