"""Lists what a run of ctest skipped, and what each test waits for: skipped.py BUILD_FOLDER

Reads Testing/Temporary/LastTest.log: what GoogleTest, Python's unittest -v and Node's test runner print of a skipped test.
"""

import re
import sys
from pathlib import Path

ENTRY = re.compile(r"^\d+/\d+ Test: (\S+)$", re.MULTILINE)
REASONS = (
    re.compile(r"^\S+:\d+: Skipped\n(?P<reason>[^\n\[]+)", re.MULTILINE),
    re.compile(r"""\.\.\. skipped (?P<quote>['"])(?P<reason>.*)(?P=quote)$""", re.MULTILINE),
    re.compile(r"# SKIP (?P<reason>\S.*)$", re.MULTILINE),
)
SKIPPED = re.compile(r"^\[  SKIPPED \] \d+ test|^OK \(skipped=\d+\)|^# skipped [1-9]|^Test Skipped\.", re.MULTILINE)


def skipped(log):
    """Pairs of a test's name and what it waits for, in the order of the log."""
    starts = [*ENTRY.finditer(log)]
    for start, end in zip(starts, [s.start() for s in starts[1:]] + [len(log)]):
        text = log[start.end():end]
        reasons = dict.fromkeys(match["reason"].strip() for pattern in REASONS for match in pattern.finditer(text))
        if not reasons and SKIPPED.search(text):
            reasons = {"does not say": None}
        for reason in reasons:
            yield start[1], reason


def main():
    log = Path(sys.argv[1]) / "Testing/Temporary/LastTest.log"
    for name, reason in skipped(log.read_text(encoding="utf-8", errors="replace")):
        print(f"  {name}: {reason}")


if __name__ == "__main__":
    main()
