// RDF terms, triples and graphs as plain values.
#pragma once

#include <compare>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace chorus::rdf {

inline constexpr std::string_view kRdf = "http://www.w3.org/1999/02/22-rdf-syntax-ns#";
inline constexpr std::string_view kXsd = "http://www.w3.org/2001/XMLSchema#";

enum class TermKind { Iri, Blank, Literal };

/// An IRI, a blank node label or a literal.  An IRI is as written, so it may be relative, unless
/// the reader was given a base.  A literal without datatype is an xsd:string or a language-tagged
/// string.
struct Term {
  TermKind kind = TermKind::Iri;
  std::string value;
  std::string datatype = {};
  std::string language = {};

  auto operator<=>(const Term&) const = default;
};

struct Triple {
  Term subject;
  Term predicate;
  Term object;

  auto operator<=>(const Triple&) const = default;
};

using Graph = std::vector<Triple>;

enum class Syntax { Turtle, NTriples };

[[nodiscard]] inline Term iri(std::string value) { return {TermKind::Iri, std::move(value)}; }
[[nodiscard]] inline Term blank(std::string label) { return {TermKind::Blank, std::move(label)}; }
[[nodiscard]] inline Term literal(std::string text, std::string datatype = {}) {
  return {TermKind::Literal, std::move(text), std::move(datatype)};
}

/// `rdf("type")`, `xsd("dateTime")`: IRIs in the two namespaces that every document uses.
[[nodiscard]] inline std::string rdf(std::string_view name) {
  return std::string(kRdf).append(name);
}
[[nodiscard]] inline std::string xsd(std::string_view name) {
  return std::string(kXsd).append(name);
}

}  // namespace chorus::rdf
