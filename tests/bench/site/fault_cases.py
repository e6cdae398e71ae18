"""chorus-bench site, case faults: what happens to nats-server and to the way there, live.  What cells say wrong is in tests/system/site."""
import resource
import time

from real_hall import LAP_S, RealHall, get, wait_for
from slow_path import SlowPath

FAR_MS = 200  # there and back again: 400 ms between cells


def watch_ids(hall, seconds):
    """Ids that any cell shows, and body ids of each cell, over some time."""
    ids, bodies, end = set(), {name: set() for name in hall.names}, time.monotonic() + seconds
    while time.monotonic() < end:
        for name in hall.names:
            for site_id, person in hall.people(name).items():
                ids.add(site_id)
                if person["cell"] == name:
                    bodies[name].add(person["cellBodyId"])
        time.sleep(0.2)
    return ids, bodies


def whole_again(hall, ids):
    """How long until every cell hears the others and all show one known id [s]."""
    began = time.monotonic()

    def whole():
        shown = [set(hall.people(name)) for name in hall.names]
        heard = all(hall.states(name).count("heard") == hall.cells - 1 for name in hall.names)
        return heard and all(each and each <= ids for each in shown) and all(each == shown[0] for each in shown)

    wait_for("ids are whole again", whole)
    return time.monotonic() - began


class Rates:
    """How many frames each cell makes in a second."""

    def __init__(self, hall):
        self.hall, self.began = hall, time.monotonic()
        self.first = {name: get(hall.urls[name] + "frame")["sequence"] for name in hall.names}

    def least(self):
        return min((get(self.hall.urls[name] + "frame")["sequence"] - self.first[name]) / (time.monotonic() - self.began) for name in self.hall.names)


def far_cell(hall, path, seconds):
    """Cell b is 400 ms away from the others."""
    path.delay_s = FAR_MS / 1e3
    time.sleep(2)
    seen = watch_ids(hall, seconds)
    path.delay_s = 0.0
    return seen


def partition(hall, path, seconds):
    """Cell b and the store cannot be reached from one another; what was sent comes afterwards, all at once."""
    path.cut()
    seen = watch_ids(hall, seconds)
    assert hall.states("a").count("silent") == 1, "a hears b though nothing passes"
    path.heal()
    return seen


def full_disk(hall, path, seconds):
    """Every write of the server fails: no cell gets a claim through."""
    limit = resource.prlimit(hall.server.pid, resource.RLIMIT_FSIZE)
    resource.prlimit(hall.server.pid, resource.RLIMIT_FSIZE, (0, limit[1]))
    seen = watch_ids(hall, seconds)
    resource.prlimit(hall.server.pid, resource.RLIMIT_FSIZE, limit)
    return seen


def slow_server(hall, path, seconds):
    """It works for a tenth of a second in each second."""
    ids, bodies, end = set(), {name: set() for name in hall.names}, time.monotonic() + seconds
    while time.monotonic() < end:
        hall.server.send_signal(19)  # SIGSTOP
        seen = watch_ids(hall, 0.9)
        hall.server.send_signal(18)  # SIGCONT
        time.sleep(0.1)
        ids |= seen[0]
        for name, more in seen[1].items():
            bodies[name] |= more
    return ids, bodies


FAULTS = {"far_cell": far_cell, "full_disk": full_disk, "slow_server": slow_server, "partition": partition}


def faults(bin_folder, quick):
    seconds = LAP_S + 1 if quick else 60  # at least a lap: two hand-overs
    rows = []
    with RealHall(bin_folder, 2, 3) as hall:
        path = None

        def to_server(name):
            nonlocal path
            if name != "b":
                return hall.server_port
            path = path or SlowPath(hall.server_port)
            return path.port

        hall.start_all(to_server)
        wait_for("one id in both", lambda: len(hall.people("a")) == 1 and hall.people("a").keys() == hall.people("b").keys())
        ids, before = watch_ids(hall, LAP_S + 1)
        for name, fault in FAULTS.items():
            rates = Rates(hall)
            during, bodies = fault(hall, path, seconds)
            rows += [[f"{name}_output", rates.least(), "Hz"], [f"{name}_new_site_ids", len(during - ids), ""],
                     [f"{name}_new_body_ids", sum(len(bodies[n] - before[n]) for n in hall.names), ""]]
            ids |= during
            rows.append([f"{name}_whole_again_after", whole_again(hall, ids), "s"])
            time.sleep(LAP_S)
            after, after_bodies = watch_ids(hall, LAP_S)
            rows.append([f"{name}_ids_a_lap_later", len(after), ""])
            ids |= after
            for each in hall.names:
                before[each] |= bodies[each] | after_bodies[each]
        path.close()
    return rows, [f"each fault lasts {seconds:.0f} s; the far cell's way to the server takes {FAR_MS} ms each way"]
