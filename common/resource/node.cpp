#include "common/resource/node.h"

#include <algorithm>
#include <cassert>
#include <set>
#include <type_traits>

#include "common/rdf/turtle_writer.h"
#include "common/rdf/utf8.h"
#include "common/resource/fixed_point.h"
#include "common/resource/node_json.h"
#include "common/resource/terms.h"

namespace chorus::resource {
namespace {

using rdf::Graph;
using rdf::Term;

/// Turns a string from a configuration file or a peer into a valid IRI: escapes the characters that
/// an IRI cannot contain.
std::string safe_iri(std::string_view text) {
  constexpr std::string_view kNever = "<>\"{}|^`\\";
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string safe;
  for (const char c : rdf::clean_utf8(text)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte > 0x20 && kNever.find(c) == std::string_view::npos) {
      safe += c;
    } else {
      safe.append("%").append(1, kHex[byte >> 4U]).append(1, kHex[byte & 15U]);
    }
  }
  return safe;
}

/// Turns text into a valid xsd:string: replaces what is not UTF-8 and removes zero bytes.
std::string safe_text(std::string_view text) {
  std::string safe = rdf::clean_utf8(text);
  std::erase(safe, '\0');
  return safe;
}

/// Collects the triples of a tree.
class Building {
 public:
  Graph run(const Node& root) {
    add(root);
    return std::move(graph_);
  }

 private:
  Term add(const Node& node) {
    const Term subject = node.id == "_" ? fresh() : rdf::iri(safe_iri(node.id));
    for (const std::string& type : node.types) {
      graph_.push_back({subject, rdf::iri(rdf::rdf("type")), rdf::iri(safe_iri(class_iri(type)))});
    }
    for (const auto& [key, value] : node.properties) {
      const TermUse use = term(key, node.types);
      std::visit([&](const auto& v) { add_value(subject, use, v); }, value);
    }
    return subject;
  }

  template <class V>
  void add_value(const Term& subject, const TermUse& use, const V& value) {
    add_object(subject, use, term_of(value, use));
  }
  template <class Item>
  void add_value(const Term& subject, const TermUse& use, const std::vector<Item>& items) {
    if (use.container == Container::List) return add_list(subject, use, items);
    for (const Item& item : items) add_value(subject, use, item);
  }
  void add_value(const Term& subject, const TermUse& use, const Node& node) {
    // The link comes before the node that it points to, which is the order in which people read.
    const std::size_t at = graph_.size();
    const Term object = add(node);
    graph_.insert(graph_.begin() + static_cast<std::ptrdiff_t>(at),
                  {subject, rdf::iri(safe_iri(use.iri)), object});
  }

  template <class Item>
  void add_list(const Term& subject, const TermUse& use, const std::vector<Item>& items) {
    Term from = subject;
    Term link = rdf::iri(safe_iri(use.iri));
    if constexpr (!std::is_same_v<Item, Node>) {
      for (const Item& item : items) {
        const Term object = term_of(item, use);
        if (object.kind == rdf::TermKind::Literal && object.value.empty()) continue;
        const Term cell = fresh();
        graph_.push_back({from, link, cell});
        graph_.push_back({cell, rdf::iri(rdf::rdf("first")), object});
        from = cell;
        link = rdf::iri(rdf::rdf("rest"));
      }
    }
    graph_.push_back({from, link, rdf::iri(rdf::rdf("nil"))});
  }

  void add_object(const Term& subject, const TermUse& use, Term object) {
    const bool left_out = object.kind == rdf::TermKind::Literal && object.value.empty() &&
                          object.datatype == rdf::xsd("decimal");
    if (!left_out) graph_.push_back({subject, rdf::iri(safe_iri(use.iri)), std::move(object)});
  }

  static Term term_of(bool v, const TermUse&) {
    return rdf::literal(v ? "true" : "false", rdf::xsd("boolean"));
  }
  static Term term_of(std::int64_t v, const TermUse& use) {
    if (use.type == rdf::xsd("decimal")) return term_of(Decimal{static_cast<double>(v), 1}, use);
    return rdf::literal(std::to_string(v), rdf::xsd("integer"));
  }
  static Term term_of(const Decimal& v, const TermUse&) {
    return rdf::literal(fixed(v.value, v.digits).value_or(""), rdf::xsd("decimal"));
  }
  static Term term_of(Timestamp v, const TermUse&) {
    return rdf::literal(to_iso8601(v), rdf::xsd("dateTime"));
  }
  static Term term_of(const Ref& v, const TermUse&) { return rdf::iri(safe_iri(v.iri)); }
  static Term term_of(const std::string& v, const TermUse& use) {
    if (use.type == "@id") return rdf::iri(safe_iri(v));
    if (use.type == "@vocab") return rdf::iri(safe_iri(class_iri(v)));
    return rdf::literal(safe_text(v), use.type);
  }

  Term fresh() { return rdf::blank("b" + std::to_string(++blanks_)); }

  Graph graph_;
  int blanks_ = 0;
};

/// The prefixes that the names in the graph need.
std::vector<rdf::Prefix> prefixes_for(const Graph& graph) {
  std::vector<rdf::Prefix> used;
  for (const rdf::Prefix& prefix : all_prefixes()) {
    const auto& space = prefix.second;
    const bool occurs = std::ranges::any_of(graph, [&space](const rdf::Triple& triple) {
      return triple.predicate.value.starts_with(space) ||
             triple.object.datatype.starts_with(space) ||
             (triple.object.kind == rdf::TermKind::Iri && triple.object.value.starts_with(space));
    });
    if (occurs) used.push_back(prefix);
  }
  return used;
}

void collect_undeclared(const Node& node, std::set<std::string>& found) {
  for (const auto& [key, value] : node.properties) {
    if (!term(key, node.types).declared) found.insert(key);
    if (const auto* child = std::get_if<Node>(&value)) collect_undeclared(*child, found);
    if (const auto* children = std::get_if<std::vector<Node>>(&value)) {
      for (const Node& child : *children) collect_undeclared(child, found);
    }
  }
}

std::string to_rdf(const Node& node, rdf::Syntax syntax, const Place& place) {
  const Graph graph = graph_of(node);
  rdf::WriteOptions options{syntax, {}, place.root + place.path};
  if (syntax == rdf::Syntax::Turtle) options.prefixes = prefixes_for(graph);
  const auto text = rdf::write_graph(graph, options);
  assert(text && "graph_of makes every term writable");
  return text.value_or("");
}

}  // namespace

Graph graph_of(const Node& node) { return Building().run(node); }

std::string write(const Node& node, Format format, const Place& place) {
  switch (format) {
    case Format::Turtle:
      return to_rdf(node, rdf::Syntax::Turtle, place);
    case Format::NTriples:
      return to_rdf(node, rdf::Syntax::NTriples, place);
    case Format::JsonLd:
      return to_json(node, true, place);
    case Format::Json:
      return to_json(node, false, place);
  }
  return {};
}

std::vector<std::string> undeclared_terms(const Node& node) {
  std::set<std::string> found;
  collect_undeclared(node, found);
  return {found.begin(), found.end()};
}

}  // namespace chorus::resource
