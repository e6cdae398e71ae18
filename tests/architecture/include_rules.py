"""The house rules that a program can check: which room may include which, what stages must not use, and how long a file may be.
docs/architecture.md shows the same table as a picture."""

import re
from dataclasses import dataclass
from pathlib import Path

# A room includes only rooms of earlier rows, never one of its own row.
ROWS = [
    ["common/base"],
    ["common/time", "common/geometry", "common/tls", "common/report"],
    ["common/rdf", "common/net", "common/alignment"],
    ["common/http"],
    ["common/body", "common/inertial"],
    ["common/sensor", "common/layout", "common/posture", "common/workplace"],
    ["common/motion", "common/resource", "common/ergonomics"],
    ["common/record", "common/client", "common/evaluation", "common/suit", "common/silhouette"],
    ["common/synthetic", "common/service", "common/importers", "common/exporters", "common/calibration", "common/hand",
     "common/characteristics", "common/assessment", "common/quality", "common/comparison", "common/positioning"],
    ["fusion-server/flow"],
    ["fusion-server/status", "fusion-server/sink.h"],
    ["fusion-server/align", "fusion-server/facing", "fusion-server/associate", "fusion-server/fusion", "fusion-server/watch", "fusion-server/worn"],
    ["fusion-server/registration"],
    ["fusion-server/site"],
    ["fusion-server/pipeline", "fusion-server/learn"],
    ["fusion-server/core", "fusion-server/wire", "fusion-server/outlet", "fusion-server/journal", "services/sensor",
     "services/ergonomics", "services/evaluation"],
    ["fusion-server/vrpn", "fusion-server/dtrack", "fusion-server/natnet", "fusion-server/trackd",
     "fusion-server/osc", "fusion-server/mxtp", "fusion-server/rest", "fusion-server/foxglove", "fusion-server/nats", "fusion-server/mqtt"],
    ["fusion-server/outputs"],
    ["fusion-server/server"],
    ["services/ctl"],
]
ROW_OF = {room: row for row, rooms in enumerate(ROWS) for room in rooms}

# A header of values that is a room of its own.
VALUE_HEADERS = {"fusion-server/sink.h"}

STAGES = {f"fusion-server/{stage}" for stage in ("align", "facing", "associate", "fusion", "watch", "worn", "registration", "site")}
FUSION_SERVER = {room for room in ROW_OF if room.startswith("fusion-server/")}
# These rooms are usable without a network: they must not include or link it, not even indirectly.
NO_SOCKET = {"fusion-server/core", "fusion-server/journal", "fusion-server/learn", "fusion-server/pipeline", "fusion-server/flow", "fusion-server/status"} | VALUE_HEADERS | STAGES
# These rooms implement protocols other than HTTP: they may use sockets, but no HTTP.
NO_HTTP = {f"fusion-server/{room}" for room in ("outlet", "vrpn", "dtrack", "natnet", "trackd", "osc", "mxtp", "mqtt")}

# Each entry: the rooms, what they must not include, and why.
FORBIDDEN_ROOMS = [
    (FUSION_SERVER | {"common/inertial", "common/evaluation"}, {"common/synthetic"}, "what judges an algorithm must not feed it"),
    (STAGES, {"common/net", "common/http", "common/resource", "common/record", "common/service", "common/rdf"},
     "stages know values, not their wire forms"),
    (STAGES - {"fusion-server/registration", "fusion-server/site"}, STAGES, "stages meet in flow only"),
    ({"fusion-server/site"}, STAGES - {"fusion-server/associate", "fusion-server/registration", "fusion-server/site"}, "site may use associate and registration only"),
    ({"fusion-server/registration"}, STAGES - {"fusion-server/align"}, "registration may use align only"),
    (NO_SOCKET, {"common/net", "common/http", "common/client", "common/service"}, "no socket here"),
    (NO_HTTP, {"common/http", "common/client", "common/service"}, "a tracker protocol needs sockets, not HTTP"),
    ({"services/sensor", "services/ergonomics", "services/evaluation"}, FUSION_SERVER, "running services meet over HTTP"),
    (FUSION_SERVER, {"services/sensor", "services/ergonomics", "services/evaluation"}, "running services meet over HTTP"),
]

