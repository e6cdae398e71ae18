"""A copy of the tree with a build of its own, in which files can be broken."""

import json
import os
import re
import shutil
import subprocess
import time
from pathlib import Path

from schema import HEADER, merged

ROOMS = ("registration", "fusion", "facing", "associate", "align")
# For files of other rooms that contain a named mutant: file -> tests.
OTHER_TESTS = {"common/time/clock_estimate.cpp": ["time.clock_estimate_test"],
               "common/body/interpolate.cpp": ["body.interpolate_test"]}
SLOW = ("solve_test", "pair_test", "covariance_test")  # run last
FAILED = re.compile(r"\[  FAILED  \] (\S+)")
BROKEN = ".broken.h"
ERROR = re.compile(r"([\w-]+\.broken\.h):(\d+):\d+: +(?:(?:fatal )?error|required from)")


class Scratch:
    def __init__(self, checkout, folder, jobs):
        self.tree = Path(folder)
        self.build = self.tree / "build" / "dev"
        self.checkout = Path(checkout)
        self.jobs = jobs
        self.environment = dict(os.environ, CCACHE_SLOPPINESS="pch_defines,time_macros")

    def run(self, *command, **options):
        return subprocess.run(command, capture_output=True, text=True, errors="replace", env=self.environment, check=False,
                              **options)

    def refresh(self):
        """Copies all files that git tracks or would add; unchanged files keep their time, so that nothing is rebuilt needlessly."""
        listed = self.run("git", "-C", str(self.checkout), "ls-files", "-co", "--exclude-standard").stdout.splitlines()
        for name in listed:
            source, target = self.checkout / name, self.tree / name
            if not source.is_file():
                continue
            if target.is_file() and target.read_bytes() == source.read_bytes():
                continue
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, target)
        known = set(listed)
        for path in list(self.tree.rglob("*")):
            name = str(path.relative_to(self.tree))
            if path.is_file() and name not in known and not name.startswith("build/"):
                path.unlink()

    def configure(self):
        launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        # Of a unity build, every mutant would compile its neighbours too.
        done = self.run("cmake", "--preset", "dev", "-DCHORUS_UNITY=OFF", *launcher, cwd=self.tree)
        if done.returncode != 0:
            raise SystemExit("mutate: the scratch copy does not configure:\n" + done.stderr[-2000:])

    def make(self, *targets):
        """Builds the targets; returns '' or, if that fails, the compiler's output."""
        done = self.run("ninja", "-C", str(self.build), f"-j{self.jobs}", *targets)
        return "" if done.returncode == 0 else done.stdout + done.stderr

    def texts(self):
        files = [path for room in ROOMS for path in sorted((self.checkout / "fusion-server" / room).glob("*.cpp"))]
        return {str(path.relative_to(self.checkout)): path.read_text() for path in files}

    def tests_of(self, file):
        """The file's own test first, slow tests last."""
        if file in OTHER_TESTS:
            return OTHER_TESTS[file]
        room, stem = Path(file).parent.name, Path(file).stem
        names = [path.stem for path in sorted((self.checkout / "tests/unit" / room).glob("*_test.cpp"))]
        first = f"{stem}_test"
        names.sort(key=lambda name: (name != first, name.endswith(SLOW), name))
        return [f"{room}.{name}" for name in names]

    def ask(self, test, number, limit):
        """Which case fails first: its name, 'crash' or 'time limit'; '' if none fails."""
        program = self.build / "tests" / test
        environment = dict(self.environment, CHORUS_MUTANT=str(number))
        try:
            done = subprocess.run([program, "--gtest_brief=1", "--gtest_fail_fast"], cwd=self.tree, capture_output=True, text=True,
                                  errors="replace", env=environment, timeout=limit, check=False)
        except subprocess.TimeoutExpired:
            return "time limit"
        if done.returncode == 0:
            return ""
        found = FAILED.search(done.stdout)
        return found.group(1) if found else f"crash ({done.returncode})"

    def plant(self, file, text):
        """Replaces the file by an #include of the broken text, a system header so that its warnings are no errors."""
        broken = self.tree / (file.removesuffix(".cpp") + BROKEN)
        broken.write_text("#pragma GCC system_header\n" + text)
        (self.tree / file).write_text(f'#include "{broken.relative_to(self.tree)}"\n')

    def restore(self, file, text):
        (self.tree / file).write_text(text)

    def wrong_lines(self, file, output):
        lines = set()
        for match in ERROR.finditer(output):
            name, line = match.groups()
            if name == Path(file).stem + BROKEN:
                lines.add(int(line) - 2)  # the pragma and the include at the top
        return lines


class FileRound:
    """All mutants of one file that are not tested yet."""

    def __init__(self, scratch, file, numbered, limit):
        self.scratch = scratch
        self.file = file
        self.left = dict(numbered)
        self.single = {}  # mutants to be built separately
        self.built = set()  # the tests that contain the present mutants
        self.limit = limit
        self.original = (scratch.checkout / file).read_text()

    def verdict(self, number):
        started = time.monotonic()
        for test in self.scratch.tests_of(self.file):
            output = "" if test in self.built else self.scratch.make(test)
            self.built.add(test)
            if output:
                return {"status": "does not compile", "seconds": round(time.monotonic() - started, 1), "compiler": output[-300:]}
            killer = self.scratch.ask(test, number, self.limit)
            if killer:
                return {"status": "killed", "by": f"{test}: {killer}", "seconds": round(time.monotonic() - started, 1)}
        return {"status": "survived", "seconds": round(time.monotonic() - started, 1)}

    def together(self):
        """Tests as many mutants as fit into one build at a time; yields (number, result)."""
        while True:
            text, taken = merged(self.original, self.left)
            if len(taken) < 2:
                return
            (self.scratch.tree / "mutation_schema.h").write_text(HEADER)
            self.built.clear()
            self.scratch.plant(self.file, '#include "mutation_schema.h"\n' + text)
            output = self.scratch.make(self.scratch.tests_of(self.file)[0])
            if output:
                wrong = self.scratch.wrong_lines(self.file, output)
                bad = [number for number, line in taken.items() if line in wrong] or list(taken)
                self.single.update((number, self.left.pop(number)) for number in bad)
                continue
            for number in taken:
                yield number, self.verdict(number)
                del self.left[number]

    def alone(self):
        for number, mutant in {**self.single, **self.left}.items():
            lines = self.original.splitlines()
            lines[mutant.line - 1] = mutant.after
            self.built.clear()
            self.scratch.plant(self.file, "\n".join(lines) + "\n")
            yield number, self.verdict(number)

    def results(self):
        try:
            yield from self.together()
            yield from self.alone()
        finally:
            self.scratch.restore(self.file, self.original)


class Results:
    """One JSON object per line; mutants found there are not tested again."""

    def __init__(self, path):
        self.path = Path(path)
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.known = {}
        if self.path.exists():
            for line in self.path.read_text().splitlines():
                entry = json.loads(line)
                self.known[entry["key"]] = entry

    def add(self, mutant, result, **more):
        entry = {"key": mutant.key, "file": mutant.file, "rule": mutant.rule, **more, **result}
        self.known[mutant.key] = entry
        with self.path.open("a") as file:
            file.write(json.dumps(entry) + "\n")
        return entry
