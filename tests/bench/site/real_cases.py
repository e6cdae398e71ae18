"""The cases of chorus-bench site that need real processes: line-4x4, lost, faults, readers, streams.  Usage: real_cases.py CASE BIN full|quick

Prints one line of JSON: {"rows": [[metric, value, unit], ...], "notes": [...]}.
"""
import calendar
import json
import math
import pathlib
import re
import selectors
import sys
import time

from fault_cases import faults, watch_ids, whole_again
from reader_crowds import readers, streams
from real_hall import LAP_S, NatsReader, RealHall, Stream, cpu_seconds, get, percentile, wait_for


def listen(sources, seconds, handle):
    """Gives handle(name, arrival, document) what the sources say."""
    chooser = selectors.DefaultSelector()
    for name, source in sources.items():
        chooser.register(source, selectors.EVENT_READ, name)
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0:
        for key, _ in chooser.select(min(left, 0.2)):
            for arrival, document in key.fileobj.documents():
                handle(key.data, arrival, document)


class Ages:
    """Of people read in a neighbour cell, and of the same people in the message of their own cell [ms]."""

    def __init__(self):
        self.site, self.nats, self.newest = [], [], {}

    def take(self, name, arrival, document):
        if name == "nats":
            if document.get("people"):
                self.nats.append((arrival - int(document["at"])) / 1e6)
        elif name != "frame-a":
            for site_id, person in document.get("sitePeople", {}).items():
                if person["cell"] == name or self.newest.get((name, site_id)) == person["captured"]:
                    continue
                self.newest[name, site_id] = person["captured"]
                self.site.append(arrival / 1e6 - unix_ms(person["captured"]))


def unix_ms(text):
    """"2026-11-27T20:21:22.123456Z" in milliseconds since 1970."""
    whole, _, fraction = text.rstrip("Z").partition(".")
    return calendar.timegm(time.strptime(whole, "%Y-%m-%dT%H:%M:%S")) * 1e3 + float(f"0.{fraction or 0}") * 1e3


class Steps:
    """By how much the published body is elsewhere than it was going when another cell answers for it, and how much later it comes.

    Also from frame to frame while the difference between the cells fades, and where nothing fades, because noise moves it, too.
    """

    FADES_S = 0.6

    def __init__(self):
        self.last, self.moved_mm, self.late_ms, self.period = [], [], [], []
        self.fading_mm, self.usual_mm, self.stated_mm, self.changed = [], [], [], -math.inf

    def take(self, frame):
        if len(frame["bodies"]) != 1 or len(frame["sensors"]) != 1:
            self.last = []
            return
        pelvis = frame["bodies"][0]["joints"]["SpineBase"]
        now = (int(frame["capturedNanoseconds"]) / 1e9, [pelvis[key] for key in "xyz"], frame["sensors"][0])
        if len(self.last) == 8:
            first, before = self.last[0], self.last[-1]
            gap = now[0] - before[0]
            rate = [(b - a) / (before[0] - first[0]) for a, b in zip(first[1], before[1])]
            moved = 1e3 * math.dist(now[1], [b + v * gap for b, v in zip(before[1], rate)])
            if now[2] != before[2]:
                self.changed = now[0]
                self.moved_mm.append(moved)
                self.late_ms.append(1e3 * gap)
                self.stated_mm.append(1e3 * math.sqrt(sum(pelvis[key] for key in ("cxx", "cyy", "czz"))) if "cxx" in pelvis else math.nan)
            else:
                self.period.append(1e3 * gap)
                (self.fading_mm if now[0] - self.changed < self.FADES_S else self.usual_mm).append(moved)
        self.last = [*self.last[-7:], now]


def share_of_core(pid, seconds):
    begin = cpu_seconds(pid)
    time.sleep(seconds)
    return (cpu_seconds(pid) - begin) / seconds


