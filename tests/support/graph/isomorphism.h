// Compares graphs regardless of the labels of their blank nodes.
#pragma once

#include <string>

#include "common/rdf/term.h"

namespace chorus::testing {

/// Empty when `left` and `right` are isomorphic, otherwise a few triples that only one side has.
/// Blank nodes are distinguished by their surroundings (colour refinement): exact for trees and for
/// every graph whose blank nodes differ in these, which is true of all our documents.
[[nodiscard]] std::string difference(const rdf::Graph& left, const rdf::Graph& right);

}  // namespace chorus::testing
