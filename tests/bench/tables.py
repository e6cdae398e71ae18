#!/usr/bin/env python3
"""Writes the tables of docs/benchmarks from what chorus-bench measured.

    build/release/bin/chorus-bench fusion --only workshop6-A --json results/fusion-workshop6-A.json
    tests/bench/tables.py results docs/benchmarks/fusion.md

Replaces the text between `<!-- table NAME -->` and `<!-- end -->` by the table of that name, from all files results/*.json. A case that no
file has is left out of the table; a table without any case is an error, so that an old one never stands under a new heading.
"""

import json
import re
import sys
from pathlib import Path

MARK = re.compile(r"(<!-- table (\S+) -->\n).*?(<!-- end -->)", re.S)
FAMILIES = ["workshop6", "sensors", "flip", "silence", "prediction", "cost", "scale", "crossing", "booth", "relay", "return", "furniture", "side", "pair", "ring6", "line4"]


class Rows:
    """All rows of all files, by case, metric and baseline. Ours is the row without a baseline or with the baseline `ours`."""

    def __init__(self, folder):
        self.found = {}
        self.builds = set()
        for path in sorted(Path(folder).glob("*.json")):
            document = json.loads(path.read_text())
            self.builds.add(document["git"])
            for row in document["rows"]:
                beside = self.found.setdefault((row["case"], row["metric"]), {})
                if row["baseline"] in beside:
                    raise SystemExit(f"tables: {path} measures {row['case']} again, which another file has; keep one of them in the folder")
                beside[row["baseline"]] = row

    def cases(self, pattern):
        names = {case for case, _ in self.found if re.fullmatch(pattern, case)}
        family = {name: next((i for i, known in enumerate(FAMILIES) if name.startswith(known)), len(FAMILIES)) for name in names}
        return sorted(names, key=lambda name: (family[name], [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)]))

    def row(self, case, metric, baseline=None):
        rows = self.found.get((case, metric), {})
        if baseline is None:
            return rows.get("ours") or rows.get("") or next(iter(rows.values()), None)
        return rows.get(baseline)


def number(value):
    if value is None:
        return "-"
    if abs(value) < 1e-9:
        return "0"
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.3g}"


def ours(metric, spread=True):
    def cell(rows, case):
        row = rows.row(case, metric)
        if row is None:
            return ""
        range_of = row.get("spread")
        text = number(row["value"])
        return f"{text} ({number(range_of['p5'])} to {number(range_of['p95'])})" if spread and range_of else text

    return cell


def beside(metric, baseline):
    """Ours over the baseline's in the same run; in brackets the share of draws that ours won."""

    def cell(rows, case):
        row = rows.row(case, metric, baseline)
        if row is None:
            return ""
        won = row.get("won_percent")
        return number(row["ratio"]) + (f" ({won:.0f} %)" if won is not None else "")

    return cell


def share_of(metric, baseline):
    """Ours over the baseline's, where each has a row of its own."""

    def cell(rows, case):
        own, other = rows.row(case, metric), rows.row(case, metric, baseline)
        return number(own["value"] / other["value"]) if own and other and other["value"] else ""

    return cell


def theirs(metric, baseline):
    def cell(rows, case):
        row = rows.row(case, metric, baseline)
        value = None if row is None else row.get("beside", {}).get("median", row["value"])
        return "" if row is None else number(value)

    return cell


def honesty(suffix=""):
    """NEES / % in the 95 % ball / sharpness."""

    def cell(rows, case):
        found = [rows.row(case, metric + suffix) for metric in ("nees", "ball95_percent", "sharpness")]
        return " / ".join(number(row["value"]) for row in found) if all(found) else ""

    return cell


def three(metric):
    """Ours, nearest neighbour's, the best single sensor's own ids; in brackets ours in 5 to 95 % of the draws."""

    def cell(rows, case):
        parts = [ours(metric)(rows, case)] + [theirs(metric, baseline)(rows, case) for baseline in ("nearest-neighbour", "best-sensor-ids")]
        return " / ".join(part or "-" for part in parts)

    return cell


FUSED = r"(workshop6|sensors|flip)-.*"
MEAN = "flip-fixed-mean-true-labels"
KALMAN = "otto-kalman-true-labels"
PEOPLE = r"(crossing|booth|relay|return|furniture|side|circled|work|around|four)-.*"
PLACED = r"(pair|ring6|line4)-.*"

