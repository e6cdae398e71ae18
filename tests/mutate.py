#!/usr/bin/env python3
"""Makes one error at a time and checks which unit test fails.  To be run by hand, not in CI.

    tests/mutate.py                      the forty named mutants, then a hundred drawn ones
    tests/mutate.py --drawn 0            the named ones only
    tests/mutate.py --again survived     tests those that survived once more, after a test was added
    tests/mutate.py --report             prints the results file as Markdown; builds nothing

The checkout is not changed: everything is built in a copy (--scratch). Results are stored there line by line, so that a run can be stopped
at any time and continues where it was. Exit code 0: all named mutants were killed, and at most 15 in a hundred of the drawn ones survived;
1: not so; 2: it could not be tested.
"""

import argparse
import itertools
import json
import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "mutation"))

from rules import Mutant, drawn  # noqa: E402
from scratch import FileRound, Results, Scratch  # noqa: E402

CHECKOUT = Path(__file__).resolve().parent.parent
NAMED = Path(__file__).parent / "mutation" / "named.json"
SURVIVORS_ALLOWED = 0.15
FIRST_DRAWN = 1000


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--drawn", type=int, default=100, help="how many mutants are drawn")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--scratch", default=f"/tmp/chorus-mutants-{os.getuid()}", help="folder for the copy, its build and the results")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--limit", type=int, default=120, help="seconds for one test program")
    parser.add_argument("--again", choices=["survived", "all"], help="forgets these results first")
    parser.add_argument("--report", action="store_true")
    return parser.parse_args()


def named_mutants(entries, read):
    """{name: Mutant}; a line that does not occur exactly once is an error that names the mutant."""
    mutants = {}
    for entry in entries:
        lines = read(entry["file"]).splitlines()
        places = [i for i, line in enumerate(lines) if line.strip() == entry["line"]]
        if len(places) != 1:
            raise SystemExit(f"mutate: '{entry['name']}': {entry['file']} has its line {len(places)} times: {entry['line']}\n"
                             f"        Give tests/mutation/named.json the line as it is now.")
        before = lines[places[0]]
        after = before[:len(before) - len(before.lstrip())] + entry["broken"]
        mutants[entry["name"]] = Mutant(entry["file"], places[0] + 1, before, after, "named")
    return mutants


def wanted_draws(texts, seed, count, known):
    """The first `count` mutants that compile, as far as that is known."""
    usable = (m for m in drawn(texts, seed) if known.get(m.key, {}).get("status") != "does not compile")
    return list(itertools.islice(usable, count))


def check_baseline(scratch, file, limit, passed):
    """A test that fails without a mutant says nothing about one."""
    tests = [test for test in scratch.tests_of(file) if test not in passed]
    problem = scratch.make(*tests) if tests else ""
    for test in tests:
        problem = problem or scratch.ask(test, -1, limit)
        if problem:
            raise SystemExit(f"mutate: {test} does not pass without any mutant:\n{problem[-2000:]}")
    passed.update(tests)


def ask_all(scratch, results, numbered, labels, limit):
    by_file, passed = {}, set()
    for number, mutant in numbered.items():
        if mutant.key not in results.known:
            by_file.setdefault(mutant.file, {})[number] = mutant
    for file, mutants in sorted(by_file.items()):
        check_baseline(scratch, file, limit, passed)
        for number, result in FileRound(scratch, file, mutants, limit).results():
            entry = results.add(mutants[number], result, **labels.get(number, {}))
            print(f"{entry['status']:>16}  {entry['key']}  {entry.get('by', '')}", flush=True)


def report(named, draws, known):
    rows = ["| mutant | what it breaks | who notices |", "|---|---|---|"]
    for mutant in named.values():
        entry = known.get(mutant.key, {})
        rows.append(f"| {entry.get('name', mutant.key)} | {entry.get('breaks', '')} | {entry.get('by') or entry.get('status', 'not asked')} |")
    asked = [known[m.key] for m in draws if m.key in known]
    survivors = [entry for entry in asked if entry["status"] == "survived"]
    rows.append(f"\nDrawn: {len(asked)} of {len(draws)} asked, {len(asked) - len(survivors)} died, {len(survivors)} survived:\n")
    rows += [f"- `{entry['key']}` ({entry['rule']})" for entry in survivors]
    return "\n".join(rows)


def good(named, draws, known):
    killed = all(known.get(m.key, {}).get("status") == "killed" for m in named.values())
    survivors = sum(known.get(m.key, {}).get("status") == "survived" for m in draws)
    return killed and survivors <= SURVIVORS_ALLOWED * max(1, len(draws))


def forget(results, which):
    kept = [e for e in results.known.values() if which != "all" and e["status"] != which]
    results.path.write_text("".join(json.dumps(entry) + "\n" for entry in kept))
    return Results(results.path)


def main():
    options = arguments()
    entries = json.loads(NAMED.read_text())
    named = named_mutants(entries, lambda file: (CHECKOUT / file).read_text())
    scratch = Scratch(CHECKOUT, options.scratch, options.jobs)
    texts = scratch.texts()
    results = Results(Path(options.scratch) / "build" / "mutants.jsonl")
    if options.again and not options.report:
        results = forget(results, options.again)
    labels = {number: entry for number, entry in enumerate(entries)}
    labels = {number: {"name": entry["name"], "breaks": entry["breaks"]} for number, entry in labels.items()}
    if not options.report:
        scratch.refresh()
        scratch.configure()
        ask_all(scratch, results, dict(enumerate(named.values())), labels, options.limit)
        while True:
            draws = wanted_draws(texts, options.seed, options.drawn, results.known)
            unasked = [m for m in draws if m.key not in results.known]
            if not unasked:
                break
            ask_all(scratch, results, dict(enumerate(unasked, FIRST_DRAWN)), {}, options.limit)
    draws = wanted_draws(texts, options.seed, options.drawn, results.known)
    print(report(named, draws, results.known))
    return 0 if good(named, draws, results.known) else 1


if __name__ == "__main__":
    sys.exit(main())
