// Checks Turtle or N-Triples bytes before a parser sees them: size, nesting, and bytes that no
// document may contain.
//
// Serd 0.30 reads nested brackets by recursion; 20 000 of them overflow its stack.  So this guard
// first counts the depth, in one pass that recognises strings, IRIs and comments.  It refuses a
// string, IRI or comment that Serd might take to end elsewhere.
#pragma once

#include <cstddef>
#include <string_view>

#include "common/base/result.h"

namespace chorus::rdf {

struct Limits {
  std::size_t bytes = 2'000'000;  ///< Far above any frame (64 bodies are about 350 kB).
  int nesting = 32;               ///< Limit of '[' and '(' that are open at the same time.
};

/// Success, or why the document is refused, with the line ("line 12").
[[nodiscard]] Result<void> check_bytes(std::string_view text, const Limits& limits = {});

}  // namespace chorus::rdf