def twin_ages(hall, sensor_ports, seconds):
    """Of the frames of cell a and of a twin of it that is in no site [ms]: the same sensors and instants, at the same time on the same machine."""
    names = ("a", hall.start_twin(0, sensor_ports))
    wait_for("the twin answers", lambda: get(hall.urls[names[1]] + "frame")["bodies"])
    time.sleep(3)
    chooser, came = selectors.DefaultSelector(), {name: [] for name in names}
    for name in names:
        chooser.register(Stream(hall.urls[name], "frame").socket, selectors.EVENT_READ, name)
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0:
        for key, _ in chooser.select(left):
            came[key.data].append((key.fileobj.recv(1 << 20), time.time_ns()))  # read later: whichever came second would wait for that
    ages = {name: dict(ages_of(pieces)) for name, pieces in came.items()}
    both = ages[names[0]].keys() & ages[names[1]].keys()
    return [ages[names[0]][at] for at in both], [ages[names[1]][at] for at in both]


def ages_of(pieces):
    """(capture time, age [ms] when all of it was there) of each frame in the pieces of an event stream, each with its time of arrival."""
    begun = b""
    for piece, arrival in pieces:
        *whole, begun = (begun + piece).split(b"\n\n")
        for event in whole:
            if found := re.search(rb'"capturedNanoseconds": ?"?(\d+)', event):
                yield int(found[1]), (arrival - int(found[1])) / 1e6


def cost_alone(bin_folder, sensors, seconds):
    """The share of a core that one cell without a site takes, with one reader and with none."""
    with RealHall(bin_folder, 1, sensors) as hall:
        hall.start_cell(0, hall.start_sensors(0), in_site=False)
        wait_for("the cell answers", lambda: get(hall.urls["a"] + "frame")["capturedNanoseconds"])
        time.sleep(5)
        unread = share_of_core(hall.fusion_pid("a"), seconds)
        begin = cpu_seconds(hall.fusion_pid("a"))
        listen({"frame-a": Stream(hall.urls["a"], "frame")}, seconds, lambda *_: None)
        return (cpu_seconds(hall.fusion_pid("a")) - begin) / seconds, unread


def line(bin_folder, quick):
    cells, sensors, seconds = (2, 3, 20) if quick else (4, 4, 60)
    with RealHall(bin_folder, cells, sensors) as hall:
        sensor_ports = hall.start_all()
        time.sleep(5)
        cpu_alone_in_site = share_of_core(hall.fusion_pid("a"), seconds / 3)  # nobody reads
        ages, steps, nats = Ages(), Steps(), NatsReader(hall.server_port, "reader", hall.password("reader"), "chorus.hall.*.people")
        sources = {name: Stream(hall.urls[name], "site/people/") for name in hall.names}
        sources |= {"nats": nats, "frame-a": Stream(hall.urls["a"], "frame"), "site": Stream(hall.urls["a"], "site/frame")}
        begin = cpu_seconds(hall.fusion_pid("a"))
        listen(sources, seconds, lambda name, *said: steps.take(said[1]) if name == "site" else ages.take(name, *said))
        cpu = (cpu_seconds(hall.fusion_pid("a")) - begin) / seconds
        sources.clear()  # hangs up
        own, twin = twin_ages(hall, sensor_ports[0], seconds)
    cpu_alone, cpu_unread = cost_alone(bin_folder, sensors, seconds / 2)
    rows = [["age_neighbour_p50", percentile(ages.site, 0.5), "ms"], ["age_neighbour_p99", percentile(ages.site, 0.99), "ms"],
            ["age_nats_p50", percentile(ages.nats, 0.5), "ms"], ["age_nats_p99", percentile(ages.nats, 0.99), "ms"],
            ["age_ratio_p50", percentile(ages.site, 0.5) / percentile(ages.nats, 0.5), ""],
            ["age_ratio_p99", percentile(ages.site, 0.99) / percentile(ages.nats, 0.99), ""],
            ["own_frame_p50", percentile(own, 0.5), "ms"], ["own_frame_p50_without_site", percentile(twin, 0.5), "ms"],
            ["own_frame_p99", percentile(own, 0.99), "ms"], ["own_frame_p99_without_site", percentile(twin, 0.99), "ms"],
            ["own_frame_later_p50", percentile([a - b for a, b in zip(own, twin)], 0.5), "ms"],
            ["handovers", len(steps.moved_mm), ""], ["handover_moved_max", max(steps.moved_mm, default=math.nan), "mm"],
            ["handover_fading_max", max(steps.fading_mm, default=math.nan), "mm"], ["elsewhere_moved_p99", percentile(steps.usual_mm, 0.99), "mm"],
            ["handover_stated_min", min(steps.stated_mm, default=math.nan), "mm"], ["handover_gap_max", max(steps.late_ms, default=math.nan), "ms"], ["frame_gap_p99", percentile(steps.period, 0.99), "ms"],
            ["core_with_site_and_readers", 100 * cpu, "%"], ["core_without_site", 100 * cpu_alone, "%"],
            ["core_with_site_unread", 100 * cpu_alone_in_site, "%"], ["core_without_site_unread", 100 * cpu_unread, "%"]]
    return rows, [f"{cells} cells of {sensors} simulated sensors round one person, all on this machine"]