STAGE_HEADERS = re.compile(
    r"<(boost/(asio|beast)|serd|nlohmann/|thread>|mutex>|shared_mutex>|condition_variable>|iostream>|fstream>)")
STAGE_CLOCKS = re.compile(r"common/time/clock\.h|(system|steady|high_resolution)_clock::now")
ASIO = re.compile(r"<boost/(asio|beast)")
NATS = re.compile(r"<nats/")
NATS_DOOR = "fusion-server/nats/session.cpp"
POINT_CLOUDS_AND_IMAGES = re.compile(r"<(pcl|opencv2)/")
ASIO_DOORS = {"common/net/asio.h", "common/net/asio_local.h", "common/http/beast.h", "common/http/websocket_stream.cpp"}

# Linked-data policy is passed to HTTP (common/resource/link_lines.h); HTTP must not contain it.
LINKED_DATA = re.compile(r"/ns/ldp|openapi|context\.jsonld|</shapes>|Chorus-Clock")

MAX_LINES = 400
MAX_FUNCTION_LINES = 40
FUNCTION_HEAD = re.compile(r"^[A-Za-z\[].*")
NO_FUNCTION = re.compile(r"^(namespace|extern|using|#)|\b(struct|class|enum|union|concept)\b|[^=!<>]=[^=]|R\"")
SOURCE_ENDINGS = {".h", ".cpp", ".py", ".mjs", ".js", ".sh"}
LIBRARY = re.compile(r"(?:chorus_library\(NAME\s+|target_link_libraries\(chorus_)(\w+)([^)]*)\)")
LINKED = re.compile(r"chorus::(\w+)")
BANNED_NAMES = re.compile(r"(^|_)(data|info|manager|helper|helpers|util|utils)(_|\.)")
INCLUDE = re.compile(r'^\s*#\s*include\s+(<[^>]+>|"[^"]+")', re.MULTILINE)


@dataclass(frozen=True)
class Violation:
    file: str
    message: str

    def __str__(self):
        return f"{self.file}: {self.message}"


def room_of(path):
    """'common/body/bones.h' -> 'common/body'; None for files outside our rooms."""
    if path in VALUE_HEADERS:
        return path
    parts = path.split("/")
    if len(parts) < 2 or parts[0] not in ("common", "fusion-server", "services"):
        return None
    return "/".join(parts[:2])


def layer_violations(file, text):
    own = room_of(file)
    if own not in ROW_OF:
        yield Violation(file, f"the room {own} is in no row of the layer table")
        return
    for included in INCLUDE.findall(text):
        other = room_of(included.strip('<>"'))
        if other is None or other == own:
            continue
        if other not in ROW_OF:
            yield Violation(file, f"includes {included}, whose room is in no row of the layer table")
        elif ROW_OF[other] >= ROW_OF[own]:
            yield Violation(file, f"includes {included}: {own} stands below or beside {other}")
        for who, what, why in FORBIDDEN_ROOMS:
            if own in who and other in what:
                yield Violation(file, f"includes {included}: {why}")


def header_violations(file, text):
    own = room_of(file)
    includes = INCLUDE.findall(text)
    for included in includes:
        if own in STAGES and STAGE_HEADERS.match(included):
            yield Violation(file, f"includes {included}: stages are pure")
        if ASIO.match(included) and file not in ASIO_DOORS:
            yield Violation(file, f"includes {included}: only common/net/asio.h and common/http/beast.h do")
        if NATS.match(included) and file != NATS_DOOR:
            yield Violation(file, f"includes {included}: only {NATS_DOOR} does")
        if POINT_CLOUDS_AND_IMAGES.match(included) and file.endswith(".h"):
            yield Violation(file, f"includes {included}: in .cpp files only")
    if own in STAGES and STAGE_CLOCKS.search(text):
        yield Violation(file, "reads a clock: time is an argument of a stage")
    if own == "common/http" and LINKED_DATA.search(text):
        yield Violation(file, f"says {LINKED_DATA.search(text).group()}: HTTP knows no linked data")
    if file.endswith(".h") and "#pragma once" not in text:
        yield Violation(file, "has no #pragma once")


