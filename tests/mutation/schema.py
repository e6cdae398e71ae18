"""Builds many mutants of one file at once: each line asks which mutant is active and is unchanged for all others.

A line that fits none of the forms below, or that does not compile, is built separately.
"""

import re

from rules import NUMBER, STATEMENT, blanked, whole_statement

# What the rewritten files call; a file includes it as its first line.
HEADER = """#pragma GCC system_header
#pragma once
#include <cstdlib>
#include <functional>
#include <utility>
#include <Eigen/Core>
namespace mutation {
inline bool wanted(int number) {
  static const char* const text = std::getenv("CHORUS_MUTANT");
  static const int chosen = text ? std::atoi(text) : -1;
  return chosen == number;
}
// a + b becomes a + plus{7} + b: the first + keeps a, the second decides.
template <class T> struct Value { using type = std::decay_t<T>; };
template <class T> requires requires { typename std::decay_t<T>::PlainObject; }
struct Value<T> { using type = typename std::decay_t<T>::PlainObject; };
template <class T> using value_t = typename Value<T>::type;
#define MUTATION_OPERATOR(name, op, other)                                                          \\
  struct name { int number; };                                                                      \\
  template <class A> struct name##_left { const A& a; int number; };                                \\
  template <class A> name##_left<A> operator op(const A& a, name m) { return {a, m.number}; }       \\
  template <class A, class B> auto operator op(name##_left<A> left, const B& b) {                   \\
    using R = value_t<decltype(left.a op b)>;                                                       \\
    return wanted(left.number) ? R(left.a other b) : R(left.a op b);                                \\
  }
MUTATION_OPERATOR(plus, +, -)
MUTATION_OPERATOR(minus, -, +)
MUTATION_OPERATOR(less, <, >)
MUTATION_OPERATOR(greater, >, <)
MUTATION_OPERATOR(at_most, <=, >=)
MUTATION_OPERATOR(at_least, >=, <=)
MUTATION_OPERATOR(equal, ==, !=)
MUTATION_OPERATOR(unequal, !=, ==)
#undef MUTATION_OPERATOR
}  // namespace mutation
"""
NAMES = {"+": "plus", "-": "minus", "<": "less", ">": "greater", "<=": "at_most", ">=": "at_least", "==": "equal",
         "!=": "unequal"}
TURNED = {"+": "-", "-": "+", "<": ">", ">": "<", "<=": ">=", ">=": "<=", "==": "!=", "!=": "=="}

DECLARED = re.compile(r"^(\s*)(?:constexpr|const)? ?((?:double|int|bool|float|std::size_t|Eigen::\w+|Row6|Matrix6|Vector6)) "
                      r"(\w+) = (.*);\s*$")
HEAD = re.compile(r"^(\s*(?:\} else )?(?:if|while) \()(.*)(\) \{)\s*$")


def code_of(line):
    """The line without a comment at its end."""
    return line[:len(blanked(line).rstrip())]


def followed_by_else(lines, index):
    return index + 1 < len(lines) and blanked(lines[index + 1]).strip().startswith("else")


def difference(before, after):
    """(start, end in before, end in after) of the part that differs."""
    start = 0
    while start < min(len(before), len(after)) and before[start] == after[start]:
        start += 1
    tail = 0
    while tail < min(len(before), len(after)) - start and before[-1 - tail] == after[-1 - tail]:
        tail += 1
    return start, len(before) - tail, len(after) - tail


def by_statement(lines, index, mutant, number):
    before, after = code_of(mutant.before), code_of(mutant.after)
    is_statement = STATEMENT.match(before) or re.match(r"^\s*(if \(.*\) )?return .*;$", before)
    if not is_statement or not whole_statement(lines, index) or followed_by_else(lines, index):
        return None
    if after.strip() == ";":
        return f"if (!mutation::wanted({number})) {{ {before.strip()} }}"
    return f"if (mutation::wanted({number})) {{ {after.strip()} }} else {{ {before.strip()} }}"


def by_declaration(mutant, number):
    before, after = DECLARED.match(code_of(mutant.before)), DECLARED.match(code_of(mutant.after))
    if not before or not after or before.groups()[:3] != after.groups()[:3]:
        return None
    indent, kind, name, value = before.groups()
    return f"{indent}{kind} {name} = mutation::wanted({number}) ? {kind}({after.group(4)}) : {kind}({value});"


def by_head(mutant, number):
    before, after = HEAD.match(code_of(mutant.before)), HEAD.match(code_of(mutant.after))
    if not before or not after or before.group(1) != after.group(1):
        return None
    return f"{before.group(1)}mutation::wanted({number}) ? ({after.group(2)}) : ({before.group(2)}){before.group(3)}"


def by_operator(mutant, number):
    before, after = mutant.before, mutant.after
    for old, new in TURNED.items():
        at = before.find(f" {old} ")
        while at >= 0:
            if before[:at] + f" {new} " + before[at + len(old) + 2:] == after:
                return f"{before[:at]} {old} mutation::{NAMES[old]}{{{number}}} {old} {before[at + len(old) + 2:]}"
            at = before.find(f" {old} ", at + 1)
    return None


def by_constant(mutant, number):
    start, end, end_after = difference(mutant.before, mutant.after)
    for found in NUMBER.finditer(mutant.before):
        if found.start() <= start and end <= found.end():
            old, new = found.group(), mutant.after[found.start():found.end() + end_after - end]
            choice = f"(mutation::wanted({number}) ? {new} : {old})"
            return mutant.before[:found.start()] + choice + mutant.before[found.end():]
    return None


def rewritten(lines, mutant, number):
    """The line that contains both forms, or nothing."""
    index = mutant.line - 1
    line = by_statement(lines, index, mutant, number) or by_declaration(mutant, number) or by_head(mutant, number)
    if line:
        return line
    if mutant.rule in ("sign", "comparison"):
        return by_operator(mutant, number)
    return by_constant(mutant, number) if mutant.rule == "constant" and "constexpr" not in mutant.before else None


def merged(text, numbered):
    """The file with as many of {number: mutant} as fit, at most one per line, and the numbers that did."""
    lines = text.splitlines()
    taken, out = {}, list(lines)
    for number, mutant in numbered.items():
        if mutant.line in taken.values():
            continue
        line = rewritten(lines, mutant, number)
        if line is None:
            continue
        out[mutant.line - 1] = line
        taken[number] = mutant.line
    return "\n".join(out) + "\n", taken
