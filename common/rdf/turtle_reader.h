// Turtle and N-Triples as a stream of triples.  RAII over Serd, strict, guarded; no Serd type
// escapes.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/rdf/term.h"
#include "common/rdf/turtle_guard.h"

namespace chorus::rdf {

/// A Term that lives as long as the call it was handed to.
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
  /// Absolute IRI that relative ones are resolved against; empty: left as they are.
  std::string base = {};
  Limits limits = {};
};

/// Takes one triple; false stops the reading early, which is not an error.
using TripleSink = std::function<bool(const TripleView&)>;

/// Feeds every triple in document order.  An error names the line; triples before it have been fed.
[[nodiscard]] Result<void> read_triples(std::string_view text, const ReadOptions& options,
                                        const TripleSink& sink);

[[nodiscard]] Result<Graph> read_graph(std::string_view text, const ReadOptions& options = {});

[[nodiscard]] Term to_term(const TermView& view);

}  // namespace chorus::rdf
