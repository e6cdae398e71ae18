#!/usr/bin/env python3
"""Tests the rules of tests/mutate.py on a short file; nothing is built."""

import itertools
import json
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parent.parent))

from mutate import CHECKOUT, NAMED, named_mutants, wanted_draws  # noqa: E402
from rules import RULES, Mutant, broken_lines, drawn, mutants_of, whole_statement  # noqa: E402
from schema import merged, rewritten  # noqa: E402

CODE = """\
// a + b < 3
#include <cmath>
double area(double w, double h) {
  const double sum = w + h;  // 2 + 2
  if (sum < 2.5) return 0.0;
  log("a - b");
  total += w * h;
  for (int i = 0; i < 4; ++i) use(i);
  return sum -
         w;
}
"""


def after(line, rule):
    return [text.strip() for text in broken_lines(line, rule)]


class Rules(unittest.TestCase):
    def test_each_rule_breaks_one_thing(self):
        self.assertEqual(after("  a = b - c + d;", "sign"), ["a = b - c - d;", "a = b + c + d;"])
        self.assertEqual(after("  if (a < b && c == d) {", "comparison"), ["if (a > b && c == d) {", "if (a < b && c != d) {"])
        self.assertEqual(after("  f(2.5, 0, 1e-6);", "constant"), ["f(0.0, 0, 1e-6);", "f(2.5, 1, 1e-6);", "f(2.5, 0, 0.0);"])
        self.assertEqual(after("  total += w * h;", "dropped statement"), [";"])
        self.assertEqual(after("  if (a) b(c);", "dropped statement"), [";"])

    def test_comments_texts_includes_and_declarations_stay(self):
        for rule in RULES:
            self.assertEqual(after("// a + b < 3", rule), [])
            self.assertEqual(after('#include "a - b"', rule), [])
        self.assertEqual(after('log("a - b < 3");', "sign"), [])
        self.assertEqual(after("  const double sum = w + h;", "dropped statement"), [])
        self.assertEqual(after("  return a;", "dropped statement"), [])

    def test_names_and_template_arguments_are_no_constants(self):
        self.assertEqual(after("  m.block<6, 6>(at2, k3) = x1;", "constant"), [])

    def test_the_second_line_of_a_statement_is_not_dropped(self):
        lines = ["  a = b +", "      c(d);", "  e(f);"]
        self.assertFalse(whole_statement(lines, 1))
        self.assertTrue(whole_statement(lines, 2))

    def test_the_same_seed_draws_the_same_and_the_rules_take_turns(self):
        texts = {"a.cpp": CODE, "b.cpp": CODE.replace("w", "v")}
        first = list(itertools.islice(drawn(texts, 1), 8))
        self.assertEqual(first, list(itertools.islice(drawn(texts, 1), 8)))
        self.assertNotEqual(first, list(itertools.islice(drawn(texts, 2), 8)))
        self.assertEqual([m.rule for m in first[:4]], list(RULES))
        every = list(drawn(texts, 1))
        self.assertEqual(len(every), len(set(every)))
        self.assertEqual(len(every), sum(len(list(mutants_of(f, texts[f], r))) for f in texts for r in RULES))

    def test_what_does_not_compile_is_drawn_again(self):
        texts = {"a.cpp": CODE}
        first = wanted_draws(texts, 1, 3, {})
        again = wanted_draws(texts, 1, 3, {first[1].key: {"status": "does not compile"}})
        self.assertEqual(again[:2], [first[0], first[2]])
        self.assertEqual(len(again), 3)


class Named(unittest.TestCase):
    def test_a_line_is_found_by_its_text(self):
        entry = {"name": "n", "file": "a.cpp", "line": "total += w * h;", "broken": "total -= w * h;", "breaks": ""}
        mutant = named_mutants([entry], lambda file: CODE)["n"]
        self.assertEqual((mutant.line, mutant.before, mutant.after), (7, "  total += w * h;", "  total -= w * h;"))

    def test_a_line_that_is_gone_or_there_twice_is_named(self):
        for line in ("gone();", "x();"):
            entry = {"name": "n", "file": "a.cpp", "line": line, "broken": ";", "breaks": ""}
            with self.assertRaisesRegex(SystemExit, "'n'"):
                named_mutants([entry], lambda file: "x();\nx();\n")

    def test_every_named_line_is_still_in_the_code(self):
        entries = json.loads(NAMED.read_text())
        self.assertEqual(len(named_mutants(entries, lambda file: (CHECKOUT / file).read_text())), len(entries))
        self.assertEqual(len(entries), 40)


class Schema(unittest.TestCase):
    def line(self, number, after_text, rule):
        lines = CODE.splitlines()
        mutant = Mutant("a.cpp", number, lines[number - 1], after_text, rule)
        text = rewritten(lines, mutant, 7)
        return text and text.strip()

    def test_statements_ask_which_one_is_wanted(self):
        self.assertEqual(self.line(7, "  ;", "dropped statement"), "if (!mutation::wanted(7)) { total += w * h; }")
        self.assertEqual(self.line(7, "  total -= w * h;", "sign"),
                         "if (mutation::wanted(7)) { total -= w * h; } else { total += w * h; }")
        self.assertEqual(self.line(5, "  if (sum > 2.5) return 0.0;", "comparison"),
                         "if (mutation::wanted(7)) { if (sum > 2.5) return 0.0; } else { if (sum < 2.5) return 0.0; }")

    def test_declarations_and_parts_of_a_line_too(self):
        self.assertEqual(self.line(4, "  const double sum = w - h;  // 2 + 2", "sign"),
                         "double sum = mutation::wanted(7) ? double(w - h) : double(w + h);")
        self.assertEqual(self.line(8, "  for (int i = 0; i > 4; ++i) use(i);", "comparison"),
                         "for (int i = 0; i < mutation::less{7} < 4; ++i) use(i);")
        self.assertEqual(self.line(8, "  for (int i = 1; i < 4; ++i) use(i);", "constant"),
                         "for (int i = (mutation::wanted(7) ? 1 : 0); i < 4; ++i) use(i);")

    def test_one_mutant_to_a_line(self):
        lines = CODE.splitlines()
        both = {1: Mutant("a.cpp", 7, lines[6], "  ;", "dropped statement"), 2: Mutant("a.cpp", 7, lines[6], "  total -= w * h;", "sign")}
        text, taken = merged(CODE, both)
        self.assertEqual(taken, {1: 7})
        self.assertEqual(len(text.splitlines()), len(lines))


if __name__ == "__main__":
    unittest.main()
