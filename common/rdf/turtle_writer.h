// Graphs as Turtle or N-Triples, through Serd.  For documents that are rare; frames have a
// template.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "common/rdf/term.h"

namespace chorus::rdf {

using Prefix = std::pair<std::string, std::string>;  ///< Name without colon, namespace IRI.

struct WriteOptions {
  Syntax syntax = Syntax::Turtle;
  std::vector<Prefix> prefixes = {};  ///< Turtle only.
  std::string base = {};  ///< N-Triples: relative IRIs are resolved against this absolute one.
};

/// Groups triples by subject in order of first appearance; in Turtle a blank node that is used once
/// is written in place, as "[ ]".  Refuses what no syntax can express: a literal as subject, broken
/// UTF-8, an IRI with a space.
[[nodiscard]] Result<std::string> write_graph(const Graph& graph, const WriteOptions& options);

/// A Turtle document as N-Triples, one triple at a time; relative IRIs are resolved against `base`.
[[nodiscard]] Result<std::string> turtle_to_ntriples(std::string_view turtle,
                                                     const std::string& base,
                                                     std::size_t max_bytes);

/// RFC 3986 5.2: `reference` as seen from the absolute IRI `base`.
[[nodiscard]] std::string resolve_iri(const std::string& reference, const std::string& base);

}  // namespace chorus::rdf
