#include "tests/support/graph/isomorphism.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <vector>

namespace chorus::testing {
namespace {

using rdf::Graph;
using rdf::Term;
using rdf::TermKind;
using rdf::Triple;

/// Maps the label of a blank node to its colour, which encodes what is known about it.
using Colours = std::map<std::string, std::string>;

std::string text_of(const Term& term, const Colours& colours) {
  switch (term.kind) {
    case TermKind::Iri:
      return "<" + term.value + ">";
    case TermKind::Blank:
      return "_:" + colours.at(term.value);
    case TermKind::Literal:
      break;
  }
  return '"' + term.value + "\"^^" + term.datatype + "@" + term.language;
}

Colours first_colours(const std::set<Triple>& graph) {
  Colours colours;
  for (const Triple& triple : graph) {
    for (const Term* term : {&triple.subject, &triple.object}) {
      if (term->kind == TermKind::Blank) colours[term->value] = "0";
    }
  }
  return colours;
}

/// One round: a blank node's new colour is its old one plus its sorted triples.
Colours refine(const std::set<Triple>& graph, const Colours& colours) {
  std::map<std::string, std::vector<std::string>> around;
  for (const Triple& triple : graph) {
    const std::string& verb = triple.predicate.value;
    if (triple.subject.kind == TermKind::Blank) {
      around[triple.subject.value].push_back("> " + verb + " " + text_of(triple.object, colours));
    }
    if (triple.object.kind == TermKind::Blank) {
      around[triple.object.value].push_back("< " + verb + " " + text_of(triple.subject, colours));
    }
  }
  Colours next;
  for (auto& [label, lines] : around) {
    std::ranges::sort(lines);
    std::string all = colours.at(label);
    for (const std::string& line : lines) all += "\n" + line;
    next[label] = std::to_string(std::hash<std::string>{}(all));
  }
  return next;
}

/// The number of different colours.
std::size_t kinds(const Colours& colours) {
  std::set<std::string> different;
  for (const auto& [label, colour] : colours) different.insert(colour);
  return different.size();
}

std::multiset<std::string> lines_of(const Graph& graph) {
  const std::set<Triple> triples(graph.begin(), graph.end());
  Colours colours = first_colours(triples);
  // If one round does not distinguish further blank nodes, later rounds do not either.
  for (std::size_t before = 0, now = kinds(colours); now > before; now = kinds(colours)) {
    before = now;
    colours = refine(triples, colours);
  }
  std::multiset<std::string> lines;
  for (const Triple& triple : triples) {
    lines.insert(text_of(triple.subject, colours) + " <" + triple.predicate.value + "> " +
                 text_of(triple.object, colours));
  }
  return lines;
}

std::string only_in(const std::multiset<std::string>& a, const std::multiset<std::string>& b,
                    std::string_view mark) {
  constexpr std::size_t kShown = 5;
  std::vector<std::string> extra;
  std::ranges::set_difference(a, b, std::back_inserter(extra));
  std::string text;
  for (std::size_t i = 0; i < extra.size() && i < kShown; ++i) {
    text.append(mark).append(extra[i]).append("\n");
  }
  if (extra.size() > kShown)
    text.append("... ").append(std::to_string(extra.size())).append(" in all\n");
  return text;
}

}  // namespace

std::string difference(const Graph& left, const Graph& right) {
  const auto a = lines_of(left);
  const auto b = lines_of(right);
  return only_in(a, b, "only left: ") + only_in(b, a, "only right: ");
}

}  // namespace chorus::testing