def standing_violations(root, file, text):
    """A header is self-contained because its own source includes it first."""
    own = file.removesuffix(".cpp") + ".h"
    if not file.endswith(".cpp") or not (Path(root) / own).exists():
        return
    first = next(iter(INCLUDE.findall(text)), "nothing")
    if first != f'"{own}"':
        yield Violation(file, f"includes {first} before its own header {own}")


def form_violations(file, text):
    lines = text.count("\n")
    if lines > MAX_LINES:
        yield Violation(file, f"has {lines} lines; at most {MAX_LINES}")
    yield from long_functions(file, text)
    if BANNED_NAMES.search(file.rsplit("/", 1)[-1]):
        yield Violation(file, "its name says nothing (data, info, manager, helper, util)")


def long_functions(file, text):
    """Functions of namespaces that are too long: from the first line of their head to the closing brace, as clang-format sets them."""
    if not file.endswith((".h", ".cpp")) or file.startswith("tests/"):
        return
    head, start = [], None
    for number, line in enumerate(text.split("\n"), 1):
        code = line.split("//")[0].rstrip()
        if start is not None:
            if code.startswith("}"):
                if number - start + 1 > MAX_FUNCTION_LINES:
                    yield Violation(file, f"line {start} begins a function of {number - start + 1} lines; at most {MAX_FUNCTION_LINES}")
                head, start = [], None
        elif head or FUNCTION_HEAD.match(code):
            head.append(code)
            signature = " ".join(head)
            if code.endswith("{") and "(" in signature and not NO_FUNCTION.search(signature):
                start = number - len(head) + 1
            elif not code or code.endswith((";", "{", "}")):
                head = []


def linked_rooms(root):
    """Room -> the rooms that its library links directly or indirectly, according to the CMakeLists."""
    direct, room_by_name = {}, {}
    for file in sorted(root.glob("*/**/CMakeLists.txt")):
        relative = file.parent.relative_to(root).as_posix()
        for name, arguments in LIBRARY.findall(file.read_text(encoding="utf-8")):
            room = room_of(relative + "/CMakeLists.txt")
            if room is None:
                continue
            room_by_name[name] = room
            direct.setdefault(room, set()).update(LINKED.findall(arguments))
    reach = {room: {room_by_name[name] for name in names if name in room_by_name} for room, names in direct.items()}
    changed = True
    while changed:
        changed = False
        for room, others in reach.items():
            wider = others.union(*(reach.get(other, set()) for other in others))
            changed = changed or wider != others
            reach[room] = wider
    return reach


def link_violations(file, text, reach):
    """A room links what it includes, so that the link graph equals the layer table."""
    own = room_of(file)
    if own not in reach:
        return
    for included in INCLUDE.findall(text):
        other = room_of(included.strip('<>"'))
        if other in (None, own) or other in reach[own] or other not in reach:
            continue
        yield Violation(file, f"includes {included}, but its library does not link {other}")


def socket_violations(reach):
    for room in sorted(NO_SOCKET & reach.keys()):
        if "common/net" in reach[room]:
            yield Violation(room, "links common/net: no socket here")
    for room in sorted(NO_HTTP & reach.keys()):
        if "common/http" in reach[room]:
            yield Violation(room, "links common/http: a tracker protocol needs sockets, not HTTP")


def violations(root):
    """All violations of the rules below `root`, ordered by file."""
    root = Path(root)
    found = []
    reach = linked_rooms(root)
    found += socket_violations(reach)
    for top in ("common", "fusion-server", "services", "tests", "proto", "deploy"):
        for path in sorted((root / top).rglob("*")):
            relative = path.relative_to(root).as_posix()
            if path.suffix not in SOURCE_ENDINGS or "node_modules" in path.parts or not path.is_file():
                continue
            text = path.read_text(encoding="utf-8")
            found += form_violations(relative, text)
            found += standing_violations(root, relative, text)
            if top in ("common", "fusion-server", "services") and path.suffix in (".h", ".cpp"):
                found += layer_violations(relative, text)
                found += header_violations(relative, text)
                found += link_violations(relative, text, reach)
    return found
