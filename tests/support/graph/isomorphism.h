// Do two graphs say the same, whatever their blank nodes are called?
#pragma once

#include <string>

#include "common/rdf/term.h"

namespace chorus::testing {

/// Empty when `left` and `right` are isomorphic, else a few triples that only one side has.  Blank
/// nodes are told apart by what surrounds them (colour refinement): exact for trees and for every
/// graph whose blank nodes differ in that, which holds for all documents of ours.
[[nodiscard]] std::string difference(const rdf::Graph& left, const rdf::Graph& right);

}  // namespace chorus::testing
