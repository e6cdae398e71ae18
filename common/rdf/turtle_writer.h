// Writes graphs as Turtle or N-Triples, through Serd.  For rare documents; frames use a template.
//
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "common/rdf/term.h"

namespace chorus::rdf {

using Prefix = std::pair<std::string, std::string>;  ///< Name without the colon, and namespace IRI.

struct WriteOptions {
  Syntax syntax = Syntax::Turtle;
  std::vector<Prefix> prefixes = {};  ///< Turtle only.
  std::string base = {};              ///< N-Triples only: absolute IRI to resolve relative ones.
};

/// Groups triples by subject in order of first appearance; Turtle has a blank node that is used
/// once in place, as "[ ]".  Refuses what no syntax can express: a literal as a subject, broken
/// UTF-8, an IRI with a space.
[[nodiscard]] Result<std::string> write_graph(const Graph& graph, const WriteOptions& options);

/// Turns Turtle into N-Triples, one triple at a time; resolves relative IRIs against `base`.
[[nodiscard]] Result<std::string> turtle_to_ntriples(std::string_view turtle,
                                                     const std::string& base,
                                                     std::size_t max_bytes);

/// Resolves `reference` against the absolute IRI `base` (RFC 3986 5.2).
[[nodiscard]] std::string resolve_iri(const std::string& reference, const std::string& base);

}  // namespace chorus::rdf