def lost(bin_folder, quick):
    away, kills = (10, 1) if quick else (60, 5)
    with RealHall(bin_folder, 2, 3) as hall:
        ports = hall.start_all()
        wait_for("one id in both", lambda: len(hall.people("a")) == 1 and hall.people("a").keys() == hall.people("b").keys())
        ids, before = watch_ids(hall, LAP_S + 2)
        first = {name: get(hall.urls[name] + "frame")["sequence"] for name in hall.names}
        began = time.monotonic()
        hall.stop_server()
        during, bodies = watch_ids(hall, away)
        rates = [(get(hall.urls[name] + "frame")["sequence"] - first[name]) / (time.monotonic() - began) for name in hall.names]
        hall.start_server()
        whole = whole_again(hall, ids | during)
        time.sleep(LAP_S)
        after, _ = watch_ids(hall, 2)
        rows = [["broker_away", away, "s"], ["output_while_away", min(rates), "Hz"],
                ["new_body_ids_while_away", sum(len(bodies[n] - before[n]) for n in hall.names), ""],
                ["whole_again_after", whole, "s"], ["ids_after_a_lap", len(after), ""], ["ids_from_before", len(after & ids), ""]]
        kept = [killed_cell(hall, ports) for _ in range(kills)]
    return rows + [["cell_kills", kills, ""], ["readopted_with_their_id", 100.0 * sum(kept) / kills, "%"]], []


def killed_cell(hall, ports):
    """Whether somebody who is in cell b when it is killed has the same id when they come into a."""
    wait_for("the person is b's", lambda: [p["cell"] for p in hall.people("a").values()] == ["b"])
    ids = set(hall.people("a"))
    hall.kill("fusion-b")
    wait_for("a sees the person", lambda: [p["cell"] for p in hall.people("a").values()] == ["a"])
    time.sleep(1)
    kept = set(hall.people("a")) == ids
    hall.start_cell(1, ports[1])
    wait_for("b is back", lambda: hall.states("a").count("heard") == 1 and hall.states("b").count("heard") == 1)
    time.sleep(LAP_S / 2)
    return kept


CASES = {"line-4x4": line, "lost": lost, "faults": faults, "readers": readers, "streams": streams}


def main():
    case, bin_folder, length = sys.argv[1:4]
    rows, notes = CASES[case](pathlib.Path(bin_folder), length == "quick")
    print(json.dumps({"rows": [[m, None if isinstance(v, float) and math.isnan(v) else v, u] for m, v, u in rows], "notes": notes}))


if __name__ == "__main__":
    main()
