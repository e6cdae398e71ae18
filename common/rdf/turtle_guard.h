// Checks Turtle or N-Triples bytes before a parser sees them: size, nesting, and bytes that no
// document may contain.
//
// Serd 0.30 reads nested brackets by recursion; 20 000 of them overflow its stack.  So this counts
// the depth first, in one pass that knows strings, IRIs and comments, and refuses any of these
// whose end the two readers could see at different places.
#pragma once

#include <cstddef>
#include <string_view>

#include "common/base/result.h"

namespace chorus::rdf {

struct Limits {
  std::size_t bytes = 2'000'000;  ///< Far above any frame (64 bodies are about 350 kB).
  int nesting = 32;               ///< Unclosed '[' and '(' at any place.
};

/// Success, or the reason for refusing the document, with the line ("line 12").
[[nodiscard]] Result<void> check_bytes(std::string_view text, const Limits& limits = {});

}  // namespace chorus::rdf
