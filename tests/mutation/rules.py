"""The single changes that can break a line of C++."""

import random
import re
from dataclasses import dataclass

RULES = ("sign", "constant", "comparison", "dropped statement")

SIGNS = [(" + ", " - "), (" - ", " + "), (" += ", " -= "), (" -= ", " += "), ("return -", "return "),
         ("(-", "("), (", -", ", "), ("= -", "= ")]
COMPARISONS = [(" <= ", " >= "), (" >= ", " <= "), (" < ", " > "), (" > ", " < "), (" == ", " != "), (" != ", " == ")]
# A number, but no digit of a name (kFeet2, uint8_t), of a hexadecimal number or of a template argument (block<3, 3>).
NUMBER = re.compile(r"(?<![\w.'])\d[\d']*(?:\.\d*)?(?:e[-+]?\d+)?(?=[UFf]?\b|\D)(?![\w.'])(?!, \d+>|>)")
TEMPLATE = re.compile(r"<[\w: ,]*>")
TEXT = re.compile(r'"(?:[^"\\]|\\.)*"')
NO_CODE = re.compile(r"^\s*(#|//|using\b|namespace\b|static_assert\b|template\b|extern\b)")
# An assignment to something that exists, a call, or a condition with such a statement on its line.
STATEMENT = re.compile(r"^\s*(?:if \(.*\) )?(?!return\b|break\b|case\b|else\b|using\b|for\b|while\b)"
                       r"[\w\[\]().*&>:-]+(?:(?: [-+*/|&]?= |\+\+|--|\().*|);\s*$")


@dataclass(frozen=True)
class Mutant:
    """One line of one file, in its original and its broken form."""
    file: str
    line: int  # counted from one
    before: str
    after: str
    rule: str

    @property
    def key(self):
        return f"{self.file}:{self.line}: {self.before.strip()} => {self.after.strip()}"


def blanked(line):
    """The line with comments and strings blanked, so that columns do not change."""
    code = TEXT.sub(lambda found: '"' + "_" * (len(found.group()) - 2) + '"', line)
    comment = code.find("//")
    return code if comment < 0 else code[:comment] + " " * (len(code) - comment)


def replaced(line, start, end, text):
    return line[:start] + text + line[end:]


def exchanges(line, code, table):
    for old, new in table:
        start = code.find(old)
        while start >= 0:
            yield replaced(line, start, start + len(old), new)
            start = code.find(old, start + 1)


def constants(line, code):
    """A number becomes zero; zero becomes one."""
    masked = TEMPLATE.sub(lambda found: "<" + "_" * (len(found.group()) - 2) + ">", code)
    for found in NUMBER.finditer(masked):
        number = found.group().replace("'", "")
        is_zero = float(number) == 0
        whole = "." not in number and "e" not in number
        yield replaced(line, found.start(), found.end(), ("1" if is_zero else "0") if whole else ("1.0" if is_zero else "0.0"))


def broken_lines(line, rule):
    """All broken forms of this line by this rule."""
    code = blanked(line)
    if not code.strip() or NO_CODE.match(code):
        return []
    if rule == "sign":
        return list(exchanges(line, code, SIGNS))
    if rule == "comparison":
        return list(exchanges(line, code, COMPARISONS))
    if rule == "constant":
        return list(constants(line, code))
    if STATEMENT.match(code):
        indent = line[:len(line) - len(line.lstrip())]
        return [indent + ";"]
    return []


def whole_statement(lines, index):
    """Whether the line begins a statement: the previous one ended one, or opened or closed a block."""
    for earlier in reversed(lines[:index]):
        code = blanked(earlier).strip()
        if code:
            return code.endswith((";", "{", "}", ":"))
    return True


def mutants_of(file, text, rule):
    lines = text.splitlines()
    for index, line in enumerate(lines):
        if rule == "dropped statement" and not whole_statement(lines, index):
            continue
        for after in broken_lines(line, rule):
            yield Mutant(file, index + 1, line, after, rule)


def drawn(texts, seed):
    """All mutants in drawn order: the rules take turns, and each draws without replacement.

    texts: {file: text}.  The same texts and seed give the same mutants.
    """
    piles = []
    for rule in RULES:
        pile = [mutant for file in sorted(texts) for mutant in mutants_of(file, texts[file], rule)]
        random.Random(f"{seed} {rule}").shuffle(pile)
        piles.append(pile)
    while any(piles):
        for pile in piles:
            if pile:
                yield pile.pop()
