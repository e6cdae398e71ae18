// Writes graphs as Turtle or N-Triples through Serd.  Meant for documents that are rarely asked
// for; frames have a faster writer of their own (common/resource/frame_turtle.cpp).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "common/rdf/term.h"

namespace chorus::rdf {

/// The name without the colon, and the namespace's IRI.
using Prefix = std::pair<std::string, std::string>;

struct WriteOptions {
  Syntax syntax = Syntax::Turtle;
  std::vector<Prefix> prefixes = {};  ///< Turtle only.
  /// N-Triples only: the absolute IRI against which relative ones are resolved.
  std::string base = {};
};

/// Groups triples by subject, in order of first appearance; in Turtle, a blank node that is used
/// once is written in place, as "[ ]".  Refuses what no syntax can express: a literal as a subject,
/// broken UTF-8, an IRI with a space.
[[nodiscard]] Result<std::string> write_graph(const Graph& graph, const WriteOptions& options);

/// Turns Turtle into N-Triples, one triple at a time; resolves relative IRIs against `base`.
[[nodiscard]] Result<std::string> turtle_to_ntriples(std::string_view turtle,
                                                     const std::string& base,
                                                     std::size_t max_bytes);

/// Resolves `reference` against the absolute IRI `base` (RFC 3986 5.2).
[[nodiscard]] std::string resolve_iri(const std::string& reference, const std::string& base);

}  // namespace chorus::rdf
