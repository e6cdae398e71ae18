"""The rules of a W3C Thing Description 1.1 that ours can break, written from the recommendation (https://www.w3.org/TR/wot-thing-description11/)."""

import re
from urllib.parse import urlparse

CONTEXT = "https://www.w3.org/2022/wot/td/v1.1"
SCHEMES = {"nosec", "auto", "combo", "basic", "digest", "apikey", "bearer", "psk", "oauth2"}
TYPES = {"object", "array", "string", "number", "integer", "boolean", "null"}
OPERATIONS = {"properties": {"readproperty", "writeproperty", "observeproperty", "unobserveproperty"},
              "actions": {"invokeaction", "queryaction", "cancelaction"},
              "events": {"subscribeevent", "unsubscribeevent"}}
MEDIA_TYPE = re.compile(r"[a-z]+/[a-z0-9.+-]+(;.*)?")


def is_text(value):
    return isinstance(value, str) and value != ""


def security_faults(node, definitions, where):
    names = node.get("security")
    names = [names] if isinstance(names, str) else names
    if not names or not set(names) <= set(definitions):
        yield f"{where}: security {names!r} is not defined"


def schema_faults(schema, where):
    """A data schema (5.3.2)."""
    if not isinstance(schema, dict) or schema.get("type", "object") not in TYPES:
        yield f"{where}: is no data schema"


def form_faults(form, kind, variables, definitions, where):
    """A form (5.3.4.2)."""
    if not isinstance(form.get("href"), str):
        yield f"{where}: has no href"
    elif not set(re.findall(r"\{([^}]*)\}", form["href"])) <= set(variables):
        yield f"{where}: {form['href']} has variables without uriVariables"
    operations = form.get("op", [])
    if not set([operations] if isinstance(operations, str) else operations) <= OPERATIONS[kind]:
        yield f"{where}: op {operations!r} is none of {kind}"
    if not MEDIA_TYPE.fullmatch(form.get("contentType", "application/json")):
        yield f"{where}: contentType {form['contentType']!r}"
    if "response" in form and not MEDIA_TYPE.fullmatch(form["response"].get("contentType", "")):
        yield f"{where}: response without contentType"
    if "security" in form:
        yield from security_faults(form, definitions, where)


def affordance_faults(affordance, kind, definitions, where):
    """A property, action or event (5.3.1)."""
    variables = affordance.get("uriVariables", {})
    for name, schema in variables.items():
        yield from schema_faults(schema, f"{where}.uriVariables.{name}")
        if schema.get("type") in ("object", "array"):
            yield f"{where}: variable {name} is no single value"
    for key in ("readOnly", "writeOnly", "observable", "safe", "idempotent", "synchronous"):
        if key in affordance and not isinstance(affordance[key], bool):
            yield f"{where}.{key} is not true or false"
    for key in ("input", "output", "data", "subscription"):
        if key in affordance:
            yield from schema_faults(affordance[key], f"{where}.{key}")
    if not affordance.get("forms"):
        yield f"{where}: has no forms"
    for number, form in enumerate(affordance.get("forms", [])):
        yield from form_faults(form, kind, variables, definitions, f"{where}.forms[{number}]")


def faults(thing):
    """Everything that is wrong with a Thing Description."""
    context = thing.get("@context")
    if (context[0] if isinstance(context, list) and context else context) != CONTEXT:
        yield f"@context does not begin with {CONTEXT}"
    if not is_text(thing.get("title")):
        yield "there is no title"
    if "base" in thing and not (urlparse(thing["base"]).scheme and urlparse(thing["base"]).netloc):
        yield f"base {thing['base']!r} is not absolute"
    if "version" in thing and not is_text(thing["version"].get("instance")):
        yield "version has no instance"
    definitions = thing.get("securityDefinitions", {})
    for name, definition in definitions.items():
        if definition.get("scheme") not in SCHEMES:
            yield f"securityDefinitions.{name}: scheme {definition.get('scheme')!r}"
    yield from security_faults(thing, definitions, "the thing")
    for link in thing.get("links", []):
        if not isinstance(link.get("href"), str):
            yield f"link without href: {link}"
    for kind in OPERATIONS:
        for name, affordance in thing.get(kind, {}).items():
            yield from affordance_faults(affordance, kind, definitions, f"{kind}.{name}")
