// Reads Turtle and N-Triples as a stream of triples.  Wraps Serd: strict, guarded (turtle_guard.h),
// and without Serd's types in the interface.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/rdf/term.h"
#include "common/rdf/turtle_guard.h"

namespace chorus::rdf {

/// A Term that is valid only during the call that receives it.
struct TermView {
  TermKind kind = TermKind::Iri;
  std::string_view value;
  std::string_view datatype;
  std::string_view language;
};

struct TripleView {
  TermView subject;
  TermView predicate;
  TermView object;
};

struct ReadOptions {
  Syntax syntax = Syntax::Turtle;
  /// Absolute IRI against which relative ones are resolved; empty: they stay unchanged.
  std::string base = {};
  Limits limits = {};
};

/// Receives one triple; returning false ends the reading early, which is not an error.
using TripleSink = std::function<bool(const TripleView&)>;

/// Passes on each triple in document order, until the end or an error; the error names the line.
[[nodiscard]] Result<void> read_triples(std::string_view text, const ReadOptions& options,
                                        const TripleSink& sink);

[[nodiscard]] Result<Graph> read_graph(std::string_view text, const ReadOptions& options = {});

[[nodiscard]] Term to_term(const TermView& view);

}  // namespace chorus::rdf