TABLES = {
    "fusion-places": (FUSED, {
        "ours, mm": ours("mpjpe_mm"),
        "of the mean, true labels": beside("mpjpe_mm", MEAN),
        "of `otto`": beside("mpjpe_mm", "otto"),
        "of `otto-kalman`, true labels": beside("mpjpe_mm", KALMAN),
        "bound, mm": theirs("mpjpe_mm", "bound"),
        "sides wrong, %": ours("flip_percent"),
        "limbs exchanged, %": ours("limb_flip_percent"),
        "missing, %": ours("missing_percent"),
    }),
    "fusion-time": (FUSED, {
        "latency, ms": ours("latency_ms"),
        "jumps a minute": ours("jumps_per_minute"),
        "jitter of the trunk": beside("jitter_core_mm", KALMAN),
        "of limbs": beside("jitter_extremity_mm", KALMAN),
        "foot slide": beside("foot_slide_mm", KALMAN),
        "bone variation, %": ours("bone_cv_percent"),
        "bone length, %": ours("bone_length_error_percent"),
    }),
    "fusion-honesty": (FUSED, {
        "all": honesty(),
        "1 view, rest": honesty("_1_view_rest"),
        "1 view, moving": honesty("_1_view_moving"),
        "2 views, rest": honesty("_2_views_rest"),
        "2 views, moving": honesty("_2_views_moving"),
        "more, rest": honesty("_more_views_rest"),
        "more, moving": honesty("_more_views_moving"),
    }),
    "registration-places": (PLACED, {
        "centre, mm": ours("workspace_centre_mm"),
        "of `icp`": beside("workspace_centre_mm", "icp"),
        "of `trajectory-icp`": beside("workspace_centre_mm", "trajectory-icp"),
        "of `closed-form`": beside("workspace_centre_mm", "closed-form"),
        "place, mm": ours("position_mm"),
        "yaw, deg": ours("yaw_deg"),
        "pitch and roll, deg": ours("pitch_roll_deg"),
        "refused, %": ours("refused_percent"),
        "over 100 mm, %": ours("over_100mm_percent"),
    }),
    "fusion-silence": (r"silence-.*", {
        "farthest step, mm": ours("step_mm"),
        "had the sensor gone on": theirs("step_mm", "living"),
        "caused, mm": ours("caused_mm"),
    }),
    "fusion-prediction": (r"prediction-.*", {
        "now, mm": ours("now_mm", spread=False),
        "50 ms ahead, mm": ours("ahead_50ms_mm", spread=False),
        "of holding the pose": share_of("ahead_50ms_mm", "hold"),
        "100 ms ahead, mm": ours("ahead_100ms_mm", spread=False),
        "of holding": share_of("ahead_100ms_mm", "hold"),
        "unseen 0.5 s, mm": ours("blind_500ms_mm", spread=False),
        "of holding it": share_of("blind_500ms_mm", "hold"),
        "unseen 1 s, mm": ours("blind_1000ms_mm", spread=False),
        "of holding it still": share_of("blind_1000ms_mm", "hold"),
        "NEES now": ours("now_nees", spread=False),
        "NEES 50 ms": ours("ahead_50ms_nees", spread=False),
        "NEES unseen 0.1 s": ours("blind_100ms_nees", spread=False),
        "NEES unseen 1 s": ours("blind_1000ms_nees", spread=False),
    }),
    "persons": (PEOPLE, {
        "no id ever changed, % of draws": ours("no_switch_percent"),
        "IDF1, %": three("idf1"),
        "switches a minute": three("switches_per_minute"),
        "inherited a minute": three("inherited_per_minute"),
        "ghosts a minute, mean": ours("mean_ghosts_per_minute"),
        "not answered, %": three("missing_percent"),
        "first answer, s": ours("first_answer_s"),
        "sides wrong, %": ours("sides_wrong_percent"),
    }),
    "registration-honesty": (PLACED, {
        "in the 95 % ellipse, %": ours("ellipse95_cover_percent"),
        "within the 95 % radius, %": ours("radius95_cover_percent"),
        "95 % radius, mm": ours("radius95_mm"),
        "radius over error": ours("radius95_over_error"),
    }),
}


def table(name, rows):
    if name not in TABLES:
        raise SystemExit(f"tables: there is no table '{name}'; there are {', '.join(TABLES)}")
    pattern, columns = TABLES[name]
    cases = [case for case in rows.cases(pattern) if any(cell(rows, case) for cell in columns.values())]
    if not cases:
        raise SystemExit(f"tables: no file has a case of the table '{name}'")
    columns = {title: cell for title, cell in columns.items() if any(cell(rows, case) for case in cases)}
    lines = ["| case | " + " | ".join(columns) + " |", "|---" * (len(columns) + 1) + "|"]
    lines += ["| `" + case + "` | " + " | ".join(cell(rows, case) or "-" for cell in columns.values()) + " |" for case in cases]
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) < 3:
        raise SystemExit(__doc__)
    rows = Rows(sys.argv[1])
    for page in map(Path, sys.argv[2:]):
        text, count = MARK.subn(lambda mark: mark[1] + table(mark[2], rows) + mark[3], page.read_text())
        page.write_text(text)
        print(f"{page}: {count} tables, measured by {', '.join(sorted(rows.builds))}")


if __name__ == "__main__":
    main()
